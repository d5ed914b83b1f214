"""Tests of the page in a real browser. Usage:
page_test.py SCRIPTS CHROMIUM CHROMEDRIVER FOLDER"""

import base64
import json
import math
import pathlib
import sys
import time
import unittest

from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import WebDriverWait

import scenes
from browser import errors_of, open_browser, resize
from design_tests import DesignTests
from fake_server import FakeServer
from mouse import Mouse
from page_parts import page_html

CLOSED_FORM = 1e-6  # m, of the coupler's point; single precision of the poses leaves 3e-8
PIXEL = 2.5         # pixels between where the mouse is and where the point is drawn


class PageTest(unittest.TestCase):
    """One browser for all tests; each opens its own page and leaves no error in the console."""

    def setUp(self):
        resize(BROWSER, 1400)

    def tearDown(self):
        self.assertEqual(errors_of(BROWSER), self.expected_errors())

    def expected_errors(self):
        return []

    def open(self, scene, name="page"):
        path = FOLDER / f"{name}.html"
        path.write_text(page_html(scene, SCRIPTS), encoding="utf-8")
        BROWSER.get(path.as_uri())
        self.wait("return Boolean(window.vmechView)")

    def do(self, script, *arguments):
        return BROWSER.execute_script(script, *arguments)

    def wait(self, script, *arguments, seconds=10):
        return WebDriverWait(BROWSER, seconds, 0.05).until(
            lambda browser: browser.execute_script(script, *arguments))

    def find(self, path):
        return BROWSER.find_element(By.XPATH, path)

    def mouse(self, *steps):
        Mouse(BROWSER).steps(*steps)

    def item(self, text):
        """The button of the tree with a name."""
        return next(button for button in BROWSER.find_elements(By.CSS_SELECTOR, ".vv-item")
                    if button.find_element(By.CSS_SELECTOR, ".vv-name").text == text)


