"""vmech sensitivities and vmech optimise against whole runs of vmech loads, and published designs.

Nothing of the derivatives is shared: the mechanism's file is changed as text, the loads are run
anew, and their tables are read. usage: design_test.py VMECH EXAMPLES WORK
"""

import cmath
import csv
import json
import math
import pathlib
import re
import shutil
import subprocess
import sys
import time
import unittest

VMECH, EXAMPLES, WORK = sys.argv[1], pathlib.Path(sys.argv[2]).resolve(), pathlib.Path(sys.argv[3])
STUDIES = EXAMPLES.parents[1] / "studies" / "examples"
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

    def test_know_what_figures_owe_to_the_study_alone(self):
        # Loads do not depend on where bearings are and how sure they must be; their lives do.
        folder = Folder("bearing-places")
        text = (folder.path / STUDY).read_text(encoding="utf-8")
        text = text.replace("[-15, 15]", "[-15, place]", 1).replace("reliability: 90",
                                                                     "reliability: sure", 1)
        text = text.replace("steps: 720", "steps: 36")
        (folder.path / STUDY).write_text(
            text.replace("motion:", "parameters: {place: 20, sure: 92}\nmotion:", 1),
            encoding="utf-8")

        def life(name, value):
            done = run("loads", folder.path / STUDY, "--set", f"{name}={value!r}", "--out",
                       folder.path / "out", "-q")
            assert done.returncode in (0, 4), done.stderr
            summary = json.loads((folder.path / "out" / "summary.json").read_text("utf-8"))
            return {b["joint"]: b for b in summary["bearings"]}["main"]["system_life_hours"]

        done = run("sensitivities", folder.path / STUDY, "--undetermined", "--of", "main.life",
                   "--out", folder.path / "slopes")
        self.assertEqual(done.returncode, 0, done.stderr)
        for row in rows(folder.path / "slopes" / "sensitivities.csv"):
            name, value = row["parameter"], float(row["parameter_value"])
            step = 1e-3 * value
            at = {k: life(name, value + k * step) for k in (-2, -1, 1, 2)}
            difference = (8 * (at[1] - at[-1]) - (at[2] - at[-2])) / (12 * step)
            self.assertNotEqual(difference, 0)
            self.assertAlmostEqual(float(row["slope"]) / difference, 1, delta=1e-7)

    def test_refuses_corners(self):
        folder = self.with_parameters("corners")
        text = (folder.path / MECHANISM).read_text(encoding="utf-8")
        text = text.replace("mass: 0.35", 'mass: "max(0.35 kg, 0.35 kg * radius/50 mm)"')
        (folder.path / MECHANISM).write_text(text, encoding="utf-8")
        done = run("sensitivities", folder.path / STUDY, "--of", "pin.force")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stdout, "radius: a number .* has a corner")

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
        text = (EXAMPLES / "door-on-two-hinges.yaml").read_text(encoding="utf-8")
        text = text.replace("links:\n", "parameters: {stiff: 1e8 N/m, size: 30 kg}\nlinks:\n", 1)
        text = text.replace("[1.0e+8, 1.0e+8,", "[stiff, 1.0e+8,", 1)
        (WORK / "door-stiff.yaml").write_text(text.replace("mass: 30", "mass: size"),
                                              encoding="utf-8")
        study = WORK / "door.yaml"
        study.write_text("""vmech_study: "1.0"
mechanism: door-stiff.yaml
units: {length: m, angle: deg}
motion: {joint: lower, rpm: 10, turns: 0.25, steps: 8}
""", encoding="utf-8")
        plain = run("sensitivities", study)
        self.assertEqual(plain.returncode, 0, plain.stderr)
        self.assertIn("not determined by statics: fx, fy, fz", plain.stdout)
        self.assertNotIn("stiff: it changes", plain.stdout)
        asked = run("sensitivities", study, "--undetermined")
        self.assertNotIn("not determined by", asked.stdout)
        self.assertIn("stiff: it changes stiffnesses", asked.stdout)


FOUR_BAR = """vmech: "1.0"
units: {length: mm, angle: deg}
gravity: [0, -9.81, 0]
ground: frame
parameters: {rocker: 60}
links:
  frame: {anchors: {main: {}, foot: {origin: [100, 0, 0]}}}
  crank: {mass: 1, center_of_gravity: [15, 0, 0], anchors: {main: {}, pin: {origin: [30, 0, 0]}}}
  coupler: {mass: 1, center_of_gravity: [50, 0, 0], anchors: {pin: {}, tip: {origin: [90, 0, 0]}}}
  rocker:
    mass: 1
    center_of_gravity: [30, 5, 0]
    anchors: {foot: {}, tip: {origin: [rocker, 0, 0]}}
joints:
  main: {type: revolute, connects: [frame/main, crank/main], start: 60}
  pin: {type: revolute, connects: [crank/pin, coupler/pin], start: 90}
  tip: {type: revolute, connects: [coupler/tip, rocker/tip]}
  foot: {type: revolute, connects: [frame/foot, rocker/foot]}
"""


