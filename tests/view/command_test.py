"""vmech's own pages in a browser. Usage: command_test.py VMECH CHROMIUM CHROMEDRIVER FOLDER"""

import math
import pathlib
import re
import shutil
import signal
import socket
import subprocess
import sys
import time
import unittest
import urllib.error
import urllib.request
import xml.etree.ElementTree

from selenium.webdriver.common.by import By
from selenium.webdriver.support.ui import WebDriverWait

from browser import errors_of, open_browser, resize
from mouse import Mouse

EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "mechanisms" / "examples"
GRAVITY = 9.81
MILLIMETRE = 1e-3

LIMITED = """
vmech: "1.0"
name: limited
units: {length: m, angle: rad}
gravity: [0, -9.81, 0]
ground: frame
links:
  frame: {anchors: {a: {origin: [0, 0, 0], z: [0, 0, 1], x: [1, 0, 0]}}}
  '<img src=x onerror=window.ran=1>':
    mass: 1
    center_of_gravity: [0.5, 0, 0]
    anchors: {a: {origin: [0, 0, 0], z: [0, 0, 1], x: [1, 0, 0]},
              b: {origin: [1, 0, 0], z: [0, 0, 1], x: [1, 0, 0]}}
joints:
  hinge:
    {type: revolute, connects: [frame/a, '<img src=x onerror=window.ran=1>/a'], start: 0,
     limits: [-0.5, 0.5]}
"""


class View:
    """A running `vmech view`."""

    def __init__(self, path):
        self.process = subprocess.Popen([VMECH, "view", str(path)], stdout=subprocess.PIPE,
                                        stderr=subprocess.STDOUT, text=True)
        self.said = ""
        for line in self.process.stdout:
            self.said += line
            found = re.search(r"http://127\.0\.0\.1:(\d+)/\?token=(\w+)", line)
            if found:
                self.url, self.port, self.token = found[0], int(found[1]), found[2]
                return
        raise AssertionError(f"vmech view {path} says no address: {self.said}")

    def stop(self, how=signal.SIGINT):
        self.process.send_signal(how)
        self.process.communicate(timeout=10)
        return self.process.returncode


class CommandTest(unittest.TestCase):
    def setUp(self):
        resize(BROWSER, 1200)
        self.view = None

    def tearDown(self):
        BROWSER.get("about:blank")
        if self.view:
            self.view.stop(signal.SIGKILL)
        errors_of(BROWSER)

    def do(self, script, *arguments):
        return BROWSER.execute_script(script, *arguments)

    def wait(self, script, *arguments, seconds=15):
        return WebDriverWait(BROWSER, seconds, 0.05).until(
            lambda browser: browser.execute_script(script, *arguments))

    def open(self, path):
        self.view = View(path)
        BROWSER.get(self.view.url)
        self.wait("return Boolean(window.vmechView) && vmechView.session.received > 0")
        self.mouse = Mouse(BROWSER)

    def state(self):
        return self.do("return vmechView.session.last")

    def screen(self, link, point):
        return self.do("return vmechView.screenOf(vmechView.pointOf(arguments[0], arguments[1]))",
                       link, point)

    def settle(self):
        """Until the newest states no longer differ by a tenth of a micrometre."""
        before = None
        for _ in range(100):
            time.sleep(0.1)
            now = self.state()["poses"]
            if before and all(abs(a - b) < 1e-7 for p, q in zip(before, now)
                              for a, b in zip(p, q)):
                return self.state()
            before = now
        raise AssertionError("the mechanism does not come to rest")


