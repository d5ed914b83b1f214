"""`vmech simulate` as a user has it. Usage: simulate_test.py VMECH FOLDER"""

import csv
import json
import math
import pathlib
import shutil
import signal
import subprocess
import sys
import time
import unittest

EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "mechanisms" / "examples"
SWINGING = EXAMPLES.parents[1] / "studies" / "examples" / "four-bar-swinging.yaml"
GRAVITY = 9.81

PENDULUM = """
vmech: "1.0"
name: pendulum
units: {length: m, angle: rad}
gravity: [0, -9.81, 0]
ground: frame
links:
  frame: {anchors: {a: {origin: [0, 0, 0], z: [0, 0, 1], x: [1, 0, 0]}}}
  rod:
    mass: 2
    center_of_gravity: [0.5, 0, 0]
    inertia: {xx: 0.001, yy: 0.166, zz: 0.166}
    anchors: {a: {origin: [0, 0, 0], z: [0, 0, 1], x: [1, 0, 0]}}
joints:
  pivot: {type: revolute, connects: [frame/a, rod/a], start: START}
"""


def wait_until_caught(pid, number):
    """Until a process catches a signal."""
    while True:
        status = pathlib.Path(f"/proc/{pid}/status").read_text(encoding="utf-8")
        caught = next(line for line in status.splitlines() if line.startswith("SigCgt"))
        if int(caught.split()[1], 16) >> (number - 1) & 1:
            return
        time.sleep(0.02)


BEARINGS = """
bearings: {main: {positions: [-10, 10], shaft: [8, 20], life_hours: 100}}
"""


def numbers(path):
    with path.open(newline="", encoding="utf-8") as file:
        return [[float(value) for value in row] for row in list(csv.reader(file))[1:]]


def rounded(text):
    """A table with nine digits of its numbers."""
    def cell(value):
        try:
            return f"{float(value):.9g}"
        except ValueError:
            return value
    return [[cell(value) for value in row] for row in csv.reader(text.splitlines())]


def with_row(table, pose, cells):
    """A table whose row of a pose has these cells behind its time."""
    lines = table.splitlines(keepends=True)
    lines[pose + 1] = lines[pose + 1].split(",")[0] + f",{cells}\n"
    return "".join(lines)