class Picture(PageTest):
    def test_is_drawn_by_a_named_renderer_in_many_colours(self):
        self.open(scenes.FourBar().scene())
        self.assertTrue(self.do("return vmechView.renderer"))
        colours = self.do("""
            const image = document.createElement("canvas");
            const canvas = document.querySelector(".vv-canvas"), pen = image.getContext("2d");
            image.width = canvas.width; image.height = canvas.height;
            vmechView.picture();
            pen.drawImage(canvas, 0, 0);
            const data = pen.getImageData(0, 0, image.width, image.height).data, found = new Set();
            for (let i = 0; i < data.length; i += 4) {
              found.add(data[i] >> 4 << 8 | data[i + 1] >> 4 << 4 | data[i + 2] >> 4);
            }
            return found.size""")
        self.assertGreater(colours, 20)

    def test_is_missed_in_words_without_webgl_and_the_rest_works(self):
        script = BROWSER.execute_cdp_cmd("Page.addScriptToEvaluateOnNewDocument", {"source": """
            const real = HTMLCanvasElement.prototype.getContext;
            HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
              return kind.startsWith("webgl") ? null : real.call(this, kind, ...rest);
            };"""})
        try:
            self.open(scenes.FourBar().scene())
        finally:
            BROWSER.execute_cdp_cmd("Page.removeScriptToEvaluateOnNewDocument", script)
        self.assertIsNone(self.do("return vmechView.renderer"))
        self.assertIn("WebGL is missing", BROWSER.find_element(By.CSS_SELECTOR, ".vv-missing").text)
        self.do("vmechView.play()")
        self.wait("return vmechView.poseIndex() > 3")
        self.assertTrue(BROWSER.find_elements(By.CSS_SELECTOR, ".vv-chart"))

    def test_rests_while_nothing_changes(self):
        self.open(scenes.FourBar().scene())
        time.sleep(0.5)
        frames = self.do("return vmechView.scriptTimes.length")
        time.sleep(0.5)
        self.assertEqual(self.do("return vmechView.scriptTimes.length"), frames)

    def test_shows_every_joint_and_mark(self):
        self.open(scenes.every_joint())
        for box in BROWSER.find_elements(By.CSS_SELECTOR, ".vv-ticks input"):
            self.do("arguments[0].click()", box)

    def test_fits_narrow_and_wide(self):
        self.open(scenes.FourBar().scene())
        for width in (400, 760, 1400):
            resize(BROWSER, width)
            self.wait("return window.innerWidth === arguments[0]", width)
            over = self.do("return document.documentElement.scrollWidth - window.innerWidth")
            self.assertLessEqual(over, 0, f"at {width} px")

    def test_turns_dark_with_the_system_and_by_its_button(self):
        resize(BROWSER, 1400, dark=True)
        self.open(scenes.FourBar().scene())
        theme = "return document.getElementById('vmech-view').dataset.theme"
        self.assertEqual(self.do(theme), "dark")
        BROWSER.find_element(By.XPATH, "//button[text()='Theme']").click()
        self.assertEqual(self.do(theme), "light")

    def test_a_ground_drawn_by_a_mesh_is_glass_until_it_shall_not_be(self):
        # A ring about the crank's joint at the origin, through which nothing could be seen.
        self.open(scenes.with_mesh(800, link=0, large=0.03))
        button = self.find("//button[@aria-label='Glass: ground']")
        self.assertEqual(button.get_attribute("aria-pressed"), "true")
        ring = self.do("return vmechView.screenOf([0, -0.03, 0.02])")
        self.mouse(ring, "down", "up")
        self.assertNotEqual(self.do("return vmechView.picked()?.index ?? 'none'"), 0)
        button.click()
        self.mouse(ring, "down", "up")
        self.assertEqual(self.do("return [vmechView.picked().kind, vmechView.picked().index]"),
                         ["link", 0])

    def test_opens_a_hundred_thousand_triangles(self):
        self.open(scenes.with_mesh(100_000), "mesh")
        self.assertGreater(self.do("return vmechView.triangles"), 99_000)
        self.wait("return vmechView.scriptTimes.length > 0")
        print(f"100,000 triangles are seen after {self.do('return vmechView.shownAt'):.0f} ms")


class Motion(PageTest):
    def test_playing_moves_the_coupler_along_its_closed_form_curve(self):
        bar = scenes.FourBar()
        self.open(bar.scene())
        samples = self.do("""
            const found = [];
            for (let k = 0; k < 400; ++k) {
              vmechView.goTo(k * 1.7973);
              found.push([vmechView.poseIndex(), vmechView.pointOf(2, arguments[0])]);
            }
            return found""", bar.point)
        for index, point in samples:
            self.assertLess(math.dist(point, bar.curve(2 * math.pi * index / 720)), CLOSED_FORM)

    def test_plays_and_pauses_by_the_space_bar(self):
        bar = scenes.FourBar()
        self.open(bar.scene())
        canvas = BROWSER.find_element(By.CSS_SELECTOR, ".vv-canvas")
        canvas.send_keys(Keys.SPACE)
        self.wait("return vmechView.poseIndex() > 3")
        canvas.send_keys(Keys.SPACE)
        self.assertFalse(self.do("return vmechView.playing()"))
        index, point = self.do("return [vmechView.poseIndex(), vmechView.pointOf(2, arguments[0])]",
                               bar.point)
        self.assertLess(math.dist(point, bar.curve(2 * math.pi * index / 720)), CLOSED_FORM)

    def test_arrows_step(self):
        self.open(scenes.FourBar().scene())
        canvas = BROWSER.find_element(By.CSS_SELECTOR, ".vv-canvas")
        canvas.send_keys(Keys.ARROW_RIGHT, Keys.ARROW_RIGHT, Keys.ARROW_LEFT)
        self.assertEqual(self.do("return vmechView.poseIndex()"), 1)

    def test_a_click_on_a_joint_shows_its_plots_and_one_in_a_plot_moves_the_mechanism(self):
        bar = scenes.FourBar()
        self.open(bar.scene())
        self.mouse(self.do("return vmechView.screenOf([arguments[0], 0, 0.002])", bar.ground),
                   "down", "up")
        self.assertEqual(self.do("return [vmechView.picked().kind, vmechView.picked().index]"),
                         ["joint", 3])
        titles = [t.text for t in BROWSER.find_elements(By.CSS_SELECTOR, ".vv-title")]
        self.assertEqual(titles[0], "D [deg]")
        self.assertTrue(any(title.endswith("[N]") for title in titles))
        chart = BROWSER.find_element(By.CSS_SELECTOR, ".vv-chart")
        box = self.do("return arguments[0].getBoundingClientRect().toJSON()", chart)
        middle = box["left"] + 50 + 0.5 * (box["width"] - 58)  # of the axes within the canvas
        self.mouse((middle, box["top"] + 60), "down", "up")
        self.assertAlmostEqual(self.do("return vmechView.poseIndex()"), 719 / 2, delta=3)

    def test_a_platform_of_21_joints_plays(self):
        self.open(scenes.hexapod(legs=7))
        self.do("vmechView.pick('joint', 1); vmechView.play()")
        self.wait("return vmechView.drawn() > 30", seconds=30)
        times = sorted(self.do("vmechView.pause(); return vmechView.scriptTimes.slice(5)"))
        print(f"a frame of 21 joints takes {times[len(times) // 2]:.2f} ms of script at the median")