class Hand(CommandTest):
    def pull(self, path, link, grip, goal):
        """Takes a link at a point of it, brings the mouse to where `goal` of the world is, and
        keeps it there."""
        self.open(path)
        x, y = self.screen(link, grip)
        self.mouse.pull((x, y), self.do("return vmechView.screenOf(arguments[0])", goal))
        self.wait("return vmechView.session.last.mode === 'held'")
        return self.settle()

    def test_drags_the_crank_of_a_four_bar_to_where_its_circle_allows(self):
        state = self.pull(EXAMPLES / "four-bar.yaml", 1, [0.4, 0, 0], [-0.05, 0.42, 0])
        target, point = state["hand"]["target"], state["hand"]["point"]
        self.assertGreater(state["coordinates"][0], 1.2)  # from 0.52 rad
        angle = math.atan2(target[1], target[0])
        reach = math.hypot(*point[:2])
        allowed = [reach * math.cos(angle), reach * math.sin(angle)]
        self.assertLess(math.dist(point[:2], allowed), MILLIMETRE)
        self.assertLess(state["closure"], 1e-12)

    def test_the_force_that_is_shown_holds_the_weight(self):
        """A rod on a hinge: the moments of hand and weight about it are in balance."""
        self.pull(EXAMPLES / "crank.yaml", 1, [0.25, 0, 0], [0.24, 0.05, 0])
        self.mouse.steps("up")
        state = self.settle()
        force, point = state["hand"]["force"], state["hand"]["point"]
        angle = state["coordinates"][0]
        moment = point[0] * force[1] - point[1] * force[0]
        self.assertAlmostEqual(moment, 0.8 * GRAVITY * 0.15 * math.cos(angle), delta=1e-4)
        shown = BROWSER.find_element(By.CSS_SELECTOR, ".vv-force").text
        self.assertAlmostEqual(float(shown.split()[0]), math.hypot(*force), delta=2e-3)
        # The hinge carries what the hand does not: first link on second, axes of the frame.
        hinge = state["wrenches"][0]
        self.assertAlmostEqual(hinge[0] + force[0], 0, delta=1e-4)
        self.assertAlmostEqual(hinge[1] + force[1], 0.8 * GRAVITY, delta=1e-4)
        self.assertEqual(state["certainty"][0], ["certain"] * 6)
        latencies = sorted(self.do("return vmechView.session.latencies"))
        self.assertGreater(len(latencies), 0)
        print(f"from the mouse to the picture: {latencies[len(latencies) // 2]:.0f} ms median of "
              f"{len(latencies)}")

    def test_a_limit_stops_it_and_a_hostile_name_runs_nothing(self):
        path = FOLDER / "limited.yaml"
        path.write_text(LIMITED, encoding="utf-8")
        state = self.pull(path, 1, [0.4, 0, 0], [0.32, 0.24, 0])
        self.assertAlmostEqual(state["coordinates"][0], 0.5, delta=1e-4)
        self.assertEqual(state["at_limit"], [0])
        self.assertIsNone(self.do("return window.ran"))
        self.assertIn('<img src=x onerror=window.ran=1>',
                      BROWSER.find_element(By.TAG_NAME, "body").text)

    def test_sliders_modes_and_the_start(self):
        self.open(EXAMPLES / "four-bar.yaml")
        self.do("vmechView.session.send({do: 'slide', joint: 0, freedom: 0, value: 2})")
        self.wait("return Math.abs(vmechView.session.last.coordinates[0] - 2) < 1e-9")
        self.assertLess(self.state()["closure"], 1e-12)
        self.do("vmechView.session.view.on('modes', (m) => { window.modes = m.modes; });"
                "vmechView.session.send({do: 'modes'})")
        modes = self.wait("return window.modes")
        self.assertEqual(len(modes), 2)
        # Elbow up and elbow down: the coupler's end in each, from the two circles.
        pin = [0.5 * math.cos(2), 0.5 * math.sin(2)]
        ends = set()
        for mode in modes:
            x, y, _, w, _, _, z = mode["poses"][2]
            turn = 2 * math.atan2(z, w)
            end = [x + 1.2 * math.cos(turn), y + 1.2 * math.sin(turn)]
            self.assertLess(math.dist([x, y], pin), 1e-9)
            self.assertAlmostEqual(math.dist(end, [1.1, 0]), 0.75, delta=1e-9)
            ends.add(end[1] > 0)
        self.assertEqual(ends, {True, False})
        self.do("vmechView.session.send({do: 'reset'})")
        self.wait("return Math.abs(vmechView.session.last.coordinates[0] - Math.PI / 6) < 1e-9")

    def test_a_drag_is_saved_as_a_study_that_runs(self):
        self.pull(EXAMPLES / "four-bar.yaml", 1, [0.4, 0, 0], [0.2, 0.4, 0])
        self.mouse.steps("up")
        BROWSER.find_element(By.XPATH, "//button[text()='Save the drag']").click()
        for end in (".yaml", ".csv", "-study.yaml"):
            name = f"four-bar-drag{end}"
            WebDriverWait(BROWSER, 5).until(
                lambda browser, name=name: browser.find_element(By.LINK_TEXT, name)).click()
            deadline = time.monotonic() + 10
            while not (FOLDER / name).exists():
                self.assertLess(time.monotonic(), deadline, f"{name} is not saved")
                time.sleep(0.1)
        run = subprocess.run(
            [VMECH, "loads", FOLDER / "four-bar-drag-study.yaml", "--out", FOLDER / "drag", "-q"],
            capture_output=True, text=True, check=False)
        self.assertEqual(run.returncode, 0, run.stderr)


