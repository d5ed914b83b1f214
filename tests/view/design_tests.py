"""The design varied on the page; test cases for page_test.py."""

import time

from selenium.webdriver.common.keys import Keys

from scenes import torus_stl

PARAMETER = {"name": "crank", "unit": "mm", "value": 50, "lower": 25, "upper": 80}
BAR = 0.034 * 0.16  # m, the radius of a bar of scenes.FourBar, in proportion to its length
SINGLE = 1e-7       # m, of coordinates in single precision
FIGURES = [{"name": "pin.life", "unit": "h", "before": 12000, "now": 15300,
            "by": [{"parameter": "rod", "percent": 0.4}, {"parameter": "crank", "percent": -2.9}]},
           {"name": "main.drive", "unit": "N m", "before": 0, "now": 61.5, "by": []}]


class DesignTests:
    """Mixed into a served page."""

    def serve_design(self, name="crank", kind="mechanism", **more):
        self.serve(kind=kind, parameters=[{**PARAMETER, "name": name}], **more)
        self.server.design = {"values": [50.0], "asked": [50.0], "work": 0.0}
        self.wait("return vmechView.session.last.design")

    def receive(self, **message):
        self.do("vmechView.session.receive(JSON.stringify(arguments[0]))", message)

    def slide(self, value):
        self.do("const s = document.querySelector('.vv-parameter [type=range]');"
                "s.value = arguments[0]; s.dispatchEvent(new Event('input'))", value)

    def lasting(self):
        """The numbers of the field and the slider, once nothing is under way."""
        self.wait("return document.querySelector('.vv-reached').textContent === ''")
        return self.do("return [...document.querySelectorAll('.vv-parameter input')].map("
                       "(input) => Number(input.value))")

    def assert_crank_is(self, length):
        low, high = self.do("return vmechView.boundsOf(1)")
        self.assertAlmostEqual(high[0] - low[0], length + 2 * BAR, delta=SINGLE)

    def test_design_moved_by_slider_reaches_the_picture(self):
        self.serve_design()
        self.assert_crank_is(0.05)
        self.do("vmechView.pick('joint', 1)")
        eye = self.do("return vmechView.screenOf([0.1, 0.02, 0])")
        self.slide(62.5)
        self.assertEqual(self.lasting(), [62.5, 62.5])
        self.assertEqual(self.server.done("vary"),
                         [{"do": "vary", "parameter": 0, "value": 62.5}])
        self.assert_crank_is(0.0625)
        # The pin between crank and coupler is where the crank ends now.
        self.assertEqual(self.do("return vmechView.scene.links[1].anchors[1].pose[0]"), 0.0625)
        self.assertEqual(self.do("return vmechView.screenOf([0.1, 0.02, 0])"), eye)
        self.assertEqual(self.do("return [vmechView.picked().kind, vmechView.picked().index]"),
                         ["joint", 1])
        self.find("//button[text()='Reset design']").click()
        self.assertEqual(self.lasting(), [50, 50])
        self.assert_crank_is(0.05)

    def test_design_typed_is_applied_by_enter_and_refused_out_of_bounds(self):
        self.serve_design()
        field = self.find("//input[@inputmode='decimal']")
        field.send_keys(Keys.CONTROL, "a")
        field.send_keys("90", Keys.ENTER)
        self.assertIn("crank is a number from 25 to 80 mm", self.find(
            "//*[contains(@class, 'vv-note')]").get_attribute("textContent"))
        self.assertEqual(self.server.done("vary"), [])
        field.send_keys(Keys.CONTROL, "a")
        field.send_keys("45", Keys.ENTER)
        self.assertEqual(self.lasting(), [45, 45])
        self.assertEqual(self.server.done("vary")[-1]["value"], 45)

    def test_design_that_goes_no_further_says_why_and_the_slider_comes_back(self):
        self.serve_design()
        self.server.longest = 55
        self.slide(70)
        self.wait("return document.querySelector('.vv-stopped').textContent")
        self.assertEqual(self.find("//*[@class='vv-stopped']").text,
                         "the loops do not close beyond crank = 55 mm")
        self.assertEqual(self.lasting(), [55, 55])
        self.assert_crank_is(0.055)

    def test_design_leaves_no_geometry_behind_and_no_drag_broken(self):
        self.serve_design()
        self.do("for (const name of ['frames', 'centres', 'cuts', 'limits', 'moments', 'weights'])"
                "vmechView.show(name, true)")
        self.mouse(self.tip(), "down")
        first = self.bar.scene(0)
        counts = self.do("""
            const message = {scene: arguments[0]}, counts = [];
            for (let k = 0; k < 200; ++k) {
              message.scene.links[1].anchors[1].pose[0] = 0.05 + 1e-4 * (k + 1);
              message.scene.joints[3].freedoms[0].upper = 2 + 1e-3 * k;
              vmechView.session.receive(JSON.stringify(message));
              if (k % 8 === 0) { vmechView.picture(); counts.push(vmechView.geometries()); }
            }
            return counts""", first)
        self.assertEqual(set(counts), {counts[0]})
        self.assert_crank_is(0.07)
        self.assertEqual(self.server.done("release"), [])
        self.mouse("up")
        self.wait("return !document.querySelector('.vv-canvas').classList.contains('vv-holding')")

    def test_design_ends_a_recorded_motion_and_keeps_meshes(self):
        self.serve_design(poses=36, mesh=torus_stl(80))
        mesh = self.do("return vmechView.boundsOf(3)")
        self.slide(45)
        self.lasting()
        self.assertEqual(self.do("return document.querySelectorAll('.vv-player').length"), 0)
        self.assertEqual(self.do("return vmechView.poses()"), self.bar.poses(self.server.theta))
        self.assertEqual(self.do("return vmechView.boundsOf(3)"), mesh)
        self.assertIn("meshes keep their shape", self.find(
            "//*[contains(@class, 'vv-note')]").get_attribute("textContent"))

    def test_design_in_a_device_and_for_a_watcher(self):
        self.serve_design(kind="haptic")
        self.slide(30)
        self.assertEqual(self.lasting(), [30, 30])
        self.find("//button[text()='Save into the file']").click()
        deadline = time.monotonic() + 5
        while not self.server.done("save") and time.monotonic() < deadline:
            time.sleep(0.02)
        self.assertEqual(self.server.done("save"), [{"do": "save", "what": "parameters"}])
        self.receive(writer=False)
        self.assertFalse(self.find("//input[@inputmode='decimal']").is_enabled())

    def test_outcome_shows_figures_and_what_they_go_with(self):
        self.serve_design()
        self.receive(outcome={"state": "done", "text": "", "figures": FIGURES})
        table = self.find("//table[contains(@class, 'vv-outcome')]")
        self.assertEqual(table.text.split("\n")[:6], [
            "figure before now change", "pin.life h 12000 15300 +27.5 %", "crank", "-2.900", "rod",
            "+0.400"])
        self.assertIn("main.drive N m 0 61.50 –", table.text)
        self.receive(outcome={"state": "computing"})
        self.assertEqual(table.get_attribute("aria-busy"), "true")
        self.receive(outcome={"state": "refused", "text": "The loops do not close at pose 3."})
        self.assertIn("pose 3", self.find("(//p[contains(@class, 'vv-stopped')])[2]").text)

    def test_design_of_a_hostile_name_runs_nothing(self):
        name = "</script><img src=x onerror='window.stolen = 1'>\"><script>window.stolen = 2"
        self.serve_design(name)
        figure = {**FIGURES[0], "name": name, "unit": name,
                  "by": [{"parameter": name, "percent": 1}]}
        self.receive(outcome={"state": "refused", "text": name, "figures": [figure]})
        self.server.design["stopped"] = name
        self.slide(40)
        self.lasting()
        self.assertIsNone(self.do("return window.stolen || null"))
        self.assertEqual(self.do("return document.querySelectorAll("
                                 "'#vmech-view img, #vmech-view script').length"), 0)
        self.assertEqual(self.do("return document.querySelector('.vv-parameter .vv-name')"
                                 ".textContent"), name)