class Names(PageTest):
    def test_a_hostile_name_is_text_and_runs_nothing(self):
        scene = scenes.hostile()
        self.open(scene)
        for kind in ("joint", "link", "grasp"):
            self.do("vmechView.pick(arguments[0], 0)", kind)
        self.assertIsNone(self.do("return window.stolen || null"))
        injected = "#vmech-view img, #vmech-view script"
        self.assertEqual(BROWSER.find_elements(By.CSS_SELECTOR, injected), [])
        self.item(scene["links"][1]["name"])
        self.assertEqual(BROWSER.title, scene["title"])


class Files(PageTest):
    def test_gltf_holds_the_links_and_their_motion(self):
        self.open(scenes.slider_crank())
        gltf = BROWSER.execute_async_script(
            "const done = arguments[0]; vmechView.gltf().then(done)")
        (FOLDER / "page_test.gltf").write_text(json.dumps(gltf), encoding="utf-8")
        self.assertEqual([node["name"] for node in gltf["nodes"][1:]],
                         ["frame", "crank", "rod", "piston"])
        self.assertEqual(len(gltf["animations"][0]["channels"]), 6)

    def test_picture_is_offered(self):
        self.open(scenes.slider_crank())
        path = FOLDER / "Slider-crank.png"
        path.unlink(missing_ok=True)
        BROWSER.find_element(By.XPATH, "//button[text()='PNG']").click()
        deadline = time.monotonic() + 10
        while not path.exists() and time.monotonic() < deadline:
            time.sleep(0.05)
        self.assertEqual(path.read_bytes()[:4], b"\x89PNG")


class ServedTest(PageTest):
    def setUp(self):
        super().setUp()
        self.server = None

    def tearDown(self):
        self.do("window.stop()")
        BROWSER.get("about:blank")
        if self.server:
            self.server.stop()
        errors_of(BROWSER)  # A lost server is told in the console by the browser itself.

    def serve(self, writer=True, port=0, poses=0, mesh=None, **session):
        """`poses` of a recorded motion; `mesh` of the rocker."""
        self.bar = scenes.FourBar()
        session = {"socket": "/socket", "kind": "mechanism", **session}
        scene = self.bar.scene(poses, session=session)
        if mesh:
            scene["links"][3]["mesh"] = base64.b64encode(mesh).decode()
        self.server = FakeServer(page_html(scene, SCRIPTS), self.bar, writer, port)
        BROWSER.get(self.server.address)
        self.wait("return Boolean(window.vmechView) && vmechView.session.received > 1")

    def tip(self):
        """The crank's far end on the screen, in front of the plate."""
        x, y = self.do("return vmechView.screenOf(vmechView.pointOf(1, [arguments[0], 0, 0]))",
                       0.6 * self.bar.crank)
        return round(x), round(y)