def design(name, *words):
    """The rows of design.csv by name."""
    done = run("optimise", *words, "--out", WORK / name)
    assert done.returncode == 0, done.stdout + done.stderr
    return {row["name"]: row for row in rows(WORK / name / "design.csv")}


class Optimise(unittest.TestCase):
    COUNTERWEIGHT = (r"(  crank:\n    mass: 0\.4\n    center_of_gravity: \[)(25)(, 0, 0\])", 25.0)

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
        for method, delta in (("slsqp", 1e-4), ("mma", 1e-3), ("ipopt", 1e-4)):
            table = design("balanced", folder.path / STUDY, "--minimise", "ground.force.rms",
                                "--vary", "crank.center_of_gravity.x=-100..50",
                                "--method", method)
            found = float(table["crank.center_of_gravity.x"]["after"])
            self.assertAlmostEqual(found, best, delta=delta)
            F = [[a + found * b for a, b in zip(u, v)] for u, v in zip(A, B)]
            self.assertAlmostEqual(float(table["ground.force.rms"]["after"]),
                                   math.sqrt(dot(F, F) / len(F)), delta=1e-8)

    def test_keeps_what_it_must_and_writes_the_mechanism(self):
        folder = Folder("kept")
        table = design("keeping", folder.path / STUDY, "--minimise", "main.drive",
                            "--vary", "crank/pin.x=40..60", "--vary", "coupler.mass=0.2..0.5",
                            "--keep", "pin.life>=11600")
        self.assertAlmostEqual(float(table["pin.life"]["after"]), 11600, delta=0.01)
        self.assertGreater(float(table["pin.life"]["gain"]), 0)
        shutil.copy(WORK / "keeping" / "mechanism.yaml", folder.path / MECHANISM)
        drive = max(abs(float(row["drive.force"])) for row in folder.loads())
        self.assertAlmostEqual(drive, float(table["main.drive"]["after"]), delta=1e-9 * drive)
        self.assertLess(drive, float(table["main.drive"]["before"]))

    def test_written_mechanism_is_on_the_branch_of_the_search(self):
        # From what the file states, a rocker of 60 mm is assembled on one side and one of 70 mm on
        # the other.
        (WORK / "branch.yaml").write_text(FOUR_BAR, encoding="utf-8")
        study = ('vmech_study: "1.0"\nmechanism: %s\nunits: {length: mm, angle: deg}\n'
                 "motion: {joint: main, rpm: 60, turns: 0.1, steps: 10}\n")
        (WORK / "branch-study.yaml").write_text(study % "branch.yaml", encoding="utf-8")
        table = design("branch", WORK / "branch-study.yaml", "--minimise", "main.drive",
                       "--vary", "rocker=55..100")
        self.assertGreater(float(table["rocker"]["after"]), 70)
        (WORK / "branch-again.yaml").write_text(study % "branch/mechanism.yaml", encoding="utf-8")
        done = run("loads", WORK / "branch-again.yaml", "--out", WORK / "branch-loads", "-q")
        self.assertEqual(done.returncode, 0, done.stderr)
        drive = max(abs(float(row["drive.force"]))
                    for row in rows(WORK / "branch-loads" / "loads.csv"))
        self.assertAlmostEqual(drive, float(table["main.drive"]["after"]), delta=1e-9 * drive)

    def test_gain_is_what_a_looser_limit_gives(self):
        tables = [design(f"gain-{limit}", EXAMPLES / STUDY, "--minimise", "main.drive.rms",
                              "--vary", "crank/pin.x=40..60", "--vary", "coupler.mass=0.2..0.5",
                              "--keep", f"pin.life>={limit}") for limit in (11600, 11590)]
        drives = [float(table["main.drive.rms"]["after"]) for table in tables]
        gain = float(tables[0]["pin.life"]["gain"])
        self.assertAlmostEqual((drives[0] - drives[1]) / 10 / gain, 1, delta=0.02)

    def test_stays_where_the_mechanism_can_turn(self):
        # The rod is 150 mm long: a crank as long cannot turn.
        table = design("turning", EXAMPLES / STUDY, "--maximise", "main.drive.rms",
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
                (["--minimise", "mass", "--vary", "crank.mass=0.2..1e7"], 2,
                 "bounds that are not a million times as wide"),
                (["--minimise", "mass", "--vary", "crank.mass=0.2..1", "--vary",
                  "crank.mass=0.3..2"], 2, "'crank.mass' is to vary twice"),
                (["--minimise", "main.drive", "--vary", "crank/pin.z=-1..1"], 2,
                 "cannot stay closed")):
            done = run("optimise", EXAMPLES / STUDY, *words)
            self.assertEqual(done.returncode, code, done.stderr)
            self.assertIn(hint, done.stderr)