PARAMETERS_STUDY = """
vmech_study: "1.0"
mechanism: four-bar-by-lengths.yaml
units: {length: m, angle: rad}
motion: {joint: main, rpm: 60, turns: 1, steps: 60}
bearings:
  rocker_pivot: {positions: [-0.02, 0.02], locating: 0, shaft: [10, 25], life_hours: 20000}
"""


class Design(CommandTest):
    """A mechanism of which the parameters are moved on the page."""

    def vary(self, name, value):
        names = [p["name"] for p in self.do("return vmechView.scene.session.parameters")]
        asked = names.index(name), value
        self.do("vmechView.session.send({do: 'vary', parameter: arguments[0], "
                "value: arguments[1]})", *asked)
        self.wait("const d = vmechView.session.last.design; return d.stopped || "
                  "Math.abs(d.values[arguments[0]] - arguments[1]) < 1e-12", *asked)
        return self.state()["design"]

    def crank_length(self):
        links = self.do("return vmechView.scene.links")
        crank = next(link for link in links if link["name"] == "crank")
        return math.dist(*[anchor["pose"][:3] for anchor in crank["anchors"]])

    def test_a_crank_that_is_held_grows(self):
        self.open(EXAMPLES / "four-bar-by-lengths.yaml")
        names = [p["name"] for p in self.do("return vmechView.scene.session.parameters")]
        self.assertEqual(names, ["ground", "crank", "coupler", "rocker"])  # 'turn' is a start alone
        self.do("vmechView.session.send({do: 'grab', link: 2, point: [0.6, 0, 0]})")
        design = self.vary("crank", 0.4)
        self.assertNotIn("stopped", design)
        self.assertNotEqual(design["work"], 0)
        self.wait("return vmechView.scene.links[1].anchors.some((a) => "
                  "Math.abs(a.pose[0] - 0.4) < 1e-12)")
        self.assertAlmostEqual(self.crank_length(), 0.4, delta=1e-12)
        self.assertLess(self.settle()["closure"], 1e-9)
        self.assertEqual(self.state()["mode"], "held")
        # The pins are where circles of these lengths meet.
        pin = self.do("return vmechView.pointOf(1, [0.4, 0, 0])")
        end = self.do("return vmechView.pointOf(2, [1.2, 0, 0])")
        self.assertAlmostEqual(math.hypot(*pin[:2]), 0.4, delta=1e-8)
        self.assertAlmostEqual(math.dist(pin, end), 1.2, delta=1e-8)
        self.assertAlmostEqual(math.dist(end[:2], [1.1, 0]), 0.75, delta=1e-8)
        # What cannot be assembled is refused, with the reason.
        self.assertIn("coupler = 2.4 m", self.vary("coupler", 2.4)["stopped"])
        self.do("vmechView.session.view.on('files', (f) => { window.files = f; });"
                "vmechView.session.send({do: 'save', what: 'parameters'})")
        files = self.wait("return window.files")
        saved = FOLDER / files[0]["name"]
        saved.write_text(files[0]["text"])
        self.assertIn("crank: 0.4 m\n", files[0]["text"])
        self.assertIn("coupler: 1.2 m\n", files[0]["text"])
        subprocess.run([VMECH, "check", str(saved)], check=True, stdout=subprocess.PIPE)
        self.assertEqual(errors_of(BROWSER), [])

    def test_the_figures_of_a_study_follow(self):
        shutil.copy(EXAMPLES / "four-bar-by-lengths.yaml", FOLDER)
        (FOLDER / "grows-study.yaml").write_text(PARAMETERS_STUDY)
        self.open(FOLDER / "grows-study.yaml")
        self.do("const receive = vmechView.session.receive.bind(vmechView.session);"
                "vmechView.session.receive = (text) => { const m = JSON.parse(text);"
                "if (m.outcome) window.outcome = m.outcome; receive(text); };")
        self.vary("crank", 0.3)
        self.wait("return window.outcome && outcome.state === 'done' && "
                  "outcome.figures.some((f) => f.before !== f.now)")
        figures = {f["name"]: f for f in self.do("return outcome.figures")}
        shown = subprocess.run([VMECH, "sensitivities", "grows-study.yaml", "--set", "crank=0.3",
                                "--by", "crank", "--out", "told"], cwd=FOLDER, check=True,
                               stdout=subprocess.PIPE, text=True)
        self.assertTrue(shown.stdout)
        rows = [line.split(",") for line in
                (FOLDER / "told" / "sensitivities.csv").read_text().splitlines()[1:]]
        peaks = {row[0]: float(row[2]) for row in rows}
        for name in ("main.force", "rocker_pivot.force", "main.drive"):
            self.assertAlmostEqual(figures[name]["now"] / peaks[name], 1, delta=1e-9)
            self.assertNotEqual(figures[name]["before"], figures[name]["now"])
        elasticity = {row[0]: float(row[-1]) for row in rows if row[-1]}
        for by in figures["main.drive"]["by"]:
            if by["parameter"] == "crank":
                self.assertAlmostEqual(by["percent"], elasticity["main.drive"], delta=1e-6)

    def test_a_device_holds_it_while_it_changes(self):
        command = [VMECH, "haptic", str(EXAMPLES / "four-bar-by-lengths.yaml"), "--view",
                   "--seconds", "60"]
        with subprocess.Popen(command, cwd=FOLDER, stdout=subprocess.PIPE, text=True) as session:
            url = next(line.strip() for line in session.stdout if "http://" in line)
            BROWSER.get(url)
            self.wait("return window.vmechView && vmechView.session.received > 20")
            design = self.vary("crank", 0.45)
            self.assertNotIn("stopped", design)
            self.wait("return vmechView.scene.links[1].anchors.some((a) => "
                      "Math.abs(a.pose[0] - 0.45) < 1e-12)")
            session.send_signal(signal.SIGINT)
            said, _ = session.communicate(timeout=15)
        self.assertIn("its design was changed", said)
        self.assertEqual(session.returncode, 0)


