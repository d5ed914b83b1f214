"""vmech sensitivities and vmech optimise against whole runs of vmech loads.

Nothing of the derivatives is shared: the mechanism's file is changed as text, the loads are run
anew, and their tables are read. usage: design_test.py VMECH EXAMPLES WORK
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

    def put(self, pattern, value):
        """Replaces a number of the mechanism."""
        text, count = re.subn(pattern, lambda m: m[1] + repr(value) + m[3], self.original,
                              flags=re.DOTALL)
        assert count == 1, pattern
        (self.path / MECHANISM).write_text(text, encoding="utf-8")

    def loads(self):
        """The loads of the study as it is."""
        done = run("loads", self.path / STUDY, "--out", self.path / "out", "-q")
        assert done.returncode in (0, 4), done.stderr
        return rows(self.path / "out" / "loads.csv")

    def ground_forces(self, pattern, value):
        """What the frame exerts, pose by pose: at main in the world's axes, at the guide, whose z
        is the world's x and whose x is the world's y."""
        self.put(pattern, value)
        return [(float(row["main.fx"]) + float(row["guide.fz"]),
                 float(row["main.fy"]) + float(row["guide.fx"]),
                 float(row["main.fz"]) + float(row["guide.fy"])) for row in self.loads()]

    def figures(self, pattern, value):
        """The figures of the study with a number of the mechanism replaced."""
        self.put(pattern, value)
        loads = self.loads()

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

    def with_parameters(self, name):
        """The study with the crank's radius and the piston's mass by parameters."""
        folder = Folder(name)
        text = folder.original.replace("pin:  {origin: [50, 0, 0]", "pin:  {origin: [radius, 0, 0]")
        text = text.replace("    mass: 0.3\n", "    mass: 3 * unit_mass\n")
        block = "parameters: {radius: 50 mm, unit_mass: 0.1 kg}\n"
        text = text.replace("links:\n", block + "links:\n", 1)
        (folder.path / MECHANISM).write_text(text, encoding="utf-8")
        return folder

    def test_by_parameters_of_the_file_are_those_by_its_numbers(self):
        folder = self.with_parameters("parameters")
        done = run("sensitivities", folder.path / STUDY, "--out", folder.path / "by-parameters")
        self.assertEqual(done.returncode, 0, done.stderr)
        done = run("sensitivities", EXAMPLES / STUDY, "--by", "crank/pin.x,slider.mass", "--out",
                   folder.path / "by-numbers")
        self.assertEqual(done.returncode, 0, done.stderr)
        parameters = rows(folder.path / "by-parameters" / "sensitivities.csv")
        numbers = rows(folder.path / "by-numbers" / "sensitivities.csv")
        self.assertEqual({row["parameter"] for row in parameters}, {"radius", "unit_mass"})
        self.assertEqual(len(parameters), len(numbers))
        for by_parameter, by_number in zip(parameters, numbers):
            self.assertEqual(by_parameter["figure"], by_number["figure"])
            self.assertAlmostEqual(float(by_parameter["elasticity"]),
                                   float(by_number["elasticity"]), delta=1e-9)

    def test_designs_by_parameters_of_the_file(self):
        folder = self.with_parameters("parameters-design")
        done = run("optimise", folder.path / STUDY, "--minimise", "main.drive", "--vary",
                   "radius=45..60", "--vary", "coupler.mass=0.2..0.35", "--out",
                   folder.path / "design")
        self.assertEqual(done.returncode, 0, done.stderr)
        table = {row["name"]: row for row in rows(folder.path / "design" / "design.csv")}
        self.assertAlmostEqual(float(table["radius"]["after"]), 45, delta=1e-6)
        again = run("sensitivities", folder.path / STUDY, "--set", "radius=45", "--by",
                    "coupler.mass", "--of", "main.drive", "--out", folder.path / "again")
        self.assertEqual(again.returncode, 0, again.stderr)
        value = float(rows(folder.path / "again" / "sensitivities.csv")[0]["value"])
        self.assertAlmostEqual(value, float(table["main.drive"]["after"]), delta=1e-9 * value)

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


class Optimise(unittest.TestCase):
    COUNTERWEIGHT = (r"(  crank:\n    mass: 0\.4\n    center_of_gravity: \[)(25)(, 0, 0\])", 25.0)

    def design(self, name, *words):
        """The rows of design.csv by name."""
        done = run("optimise", *words, "--out", WORK / name)
        self.assertEqual(done.returncode, 0, done.stderr)
        return {row["name"]: row for row in rows(WORK / name / "design.csv")}

    def test_finds_the_counterweight_of_the_closed_form(self):
        # The force on the ground is linear in the place of the crank's centre: F = A + x B, so that
        # its mean square is least at x = -sum A.B / sum B.B.
        folder = Folder("counterweight")
        A = folder.ground_forces(self.COUNTERWEIGHT[0], 0.0)
        unit = folder.ground_forces(self.COUNTERWEIGHT[0], 100.0)
        B = [[(u - a) / 100 for u, a in zip(of_u, of_a)] for of_u, of_a in zip(unit, A)]

        def dot(p, q):
            return sum(a * b for u, v in zip(p, q) for a, b in zip(u, v))

        best = -dot(A, B) / dot(B, B)
        folder.put(*self.COUNTERWEIGHT)
        for method, delta in (("slsqp", 1e-4), ("mma", 1e-3)):
            table = self.design("balanced", folder.path / STUDY, "--minimise", "ground.force.rms",
                                "--vary", "crank.center_of_gravity.x=-100..50",
                                "--method", method)
            found = float(table["crank.center_of_gravity.x"]["after"])
            self.assertAlmostEqual(found, best, delta=delta)
            F = [[a + found * b for a, b in zip(u, v)] for u, v in zip(A, B)]
            self.assertAlmostEqual(float(table["ground.force.rms"]["after"]),
                                   math.sqrt(dot(F, F) / len(F)), delta=1e-8)

    def test_keeps_what_it_must_and_writes_the_mechanism(self):
        folder = Folder("kept")
        table = self.design("keeping", folder.path / STUDY, "--minimise", "main.drive",
                            "--vary", "crank/pin.x=40..60", "--vary", "coupler.mass=0.2..0.5",
                            "--keep", "pin.life>=11600")
        self.assertAlmostEqual(float(table["pin.life"]["after"]), 11600, delta=0.01)
        self.assertGreater(float(table["pin.life"]["gain"]), 0)
        shutil.copy(WORK / "keeping" / "mechanism.yaml", folder.path / MECHANISM)
        drive = max(abs(float(row["drive.force"])) for row in folder.loads())
        self.assertAlmostEqual(drive, float(table["main.drive"]["after"]), delta=1e-9 * drive)
        self.assertLess(drive, float(table["main.drive"]["before"]))

    def test_gain_is_what_a_looser_limit_gives(self):
        tables = [self.design(f"gain-{limit}", EXAMPLES / STUDY, "--minimise", "main.drive.rms",
                              "--vary", "crank/pin.x=40..60", "--vary", "coupler.mass=0.2..0.5",
                              "--keep", f"pin.life>={limit}") for limit in (11600, 11590)]
        drives = [float(table["main.drive.rms"]["after"]) for table in tables]
        gain = float(tables[0]["pin.life"]["gain"])
        self.assertAlmostEqual((drives[0] - drives[1]) / 10 / gain, 1, delta=0.02)

    def test_stays_where_the_mechanism_can_turn(self):
        # The rod is 150 mm long: a crank as long cannot turn.
        table = self.design("turning", EXAMPLES / STUDY, "--maximise", "main.drive.rms",
                            "--vary", "crank/pin.x=40..200")
        self.assertGreater(float(table["crank/pin.x"]["after"]), 50)
        self.assertLess(float(table["crank/pin.x"]["after"]), 150)

    def test_says_what_cannot_be_kept(self):
        done = run("optimise", EXAMPLES / STUDY, "--minimise", "mass", "--vary",
                   "crank.mass=0.2..0.5", "--keep", "pin.life>=100000")
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertIn("No design was found", done.stdout)

    def test_refuses_what_means_nothing(self):
        for words, code, hint in (
                (["--minimise", "mass"], 1, "--vary"),
                (["--vary", "crank.mass=0.2..0.5"], 1, "--minimise"),
                (["--minimise", "mass", "--vary", "crank.mass=0.2"], 1, "two bounds"),
                (["--minimise", "mass", "--vary", "crank.mass=1..2"], 2, "give bounds around it"),
                (["--minimise", "mass", "--vary", "crank.mass=0.2..1", "--keep", "mass=1"], 1,
                 "--keep"),
                (["--minimise", "main.drive", "--vary", "crank/pin.z=-1..1"], 2,
                 "cannot stay closed")):
            done = run("optimise", EXAMPLES / STUDY, *words)
            self.assertEqual(done.returncode, code, done.stderr)
            self.assertIn(hint, done.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