class Simulate(unittest.TestCase):
    def setUp(self):
        shutil.rmtree(FOLDER, ignore_errors=True)
        FOLDER.mkdir(parents=True)

    def study(self, simulation, start=-1.5707963267948966, extra=""):
        (FOLDER / "pendulum.yaml").write_text(PENDULUM.replace("START", str(start)))
        path = FOLDER / "study.yaml"
        path.write_text('vmech_study: "1.0"\nmechanism: pendulum.yaml\n'
                        f"units: {{length: m, angle: rad}}\nsimulation: {simulation}\n{extra}")
        return path

    def vmech(self, *arguments):
        return subprocess.run([VMECH, *map(str, arguments)], cwd=FOLDER, capture_output=True,
                              text=True, check=False)

    def rows(self, name):
        with (FOLDER / "out" / name).open(newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def test_a_pendulum_swings_with_its_small_period_and_keeps_its_energy(self):
        amplitude = 1e-3
        study = self.study("{duration: 4, steps: 400}", start=-math.pi / 2 + amplitude)
        run = self.vmech("simulate", study, "--out", "out")
        self.assertEqual(run.returncode, 0, run.stderr)
        inertia = 0.166 + 2 * 0.5 ** 2
        rate = math.sqrt(2 * GRAVITY * 0.5 / inertia)
        for row in self.rows("joints.csv"):
            expected = -math.pi / 2 + amplitude * math.cos(rate * float(row["t"]))
            self.assertAlmostEqual(float(row["pivot.position"]), expected, delta=1e-8)
        for row in self.rows("energies.csv"):
            self.assertLess(abs(float(row["error"])), 1e-9)
        # The hinge carries weight and centripetal force: first link on second, axes of the frame.
        first = self.rows("loads.csv")[0]
        self.assertAlmostEqual(float(first["pivot.fy"]), 2 * GRAVITY, delta=1e-4)
        summary = json.loads((FOLDER / "out" / "summary.json").read_text(encoding="utf-8"))
        self.assertEqual(summary["simulation"]["status"], "finished")

    def test_the_example_runs_and_its_report_has_the_energies(self):
        run = self.vmech("simulate", SWINGING,
                         "--out", "out")
        self.assertEqual(run.returncode, 0, run.stderr)
        energies = self.rows("energies.csv")
        total = float(energies[0]["total"])
        for row in energies:
            self.assertAlmostEqual(float(row["total"]), total, delta=1e-6)
        report = (FOLDER / "out" / "report.html").read_text(encoding="utf-8")
        self.assertIn("The simulation", report)

    def run_motion(self, *arguments):
        return self.vmech("loads", *arguments, "--out", "loads")

    def test_the_loads_of_a_simulated_motion_are_those_of_the_simulation(self):
        study = FOLDER / "study.yaml"
        study.write_text(SWINGING.read_text(encoding="utf-8").replace(
            "mechanism: ../../mechanisms/examples/", f"mechanism: {EXAMPLES}/") + BEARINGS)
        run = self.vmech("simulate", study, "--out", "out")
        self.assertEqual(run.returncode, 0, run.stderr)
        run = self.run_motion(study, "--motion", "out")
        self.assertEqual(run.returncode, 0, run.stderr)
        for name in ("loads.csv", "motion.csv", "joints.csv"):
            first, second = (numbers(FOLDER / folder / name) for folder in ("out", "loads"))
            self.assertEqual(len(first), len(second))
            size = max(abs(value) for row in first for value in row)
            for expected, row in zip(first, second):
                for a, b in zip(expected, row):
                    self.assertAlmostEqual(a, b, delta=1e-12 * size)
        for name in ("certainty.csv", "bearings.csv"):
            first, second = ((FOLDER / folder / name).read_text(encoding="utf-8")
                             for folder in ("out", "loads"))
            self.assertEqual(rounded(first), rounded(second))

    def test_a_motion_that_does_not_fit_is_told_by_name(self):
        study = self.study("{duration: 1, steps: 20}", start=-1)
        self.assertEqual(self.vmech("simulate", study, "--out", "out").returncode, 0)
        joints, summary = FOLDER / "out" / "joints.csv", FOLDER / "out" / "summary.json"
        kept = joints.read_text(encoding="utf-8"), summary.read_text(encoding="utf-8")
        pushed = "external: [{link: rod, at: [1, 0, 0], force: [1, 0, 0]}]\n"
        for change, words in (
                (lambda: joints.unlink(), "out: has no joints.csv"),
                (lambda: joints.write_text(kept[0].replace("pivot.rate", "pivot.speed")),
                 "the column 'pivot.rate' is missing"),
                (lambda: joints.write_text(kept[0].rsplit("\n", 2)[0] + "\n"),
                 "has 20 rows, but summary.json beside it tells of 21 poses"),
                (lambda: joints.write_text(kept[0][:-3]), "ends within a row"),
                (lambda: joints.write_text(with_row(kept[0], 9, "nan,nan,nan")),
                 "pivot.position: expected a finite number, not 'nan'"),
                (lambda: joints.write_text(kept[0].replace("\n0.3,", "\n0.25,")),
                 "t must increase from row to row, but 0.25 follows 0.25"),
                (lambda: summary.write_text(kept[1].replace("mechanism_sha256", "old")),
                 "does not say of which mechanism file it is"),
                (lambda: self.study("{duration: 1}", start=-1.1),
                 "out: is a motion of another mechanism: 'pendulum'"),
                (lambda: self.study("{duration: 1}", start=-1, extra=pushed),
                 "study.yaml: what the study names does not give this motion: at t ="),
        ):
            change()
            run = self.run_motion(study, "--motion", "out")
            self.assertEqual(run.returncode, 2, words + run.stdout)
            self.assertIn(words, run.stderr)
            self.assertFalse((FOLDER / "loads").exists())
            joints.write_text(kept[0])
            summary.write_text(kept[1])
        self.study("{duration: 1}", start=-1)
        summary.write_text(kept[1].replace('"finished"', '"interrupted"'))
        run = self.run_motion(study, "--motion", "out")
        self.assertEqual(run.returncode, 3, run.stderr)
        self.assertIn("out: a partial motion, of a simulation that is interrupted", run.stderr)
        self.assertTrue((FOLDER / "loads" / "loads.csv").exists())

    def test_poses_without_numbers_are_passed_over_where_the_loops_were_singular(self):
        study = self.study("{duration: 1, steps: 20}", start=-1)
        self.assertEqual(self.vmech("simulate", study, "--out", "out").returncode, 0)
        joints, summary = FOLDER / "out" / "joints.csv", FOLDER / "out" / "summary.json"
        kept = self.rows("loads.csv")
        joints.write_text(with_row(joints.read_text(encoding="utf-8"), 9, "nan,nan,nan"))
        told = json.loads(summary.read_text(encoding="utf-8"))
        told["singular_poses"] = [8]
        summary.write_text(json.dumps(told))
        # Of another row.
        run = self.run_motion(study, "--motion", "out")
        self.assertEqual(run.returncode, 2, run.stdout)
        self.assertIn("expected a finite number, not 'nan'", run.stderr)
        told["singular_poses"] = [9]
        summary.write_text(json.dumps(told))
        run = self.run_motion(study, "--motion", "out")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("but for 1 pose at which the loops are singular", run.stdout)
        with (FOLDER / "loads" / "loads.csv").open(newline="", encoding="utf-8") as file:
            loads = list(csv.DictReader(file))
        self.assertEqual(len(loads), 20)
        for row, expected in zip(loads, kept[:9] + kept[10:]):
            for name, value in expected.items():
                self.assertAlmostEqual(float(row[name]), float(value), delta=1e-9)

    def test_a_motor_of_a_load_study_moves_as_a_result_does(self):
        study = self.study("{duration: 1, steps: 20, motors: [{joint: pivot, force: 3}]}", start=-1)
        self.assertEqual(self.vmech("simulate", study, "--out", "out").returncode, 0)
        study.write_text('vmech_study: "1.0"\nmechanism: pendulum.yaml\n'
                         "motion: {joint: pivot, rpm: 1, turns: 1, steps: 4}\n")
        run = self.run_motion(study, "--motion", "out")
        self.assertEqual(run.returncode, 0, run.stderr)
        with (FOLDER / "loads" / "loads.csv").open(newline="", encoding="utf-8") as file:
            forces = [float(row["drive.force"]) for row in csv.DictReader(file)]
        self.assertEqual(len(forces), 21)
        for force in forces:
            self.assertAlmostEqual(force, 3, delta=1e-12)

    def modes_of(self, start, text=PENDULUM, arguments=()):
        path = FOLDER / "pendulum.yaml"
        path.write_text(text.replace("START", str(start)))
        return self.vmech("modes", path, *arguments)

    def test_modes_of_a_pendulum_are_those_of_its_closed_form(self):
        run = self.modes_of(-1, arguments=("--out", "modes"))
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("pivot", run.stdout)
        self.assertIn("\nstable: ", run.stdout)
        with (FOLDER / "modes" / "modes.csv").open(newline="", encoding="utf-8") as file:
            (mode,) = csv.DictReader(file)
        inertia = 0.166 + 2 * 0.5 ** 2
        frequency = math.sqrt(2 * GRAVITY * 0.5 / inertia) / (2 * math.pi)
        self.assertAlmostEqual(float(mode["frequency"]), frequency, delta=1e-9)
        self.assertAlmostEqual(float(mode["damping_ratio"]), 0, delta=1e-12)
        self.assertEqual(float(mode["pivot.real"]), 1)
        # The study of the mode swings a tenth of a radian about the equilibrium, in its period.
        study = FOLDER / "modes" / "mode-1.yaml"
        run = self.vmech("loads", study, "--out", "loads")
        self.assertEqual(run.returncode, 0, run.stderr)
        joints = numbers(FOLDER / "loads" / "joints.csv")
        self.assertAlmostEqual(joints[0][1], -math.pi / 2 + 0.1, delta=1e-12)
        self.assertAlmostEqual(joints[len(joints) // 2][1], -math.pi / 2 - 0.1, delta=1e-12)
        self.assertAlmostEqual(len(joints) * joints[1][0], 1 / frequency, delta=1e-9)

    def test_modes_print_rounding_as_zero(self):
        run = self.modes_of(1, PENDULUM.replace("[0, -9.81, 0]", "[9.81, 0, 0]"))
        self.assertRegex(run.stdout, r"\n  pivot +0 rad\n", run.stderr)

    def test_modes_say_what_is_unstable_and_what_cannot_be_told(self):
        run = self.modes_of(math.pi / 2)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("\nunstable: ", run.stdout)
        self.assertIn("runs away, and doubles in", run.stdout)
        floats = PENDULUM.replace("-9.81", "0")
        run = self.modes_of(0.3, floats)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("\nneutral, as far as can be told: ", run.stdout)
        damped = PENDULUM.replace("start: START", "start: START, viscous: 0.5, limits: [-1, 1]")
        run = self.modes_of(0.3, damped)
        rate, stiffness = 0.5 / (2 * 0.666), 2 * GRAVITY * 0.5 / 0.666
        self.assertIn(f"halves in {math.log(2) / rate:.4g}"[:14], run.stdout)
        self.assertIn(f"{rate / math.sqrt(stiffness):.4f}"[:6], run.stdout)
        self.assertIn("'pivot' is at -1.57", run.stdout.replace("\u2212", "-"))
        self.assertIn("outside its limits", run.stdout)
        empty = PENDULUM.split("    mass: 2")[0] + PENDULUM.split("zz: 0.166}\n")[1]
        run = self.modes_of(0.3, empty)
        self.assertIn("\nneutral, as far as can be told: ", run.stdout + run.stderr)
        falls = PENDULUM.replace("type: revolute", "type: prismatic").replace(
            "z: [0, 0, 1], x: [1, 0, 0]", "z: [0, 1, 0], x: [1, 0, 0]")
        run = self.modes_of(0, falls)
        self.assertEqual(run.returncode, 3, run.stdout)
        self.assertIn("pendulum.yaml: no equilibrium was found", run.stderr)
        run = self.vmech("modes", EXAMPLES / "four-bar-study.yaml")
        self.assertEqual(run.returncode, 2)
        self.assertIn("has no block `simulation`", run.stderr)

    def test_what_is_wrong_is_said_and_nothing_is_written(self):
        for simulation, words in (
                ("{steps: 3}", "the key 'duration' is missing"),
                ("{duration: 1, motors: [{joint: pivot}]}", "a motor has one of 'force'"),
                ("{duration: 1, rates: [{joint: pivo, speed: 1}]}", "did you mean 'pivot'"),
                ("{duration: 1, motors: [{joint: pivot, hold: 1, speed: 2, stiffness: 3}]}",
                 "a motor has one of 'force'"),
                ("{duration: 1, motors: [{joint: pivot, force: 1, period: 2}]}",
                 "used with a table only"),
                ("{duration: 1, method: 3}", "expected text"),
                ("{duration: 1, tolerance: 0}", "must be in [1e-14, 0.01]"),
                ("{duration: 1, rates: [{joint: 3, speed: 1}]}", "expected text"),
                ("{duration: 1}\nlimits: stop", "in a simulation joints stop at their limits"),
                ("{duration: 1, restitution: [{joint: pivot, restitution: 2}]}", "at most 1")):
            run = self.vmech("simulate", self.study(simulation), "--out", "out")
            self.assertEqual(run.returncode, 2, run.stdout)
            self.assertIn(words, run.stderr)
            self.assertEqual(run.stderr.count("study.yaml:"), 1, run.stderr)
            self.assertFalse((FOLDER / "out").exists())
        self.assertIn("`vmech simulate` does that",
                      self.vmech("loads", self.study("{duration: 1}")).stderr)
        self.assertIn("`vmech loads` runs its motion",
                      self.vmech("simulate", EXAMPLES / "four-bar-study.yaml").stderr)

    def test_a_body_on_a_ball_at_its_centre_keeps_its_angular_momentum(self):
        moments = [0.02, 0.03, 0.045]
        (FOLDER / "top.yaml").write_text(f"""
vmech: "1.0"
gravity: [0, 0, -9.81]
ground: frame
links:
  frame: {{anchors: {{a: {{}}}}}}
  body:
    mass: 1
    inertia: {{xx: {moments[0]}, yy: {moments[1]}, zz: {moments[2]}}}
    anchors: {{a: {{}}}}
joints: {{ball: {{type: spherical, connects: [frame/a, body/a], start: [0.3, -0.2, 0.1]}}}}
""")
        study = FOLDER / "study.yaml"
        rates = "".join(f"{{joint: ball, freedom: r{k}, speed: {v}}}, "
                        for k, v in zip("xyz", (0.1, 6, 0.2)))
        study.write_text('vmech_study: "1.0"\nmechanism: top.yaml\n'
                         f"simulation: {{duration: 6, steps: 60, rates: [{rates}]}}\n")
        run = self.vmech("simulate", study, "--out", "out")
        self.assertEqual(run.returncode, 0, run.stderr)

        def momentum(row):
            w, x, y, z = (float(row[f"body.q{k}"]) for k in "wxyz")
            turn = [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                    [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                    [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]
            rate = [float(row[f"body.w{k}"]) for k in "xyz"]
            along = [moments[k] * sum(turn[i][k] * rate[i] for i in range(3)) for k in range(3)]
            return [sum(turn[i][k] * along[k] for k in range(3)) for i in range(3)]

        rows = self.rows("motion.csv")
        size = math.hypot(*momentum(rows[0]))
        self.assertAlmostEqual(size, math.hypot(0.02 * 0.1, 0.03 * 6, 0.045 * 0.2), delta=1e-12)
        for row in rows:
            self.assertLess(math.dist(momentum(row), momentum(rows[0])), 1e-7 * size)
        turns = [float(row["ball.ry.rate"]) for row in self.rows("joints.csv")]
        self.assertLess(min(turns), -5)  # about the middle axis it turns over

    def test_what_cannot_move_stands_still_and_carries_its_weight(self):
        triangle = PENDULUM.replace("START", "0").replace(
            "x: [1, 0, 0]}}}\n  rod", "x: [1, 0, 0]}, b: {origin: [0.6, 0, 0]}}}\n  rod").replace(
            "x: [1, 0, 0]}}\njoints", "x: [1, 0, 0]}, t: {origin: [0.3, 0.4, 0]}}\n"
            "  strut: {anchors: {a: {}, t: {origin: [-0.3, 0.4, 0]}}}\njoints")
        locked = "{duration: 1, steps: 4}"
        turned = self.study(locked[:-1] + ", rates: [{joint: pivot, speed: 3}]}", start=0)
        (FOLDER / "pendulum.yaml").write_text(
            triangle + "  foot: {type: revolute, connects: [frame/b, strut/a]}\n"
            "  top: {type: revolute, connects: [rod/t, strut/t]}\n")
        run = self.vmech("simulate", turned, "--out", "out")
        self.assertEqual(run.returncode, 2, run.stderr)
        self.assertIn("'pivot' is given 3 rad/s and has 0 rad/s", run.stderr)
        text = turned.read_text().replace(", rates: [{joint: pivot, speed: 3}]", "")
        turned.write_text(text)
        run = self.vmech("simulate", turned, "--out", "out")
        self.assertEqual(run.returncode, 0, run.stderr)
        last = self.rows("loads.csv")[4]
        self.assertAlmostEqual(float(last["pivot.fy"]) + float(last["foot.fy"]), 2 * GRAVITY,
                               places=9)

    def test_what_a_table_does_not_say_is_not_made_up(self):
        (FOLDER / "angle.csv").write_text("t,value\n0,0\n1,1\n2,1.5\n")
        (FOLDER / "late.csv").write_text("t,value\n0.5,0\n1,1\n9,1.5\n")
        (FOLDER / "load.csv").write_text("t,fx\n0,1\n1,2\n")
        (FOLDER / "turn.csv").write_text("pivot,fx\n0,1\n1,2\n")
        external = "external: [{{link: rod, table: {}}}]\n"
        slow = "{duration: 4, drives: [{joint: pivot, speed: 0.5}]}"
        for simulation, extra, words in (
                ("{duration: 4, drives: [{joint: pivot, table: angle.csv}]}", "",
                 "drives[0].law is a table from 0 to 2 s, but the times go from 0 to 4 s"),
                ("{duration: 4, drives: [{joint: pivot, table: late.csv}]}", "",
                 "drives[0].law is a table from 0.5 to 9 s"),
                ("{duration: 4}", external.format("load.csv"),
                 "external[0]: its table covers 0 to 1, but"),
                (slow, external.format("turn.csv"), "external[0]: its table covers 0 to 1, but"),
                ("{duration: 1, motors: [{joint: pivot, table: angle.csv, period: 1}]}", "",
                 "period: the table takes longer, 2 s"),
                ("{duration: 1, motors: [{joint: pivot, table: angle.csv, period: 2}]}", "",
                 "period: the last row of the table is one period after the first")):
            run = self.vmech("simulate", self.study(simulation, 0, extra), "--out", "out")
            self.assertEqual(run.returncode, 2, simulation + run.stdout)
            self.assertIn(words, run.stderr)
            self.assertFalse((FOLDER / "out").exists())
        whole = self.study("{duration: 2, steps: 2, drives: [{joint: pivot, table: angle.csv}]}", 0)
        self.assertEqual(self.vmech("simulate", whole, "--out", "out").returncode, 0)
        self.assertAlmostEqual(float(self.rows("joints.csv")[2]["pivot.position"]), 1.5, places=12)

    def test_an_interruption_leaves_the_whole_of_what_was_computed(self):
        study = self.study("{duration: 100000, steps: 50000}")
        with subprocess.Popen([VMECH, "simulate", str(study), "--out", "out"], cwd=FOLDER,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as run:
            wait_until_caught(run.pid, signal.SIGINT)
            time.sleep(0.3)
            run.send_signal(signal.SIGINT)
            _, errors = run.communicate(timeout=60)
        self.assertEqual(run.returncode, 3, errors)
        self.assertIn("interrupted", errors)
        summary = json.loads((FOLDER / "out" / "summary.json").read_text(encoding="utf-8"))
        self.assertEqual(summary["simulation"]["status"], "interrupted")
        self.assertEqual(summary["poses"], len(self.rows("energies.csv")))
        self.assertLess(summary["simulation"]["end"], 100000)


if __name__ == "__main__":
    VMECH = str(pathlib.Path(sys.argv.pop(1)).resolve())
    FOLDER = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main(verbosity=2)