class Doors(CommandTest):
    def status(self, url, **headers):
        request = urllib.request.Request(url, headers=headers)
        try:
            return urllib.request.urlopen(request, timeout=10).status
        except urllib.error.HTTPError as error:
            return error.code

    def socket_status(self, query, **headers):
        """The first line of the answer to a WebSocket's request."""
        lines = {"Host": f"127.0.0.1:{self.view.port}", "Upgrade": "websocket",
                 "Connection": "Upgrade", "Sec-WebSocket-Key": "dGhlIHNhbXBsZSBub25jZQ==",
                 "Sec-WebSocket-Version": "13", **headers}
        request = f"GET /socket?{query} HTTP/1.1\r\n" + "".join(
            f"{name}: {value}\r\n" for name, value in lines.items()) + "\r\n"
        with socket.create_connection(("127.0.0.1", self.view.port), timeout=10) as client:
            client.sendall(request.encode())
            return client.recv(64).decode(errors="replace").split("\r\n")[0]

    def test_only_the_own_page_comes_in(self):
        self.open(EXAMPLES / "four-bar.yaml")
        view, own = self.view, f"http://127.0.0.1:{self.view.port}"
        self.assertEqual(self.status(view.url), 200)
        self.assertEqual(self.status(view.url[:-1] + "x"), 403)
        self.assertEqual(self.status(own + "/"), 403)
        self.assertEqual(self.status(view.url, Origin="http://elsewhere.example"), 403)
        self.assertEqual(self.status(view.url, Host="elsewhere.example"), 403)
        token = f"token={view.token}"
        self.assertIn("101", self.socket_status(token, Origin=own))
        for query, headers in (("token=0", {"Origin": own}), (token, {}),
                               (token, {"Origin": "http://elsewhere.example"}),
                               (token, {"Origin": own, "Host": "elsewhere.example"})):
            self.assertNotIn("101", self.socket_status(query, **headers))

    def test_a_second_page_watches_until_the_first_is_closed(self):
        self.open(EXAMPLES / "four-bar.yaml")
        first = BROWSER.current_window_handle
        BROWSER.switch_to.new_window("tab")
        BROWSER.get(self.view.url)
        self.wait("return window.vmechView && vmechView.session.state === 'watching'")
        self.do("vmechView.session.send({do: 'slide', joint: 0, freedom: 0, value: 1})")
        time.sleep(0.3)
        self.assertAlmostEqual(self.state()["coordinates"][0], math.pi / 6, delta=1e-9)
        second = BROWSER.current_window_handle
        BROWSER.switch_to.window(first)
        BROWSER.close()
        BROWSER.switch_to.window(second)
        # Asked again, as by clicking: the server may not have seen yet that the first has gone.
        self.wait("vmechView.session.send({do: 'write'});"
                  "return vmechView.session.state === 'writer'")

    def test_closing_the_page_lets_go_and_a_lost_server_is_told(self):
        self.open(EXAMPLES / "four-bar.yaml")
        self.do("vmechView.session.send({do: 'swing'})")
        self.wait("return vmechView.session.last.mode === 'swinging'")
        BROWSER.get("about:blank")
        BROWSER.get(self.view.url)
        self.wait("return window.vmechView && vmechView.session.received > 0")
        self.assertEqual(self.state()["mode"], "frozen")
        self.assertEqual(self.view.stop(), 0)
        self.wait("return vmechView.session.state === 'gone'")
        self.assertIn("server is gone", BROWSER.find_element(By.CSS_SELECTOR, ".vv-banner").text)
        self.view = None