class Published(unittest.TestCase):
    """Optima that are known from elsewhere; each study says whose."""

    METHODS = ("slsqp", "mma", "ipopt")

    def test_force_balance_of_the_four_bar(self):
        # The mass of the coupler, m3 with its centre at r3 of a3, stands for two at its pins; each
        # is balanced on its own link: m2 r2 = -m3 (1 - r3/a3) a2, m4 r4 = -m3 r3/a3 a4.
        crank, rocker = -1 * (1 - 600 / 1200) * 500 / 0.5, -1 * 600 / 1200 * 750 / 0.75
        # Where next to nothing is left of the objective, nothing is left to gain.
        done = run("optimise", STUDIES / "balanced-four-bar-study.yaml", "--minimise",
                   "ground.force.rms", "--vary", "crank.center_of_gravity.x=-1000..500",
                   "--vary", "rocker.center_of_gravity.x=-1000..500")
        self.assertNotIn("ended short", done.stdout)
        for method in self.METHODS:
            table = design("force-balance", STUDIES / "balanced-four-bar-study.yaml",
                           "--minimise", "ground.force.rms", "--method", method,
                           "--vary", "crank.center_of_gravity.x=-1000..500",
                           "--vary", "rocker.center_of_gravity.x=-1000..500")
            force = table["ground.force.rms"]
            with self.subTest(method=method):
                self.assertLess(float(force["after"]), 1e-4 * float(force["before"]))
                for name, best in (("crank", crank), ("rocker", rocker)):
                    found = float(table[f"{name}.center_of_gravity.x"]["after"])
                    self.assertAlmostEqual(found, best, delta=0.05)

    def test_crank_rocker_of_best_transmission(self):
        # Brodell and Soni's coupler for a swing of 60 deg and a least angle of 45 deg.
        coupler = math.sqrt((1 - math.cos(math.radians(60))) / 2) / math.cos(math.radians(45))
        rocker = math.sqrt((1 - coupler ** 2) / (1 - coupler ** 2 / 2))
        table = design("transmission", STUDIES / "crank-rocker-study.yaml",
                       "--minimise", "transmission", "--vary", "coupler=0.6..1.2",
                       "--vary", f"rocker={rocker!r}..1.2")
        self.assertAlmostEqual(float(table["transmission"]["after"]), 45, delta=0.02)
        self.assertAlmostEqual(float(table["coupler"]["after"]), coupler, delta=1e-3)
        self.assertAlmostEqual(float(table["rocker"]["after"]), rocker, delta=1e-6)

    PATH = [STUDIES / "path-four-bar-study.yaml", "--minimise", "point.path.rms",
            "--vary", "ground=1..10", "--vary", "crank=0.5..5", "--vary", "coupler=1..10",
            "--vary", "rocker=1..10", "--vary", "along=-5..5", "--vary", "across=-5..5"]
    POINTS = (3 + 3j, 2.759 + 3.363j, 2.372 + 3.663j, 1.890 + 3.862j, 1.355 + 3.943j)

    def error_of(self, ground, crank, coupler, rocker, along, across):
        """The sum of squares [mm^2], from the law of cosines."""
        error = 0
        for i, wanted in enumerate(self.POINTS):
            pin = crank * cmath.exp(1j * math.radians(30 + 15 * i))
            diagonal = ground - pin
            cosine = ((coupler ** 2 + abs(diagonal) ** 2 - rocker ** 2)
                      / (2 * coupler * abs(diagonal)))
            turn = cmath.exp(1j * (cmath.phase(diagonal) + math.acos(cosine)))
            error += abs(pin + (along + 1j * across) * turn - wanted) ** 2
        return error

    def test_path_of_five_points_with_their_timing(self):
        table = design("path", *self.PATH)
        best = {name: float(row["after"]) for name, row in table.items()}
        error = 5 * (1e3 * best["point.path.rms"]) ** 2
        lengths = [best[name] for name in ("ground", "crank", "coupler", "rocker", "along",
                                           "across")]
        self.assertAlmostEqual(error, self.error_of(*lengths), delta=1e-9)
        # The least there is, by Levenberg and Marquardt's method from 300 starts: 7.416e-7 mm^2.
        self.assertAlmostEqual(error, 7.4158e-7, delta=1e-9)

    FIRST = {"ground": 5.0, "crank": 2.0, "coupler": 5.0, "rocker": 4.0, "along": 2.0,
             "across": 1.0}

    @staticmethod
    def deviation_of(ground, crank, coupler, rocker, **_):
        """How far the transmission angle is from a right angle at most [deg], as above."""
        worst = 0
        for i in range(5):
            diagonal = abs(ground - crank * cmath.exp(1j * math.radians(30 + 15 * i)))
            cosine = (coupler ** 2 + rocker ** 2 - diagonal ** 2) / (2 * coupler * rocker)
            worst = max(worst, abs(90 - math.degrees(math.acos(cosine))))
        return worst

    def test_slopes_of_path_and_transmission_are_those_of_the_closed_form(self):
        done = run("sensitivities", STUDIES / "path-four-bar-study.yaml", "--of",
                   "point.path.rms,transmission", "--by", ",".join(self.FIRST), "--out",
                   WORK / "path-slopes")
        self.assertEqual(done.returncode, 0, done.stderr)
        closed = {"point.path.rms": lambda v: 1e-3 * math.sqrt(self.error_of(**v) / 5),
                  "transmission": lambda v: self.deviation_of(**v)}
        for row in rows(WORK / "path-slopes" / "sensitivities.csv"):
            value, name, step = closed[row["figure"]], row["parameter"], 1e-3
            at = [value({**self.FIRST, name: self.FIRST[name] + k * step})
                  for k in (-2, -1, 1, 2)]
            with self.subTest(figure=row["figure"], parameter=name):
                self.assertAlmostEqual(float(row["value"]) / value(self.FIRST), 1, delta=1e-9)
                self.assertAlmostEqual(float(row["slope"]) / value(self.FIRST),
                                       (8 * (at[2] - at[1]) - (at[3] - at[0])) / (12 * step)
                                       / value(self.FIRST), delta=1e-7)

    def test_paths_that_do_not_fit_are_refused(self):
        text = (STUDIES / "path-four-bar-study.yaml").read_text(encoding="utf-8")
        text = text.replace("path-four-bar.yaml", str(STUDIES / "path-four-bar.yaml"))
        table = WORK / "wanted.csv"
        table.write_text("t,x,y,z\n0,3,3,0\n1,2,2,0\n2,1,1,0\n3,0,0,0\n5,0,1,0\n", encoding="utf-8")
        for passage, replacement, hint in (
                ("[[3, 3, 0], ", "[", "there are 4 points, but the motion has 5 poses"),
                ("  point: [", "  pont: [", "grasp 'pont' not found; did you mean 'point'"),
                ("[3, 3, 0]", "[3, 3]", "3 numbers"),
                (text[text.index("[[3, 3, 0]"):], f"{table}\n",
                 "t = 5 s, but pose 4 of the motion is at t = 4 s")):
            self.assertIn(passage, text)
            study = WORK / "wrong-path.yaml"
            study.write_text(text.replace(passage, replacement), encoding="utf-8")
            done = run("sensitivities", study)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn(hint, done.stderr)