class LiveDesign(DesignTests, ServedTest):
    pass


class LiveSession(ServedTest):
    def test_a_drag_turns_the_crank_after_the_mouse_and_ends_with_it(self):
        self.serve()
        x, y = self.tip()
        goal = self.do("return vmechView.screenOf([0, arguments[0], 0])", 0.6 * self.bar.crank)
        self.mouse((x, y), "down", (x + 1, y - 2), goal)
        self.wait("return vmechView.latencies.length > 0")
        self.wait("return vmechView.now().coordinates[0] > 1.4")
        self.assertEqual(self.server.done("grab")[0]["link"], 1)
        last = self.server.done("drag")[-1]["to"]
        aimed = self.do("return vmechView.screenOf(arguments[0])", last)
        self.assertLess(math.dist(aimed, goal), PIXEL)
        self.assertEqual(BROWSER.find_element(By.CSS_SELECTOR, ".vv-force").text, "5.000 N")
        self.mouse("up")
        self.wait("return !document.querySelector('.vv-canvas').classList.contains('vv-holding')")
        time.sleep(0.2)
        self.assertEqual(self.server.done("release"), [{"do": "release", "keep": True}])

    def test_a_lost_window_lets_go(self):
        self.serve()
        x, y = self.tip()
        self.mouse((x, y), "down")
        self.do("window.dispatchEvent(new Event('blur'))")
        time.sleep(0.2)
        self.assertEqual(len(self.server.done("release")), 1)
        self.mouse("up")

    def test_modes_and_sliders_ask_the_server(self):
        self.serve()
        self.do("for (const d of document.querySelectorAll('.vv-controls details')) d.open = true")
        BROWSER.find_element(By.XPATH, "//button[text()='Find the assembly modes']").click()
        self.wait("return document.querySelectorAll('.vv-modes button').length === 2")
        BROWSER.find_element(By.XPATH, "//button[text()='Mode 2']").click()
        self.do("const s = document.querySelector('.vv-slider input'); s.value = 1.25;"
                "s.dispatchEvent(new Event('input', {bubbles: true}))")
        time.sleep(0.3)
        self.assertEqual(self.server.done("mode"), [{"do": "mode", "index": 1}])
        self.assertEqual(self.server.done("slide"),
                         [{"do": "slide", "joint": 0, "freedom": 0, "value": 1.25}])

    def test_a_lost_server_is_told_and_found_again(self):
        self.serve()
        port = self.server.port
        self.server.stop()
        self.wait("return vmechView.session.state === 'gone'")
        self.assertIn("server is gone", BROWSER.find_element(By.CSS_SELECTOR, ".vv-banner").text)
        self.server = FakeServer("", self.bar, True, port)
        self.wait("return vmechView.session.state === 'writer'")
        self.assertFalse(BROWSER.find_element(By.CSS_SELECTOR, ".vv-banner").is_displayed())

    def test_a_watcher_takes_hold_of_nothing(self):
        self.serve(writer=False)
        self.assertIn("Watching only", BROWSER.find_element(By.CSS_SELECTOR, ".vv-status").text)
        x, y = self.tip()
        self.mouse((x, y), "down", (x + 20, y + 20), "up")
        time.sleep(0.2)
        self.assertEqual(self.server.done("grab") + self.server.done("drag"), [])


if __name__ == "__main__":
    SCRIPTS = pathlib.Path(sys.argv.pop(1)).resolve()
    FOLDER = pathlib.Path(sys.argv.pop(3)).resolve()
    FOLDER.mkdir(parents=True, exist_ok=True)
    BROWSER = open_browser(sys.argv.pop(1), sys.argv.pop(1), FOLDER)
    try:
        unittest.main(verbosity=2)
    finally:
        BROWSER.quit()