class Recordings(CommandTest):
    """A recording's page against `vmech replay --audit` of the same file."""

    ENERGIES = {"the hand did (\\S+) J": "work of the hand", "(\\S+) J went into motion": "motion",
                "(\\S+) J into height": "height", "(\\S+) J into springs": "joints",
                "(\\S+) J were taken": "taken", "(\\S+) J by what closes": "withheld"}
    IN_TWO_FIGURES = {"(\\S+) J are not traced": "not traced", "constraints did (\\S+) J": "work"}

    def record(self):
        path = FOLDER / "held.csv"
        subprocess.run([VMECH, "haptic", EXAMPLES / "slider-crank.yaml", "--free", "--seconds", "2",
                        "--record", path, "--force", "--quiet"], check=True, cwd=FOLDER)
        return path

    def show(self, path):
        """The page's audit, and what the command says."""
        said = subprocess.run([VMECH, "replay", path, "--audit"], capture_output=True, text=True)
        self.view = View(path)
        BROWSER.get(self.view.url)
        self.wait("return Boolean(window.vmechView)")
        self.assertEqual(errors_of(BROWSER), [])
        audit = self.do("""const {words, findings, charts} = vmechView.scene.motion.audit;
            const ends = charts.flatMap(({series}) => series.map(
                ({name, values}) => [name, values[values.length - 1]]));
            return {words, findings, ends: Object.fromEntries(ends)};""")
        return audit, said

    def test_shows_what_its_audit_computes(self):
        audit, said = self.show(self.record())
        self.assertEqual(said.returncode, 0)
        for finding in audit["findings"]:
            line = next(line for line in said.stdout.splitlines() if finding["what"] in line)
            self.assertIn(f" {finding['worst']:.2g} ", line)
        for words, name in self.ENERGIES.items():
            told = float(re.search(words, said.stdout)[1])
            self.assertAlmostEqual(audit["ends"][name], told, delta=1e-3 * abs(told), msg=name)
        for words, name in self.IN_TWO_FIGURES.items():
            told = float(re.search(words, said.stdout)[1])
            self.assertAlmostEqual(audit["ends"][name], told, delta=0.06 * abs(told), msg=name)
        closure = next(f for f in audit["findings"] if "closed to" in f["what"])
        largest = self.do("""return Math.max(...vmechView.scene.motion.audit.charts[1]
            .series[0].values)""")
        self.assertLessEqual(largest, closure["worst"] * (1 + 1e-6))
        self.assertGreater(largest, 0)
        self.assertIn(audit["words"][0].split(": ")[1].rstrip("."), said.stdout)
        self.assertTrue(BROWSER.find_element(By.CSS_SELECTOR, ".vv-verdict").is_displayed())

    def test_its_plots_and_the_mechanism_share_a_cursor(self):
        self.show(self.record())
        for place in (0, 700.25, 1999):
            self.do("vmechView.goTo(arguments[0])", place)
            values, wanted = self.do("""
                const {charts} = vmechView.scene.motion.audit, i = Math.floor(arguments[0]);
                const part = arguments[0] - i;
                const keys = document.querySelectorAll(".vv-figure .vv-key b");
                return [Array.from(keys, (key) => Number(key.textContent)),
                  charts.flatMap(({series}) => series.map(({values}) => values[i] + part *
                      (values[Math.min(i + 1, values.length - 1)] - values[i])))]""", place)
            self.assertEqual(len(values), 9)
            for value, exact in zip(values, wanted):
                self.assertAlmostEqual(value, exact, delta=6e-3 * abs(exact) + 1e-12)
        chart = BROWSER.find_elements(By.CSS_SELECTOR, ".vv-figure canvas")[-1]
        left, top, width = self.do("""arguments[0].scrollIntoView({block: "center"});
            const {left, top, width} = arguments[0].getBoundingClientRect();
            return [left, top, width]""", chart)
        # Half way between the edges of the plot, which lie 50 and 8 pixels within.
        Mouse(BROWSER).steps((left + 50 + (width - 58) / 2, top + 40), "down", "up")
        self.assertAlmostEqual(self.do("return vmechView.time()"), 1, delta=0.02)

    def test_a_number_that_does_not_belong_there_is_told(self):
        path = self.record()
        lines = path.read_text().splitlines(keepends=True)
        names = next(line for line in lines if line.startswith("sequence")).split(",")
        column = next(i for i, name in enumerate(names) if name.startswith("coordinate"))
        row = lines[-500].split(",")
        row[column] = str(float(row[column]) + 1e-3)
        lines[-500] = ",".join(row)
        path.write_text("".join(lines))
        audit, said = self.show(path)
        self.assertEqual(said.returncode, 3)
        self.assertIn("not sound", audit["words"][0])
        self.assertTrue(self.do("return Boolean(document.querySelector('.vv-verdict.vv-stopped'))"))
        self.assertEqual(self.do("return document.querySelectorAll('.vv-unsound').length"),
                         sum(not finding["sound"] for finding in audit["findings"]))


