"""vmech sensitivities against differences of whole runs of vmech loads.

Nothing of the derivatives is shared: the mechanism's file is changed as text, the loads are run
anew, and their tables are read. usage: sensitivities_test.py VMECH EXAMPLES WORK
"""

import csv
import json
import math
import pathlib
import re
import shutil
import subprocess
import sys
import unittest

VMECH, EXAMPLES, WORK = sys.argv[1], pathlib.Path(sys.argv[2]).resolve(), pathlib.Path(sys.argv[3])
MECHANISM, STUDY = "slider-crank.yaml", "slider-crank-study.yaml"


def run(*words):
    return subprocess.run([VMECH, *map(str, words)], capture_output=True, text=True, check=False)


def rows(path):
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


class Folder:
    """A copy of the study whose mechanism can be changed."""

    def __init__(self, name):
        self.path = WORK / name
        shutil.rmtree(self.path, ignore_errors=True)
        self.path.mkdir(parents=True)
        for source in EXAMPLES.glob("slider-crank*"):
            shutil.copy(source, self.path)
        self.original = (self.path / MECHANISM).read_text(encoding="utf-8")

    def figures(self, pattern, value):
        """The figures of the study with a number of the mechanism replaced."""
        text, count = re.subn(pattern, lambda m: m[1] + repr(value) + m[3], self.original,
                              flags=re.DOTALL)
        assert count == 1, pattern
        (self.path / MECHANISM).write_text(text, encoding="utf-8")
        done = run("loads", self.path / STUDY, "--out", self.path / "out", "-q")
        assert done.returncode in (0, 4), done.stderr
        loads = rows(self.path / "out" / "loads.csv")

        def size(joint, components, pose=None):
            course = [math.hypot(*(float(row[f"{joint}.{c}"]) for c in components))
                      for row in loads]
            return max(course) if pose is None else course[pose]

        summary = json.loads((self.path / "out" / "summary.json").read_text(encoding="utf-8"))
        bearings = {b["joint"]: b for b in summary["bearings"]}
        return {"pin.force": size("pin", ("fx", "fy", "fz")),
                "wrist.force": size("wrist", ("fx", "fy", "fz")),
                "main.drive": max(abs(float(row["drive.force"])) for row in loads),
                "main.life": bearings["main"]["system_life_hours"],
                "pin.life": bearings["pin"]["system_life_hours"]}

    def difference(self, pattern, value, step):
        at = {k: self.figures(pattern, value + k * step) for k in (-2, -1, 1, 2)}
        return {name: (8 * (at[1][name] - at[-1][name]) - (at[2][name] - at[-2][name]))
                      / (12 * step) for name in at[1]}


class Sensitivities(unittest.TestCase):
    # parameter of the command, where it stands in the file, value in its unit
    PARAMETERS = {
        "crank/pin.x": (r"(  crank:.*?pin:  \{origin: \[)(50)(, 0, 0\])", 50.0),
        "slider.mass": (r"(  slider:\n    mass: )(0\.3)(\n)", 0.3),
    }

    def test_equal_the_differences_of_whole_studies(self):
        folder = Folder("differences")
        done = run("sensitivities", folder.path / STUDY, "--out", folder.path / "sensitivities",
                   "--by", ",".join(self.PARAMETERS))
        self.assertEqual(done.returncode, 0, done.stderr)
        table = {(row["figure"], row["parameter"]): row
                 for row in rows(folder.path / "sensitivities" / "sensitivities.csv")}
        for parameter, (pattern, value) in self.PARAMETERS.items():
            differences = folder.difference(pattern, value, 1e-3 * value)
            values = folder.figures(pattern, value)
            for figure, difference in differences.items():
                row = table[figure, parameter]
                with self.subTest(figure=figure, parameter=parameter):
                    self.assertAlmostEqual(float(row["value"]) / values[figure], 1, delta=1e-12)
                    scale = values[figure] / value
                    self.assertAlmostEqual(float(row["slope"]) / scale, difference / scale,
                                           delta=2e-8)

    def test_tells_what_opens_the_loop(self):
        done = run("sensitivities", EXAMPLES / STUDY, "--by", "crank/pin.z,slider.mass")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("crank/pin.z: the loop that is cut at", done.stdout)
        self.assertIn("slider.mass", done.stdout)

    def test_refuses_unknown_names(self):
        for option, name, hint in (("--by", "crank/pim.x", "crank/pin.x"),
                                   ("--of", "pin.torque", "pin.force")):
            done = run("sensitivities", EXAMPLES / STUDY, option, name)
            self.assertEqual(done.returncode, 2)
            self.assertIn(name, done.stderr)
            self.assertIn(hint, done.stderr)

    def test_refuses_what_statics_does_not_determine_unless_asked(self):
        door = EXAMPLES / "door-on-two-hinges.yaml"
        study = WORK / "door.yaml"
        study.write_text(f"""vmech_study: "1.0"
mechanism: {door}
units: {{length: m, angle: deg}}
motion: {{joint: lower, rpm: 10, turns: 0.25, steps: 8}}
""", encoding="utf-8")
        plain = run("sensitivities", study)
        self.assertEqual(plain.returncode, 0, plain.stderr)
        self.assertIn("not determined by statics: fx, fy, fz", plain.stdout)
        asked = run("sensitivities", study, "--undetermined")
        self.assertNotIn("not determined", asked.stdout)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