class Resumed(unittest.TestCase):
    def interrupted(self, name, designs):
        """A search that was killed after so many designs, or a few more."""
        folder = WORK / name
        shutil.rmtree(folder, ignore_errors=True)
        words = ["optimise", *Published.PATH, "--out", folder]
        state = folder / "search.json"
        with subprocess.Popen([VMECH, *map(str, words)], stdout=subprocess.DEVNULL) as search:
            while search.poll() is None:
                if state.exists() and len(json.loads(state.read_bytes())["designs"]) >= designs:
                    search.kill()
                    break
                time.sleep(1e-3)
        self.assertTrue(state.exists(), "it ended before it was killed")
        return folder, words

    def test_goes_on_to_the_same_design(self):
        folder, words = self.interrupted("killed", 5)
        plain = run(*words)
        self.assertEqual(plain.returncode, 2, plain.stdout)
        self.assertIn("--resume goes on with it", plain.stderr)
        resumed = run(*words, "--resume")
        self.assertEqual(resumed.returncode, 0, resumed.stderr)
        self.assertIn("The search goes on after", resumed.stdout)
        self.assertFalse((folder / "search.json").exists())
        design("at-once", *Published.PATH)
        self.assertEqual((folder / "design.csv").read_bytes(),
                         (WORK / "at-once" / "design.csv").read_bytes())

    def test_of_another_question_is_refused(self):
        folder, words = self.interrupted("another", 2)
        state = folder / "search.json"
        other = run(*words, "--resume", "--method", "mma")
        self.assertEqual(other.returncode, 2, other.stdout)
        self.assertIn("is the state of another search", other.stderr)
        state.write_text(state.read_text(encoding="utf-8")[:-40], encoding="utf-8")
        damaged = run(*words, "--resume")
        self.assertEqual(damaged.returncode, 2, damaged.stdout)
        self.assertIn("is damaged", damaged.stderr)
        nowhere = run(*words[:-2], "--resume")
        self.assertEqual(nowhere.returncode, 1, nowhere.stdout)
        self.assertIn("--resume needs --out", nowhere.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