class Documents(CommandTest):
    def test_the_report_plays_its_motion_from_the_disk(self):
        out = FOLDER / "slider-crank"
        shutil.rmtree(out, ignore_errors=True)
        subprocess.run([VMECH, "loads", EXAMPLES / "slider-crank-study.yaml", "--out", out, "-q"],
                       check=True)
        report = out / "report.html"
        xml.etree.ElementTree.fromstring(report.read_text(encoding="utf-8").split("\n", 1)[1])
        BROWSER.get(report.as_uri())
        self.wait("return Boolean(window.vmechView)")
        self.assertEqual(errors_of(BROWSER), [])
        self.assertTrue(self.do("return vmechView.renderer"))
        self.do("vmechView.goTo(90)")
        # The crank turns evenly, 2 turns in 720 steps from 40 degrees on.
        turn = math.radians(40 + 2 * 360 * 90 / 720)
        crank = self.do("return vmechView.pointOf(1, [0.1, 0, 0])")
        angle = math.atan2(crank[1], crank[0])
        self.assertLess(abs(math.remainder(angle - turn, 2 * math.pi)), 1e-6)
        self.view = View(out)
        BROWSER.get(self.view.url)
        self.wait("return Boolean(window.vmechView)")
        self.assertEqual(errors_of(BROWSER), [])


    def test_a_drawing_opens_from_the_disk(self):
        drawing = FOLDER / "delta.html"
        subprocess.run([VMECH, "check", EXAMPLES / "delta-robot.yaml", "--draw", drawing],
                       check=True, capture_output=True)
        BROWSER.get(drawing.as_uri())
        self.wait("return Boolean(window.vmechView)")
        self.assertEqual(errors_of(BROWSER), [])
        self.assertGreater(self.do("return vmechView.triangles"), 100)

    def test_a_haptic_session_is_seen_while_it_runs(self):
        command = [VMECH, "haptic", str(EXAMPLES / "slider-crank-by-hand-study.yaml"), "--view",
                   "--seconds", "20", "--coupling", "paper"]
        with subprocess.Popen(command, cwd=FOLDER, stdout=subprocess.PIPE, text=True) as session:
            url = next(line.strip() for line in session.stdout if "http://" in line)
            BROWSER.get(url)
            self.wait("return window.vmechView && vmechView.session.received > 20")
            state, drawn = self.do("return [vmechView.session.last, vmechView.poses()]")
            self.assertEqual(drawn, state["poses"])
            grasp, crank = state["haptic"]["grasp"], state["coordinates"][0]
            # The grasp lies 100 mm behind the pin on the coupler: the length is that of the file.
            pin = [0.05 * math.cos(crank), 0.05 * math.sin(crank)]
            self.assertAlmostEqual(math.dist(grasp[:2], pin), 0.1, delta=1e-9)
            session.send_signal(signal.SIGINT)
            session.communicate(timeout=15)
        self.wait("return vmechView.session.state === 'gone'")


if __name__ == "__main__":
    VMECH = str(pathlib.Path(sys.argv.pop(1)).resolve())
    FOLDER = pathlib.Path(sys.argv.pop(3)).resolve()
    shutil.rmtree(FOLDER, ignore_errors=True)
    FOLDER.mkdir(parents=True)
    BROWSER = open_browser(sys.argv.pop(1), sys.argv.pop(1), FOLDER)
    try:
        unittest.main(verbosity=2)
    finally:
        BROWSER.quit()
