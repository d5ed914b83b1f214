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

    def test_what_is_wrong_is_said_and_nothing_is_written(self):
        for simulation, words in (
                ("{steps: 3}", "the key 'duration' is missing"),
                ("{duration: 1, motors: [{joint: pivot}]}", "a motor has one of 'force'"),
                ("{duration: 1, rates: [{joint: pivo, speed: 1}]}", "did you mean 'pivot'"),
                ("{duration: 1, restitution: [{joint: pivot, restitution: 2}]}", "at most 1")):
            run = self.vmech("simulate", self.study(simulation), "--out", "out")
            self.assertEqual(run.returncode, 2, run.stdout)
            self.assertIn(words, run.stderr)
            self.assertFalse((FOLDER / "out").exists())
        self.assertIn("`vmech simulate` does that",
                      self.vmech("loads", self.study("{duration: 1}")).stderr)
        self.assertIn("`vmech loads` runs its motion",
                      self.vmech("simulate", EXAMPLES / "four-bar-study.yaml").stderr)

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
