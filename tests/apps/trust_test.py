"""trust_test.py VMECH EXAMPLES: files that have no simple answer get the right one, or are refused.

Small mechanisms with answers that are known by other means, named in each test.
"""

import csv
import json
import math
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

VMECH = sys.argv[1]

FLAT = """vmech: "1.0"
units: {{length: m, angle: deg}}
gravity: [0, -9.81, 0]
ground: frame
links:
  frame: {{anchors: {{A: {{origin: [0,0,0]}}, D: {{origin: [1,0,0]}}}}}}
  crank:
    {{mass: 1, center_of_gravity: [0.25,0,0],
     anchors: {{A: {{origin: [0,0,0]}}, B: {{origin: [0.5,0,0]}}}}}}
  coupler:
    {{mass: 1, center_of_gravity: [0.6,0,0],
     anchors: {{B: {{origin: [0,0,0]}}, C: {{origin: [1.2,0,0]}}}}}}
  rocker:
    {{mass: 1, center_of_gravity: [0.4,0,0],
     anchors: {{C: {{origin: [0.8,0,0]}}, D: {{origin: [0,0,0]}}}}}}
joints:
  A: {{type: revolute, connects: [frame/A, crank/A]{A}}}
  B: {{type: revolute, connects: [crank/B, coupler/B]}}
  C: {{type: revolute, connects: [coupler/C, rocker/C]}}
  D: {{type: revolute, connects: [frame/D, rocker/D]}}
grasps: {{h: {{link: coupler, origin: [0.6,0,0]}}}}
"""
# A four-bar with axes across the drawing plane; URDF prints them as roll, pitch, yaw, 9 digits.
URDF = """<robot name="fb"><link name="base"/>
{links}
<joint name="A" type="continuous"><parent link="base"/><child link="crank"/>
  <origin xyz="0 0 0" rpy="1.570796327 -0.698131701 0"/><axis xyz="0 0 1"/></joint>
<joint name="B" type="continuous"><parent link="crank"/><child link="coupler"/>
  <origin xyz="0.5 0 0" rpy="-1.570796327 0 -0.484877818"/><axis xyz="0 1 0"/></joint>
<joint name="D" type="continuous"><parent link="base"/><child link="rocker"/>
  <origin xyz="1 0 0" rpy="1.570796327 -0.802656039 0"/><axis xyz="0 0 1"/></joint>
</robot>""".format(links="".join(
    f'<link name="{name}"><inertial><origin xyz="{x} 0 0"/><mass value="1"/><inertia ixx="0.01" '
    'iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>'
    for name, x in (("crank", 0.25), ("coupler", 0.6), ("rocker", 0.4))))
LOOPS = """vmech_loops: "1.0"
units: {length: m, angle: deg}
links:
  coupler: {anchors: {C: {origin: [1.2, 0, 0], z: [0, 1, 0], x: [1, 0, 0]}}}
  rocker:  {anchors: {C: {origin: [0.8, 0, 0], z: [0, 0, -1], x: [1, 0, 0]}}}
loops:
  C: {type: revolute, connects: [coupler/C, rocker/C]}
"""
SCREW = """vmech: "1.0"
gravity: [0, 0, 0]
ground: g
links:
  g: {anchors: {s: {origin: [0, 0, 0], z: [0, 0, 1], x: [1, 0, 0]}}}
  spindle:
    mass: 1
    inertia: {xx: 0.001, yy: 0.001, zz: 0.001}
    anchors: {s: {origin: [0, 0, 0], z: [0, 0, 1], x: [1, 0, 0]}}
joints:
  thread:
    {type: screw, connects: [g/s, spindle/s], pitch: 0.006,
     friction: {coefficient: 0.15, radius: 0.012}}
"""
BLOCK = """vmech: "1.0"
gravity: [0, 0, -10]
ground: g
links:
  g: {{anchors: {{p: {{origin: [0,0,0], z: [0,0,1], x: {x}}}}}}}
  b:
    {{mass: 10, inertia: {{xx: 0.1, yy: 0.1, zz: 0.1}},
     anchors: {{p: {{origin: [0,0,0], z: [0,0,1], x: {x}}}}}}}
joints:
  p: {{type: planar, connects: [g/p, b/p], friction: {{coefficient: 0.3, radius: 0.05}}}}
"""
# A parallelogram that stands upright at the start: its cranks pass both dead centres.
PARALLELOGRAM = """vmech: "1.0"
gravity: [0, -9.81, 0]
ground: frame
links:
  frame: {anchors: {A: {origin: [0, 0, 0]}, D: {origin: [2, 0, 0]}}}
  crank:
    {mass: 2, center_of_gravity: [0, 0.5, 0], inertia: {xx: 0.17, yy: 0.17, zz: 0.17},
     anchors: {A: {origin: [0, 0, 0]}, B: {origin: [0, 1, 0]}}}
  coupler:
    {mass: 4, center_of_gravity: [1, 1, 0], inertia: {xx: 1.3, yy: 1.3, zz: 1.3},
     anchors: {B: {origin: [0, 1, 0]}, C: {origin: [2, 1, 0]}}}
  follower:
    {mass: 2, center_of_gravity: [2, 0.5, 0], inertia: {xx: 0.17, yy: 0.17, zz: 0.17},
     anchors: {C: {origin: [2, 1, 0]}, D: {origin: [2, 0, 0]}}}
joints:
  A: {type: revolute, connects: [frame/A, crank/A]}
  B: {type: revolute, connects: [crank/B, coupler/B]}
  C: {type: revolute, connects: [coupler/C, follower/C]}
  D: {type: revolute, connects: [frame/D, follower/D]}
"""


class Trust(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="vmech-"))
        self.addCleanup(shutil.rmtree, self.folder)

    def write(self, name, text):
        (self.folder / name).write_text(text, encoding="utf-8")
        return name

    def run_vmech(self, *arguments):
        return subprocess.run([VMECH, *map(str, arguments)], cwd=self.folder, capture_output=True,
                              text=True, stdin=subprocess.DEVNULL, timeout=120, check=False)

    def check(self, text):
        result = self.run_vmech("check", self.write("m.yaml", text), "--json")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        return json.loads(result.stdout)

    def loads(self, mechanism, study):
        """Rows of loads.csv, and summary.json, of a study of a mechanism."""
        self.write("m.yaml", mechanism)
        self.write("s.yaml", 'vmech_study: "1.0"\nmechanism: m.yaml\n' + study)
        result = self.run_vmech("loads", "s.yaml", "--out", "out")
        self.assertEqual(result.returncode, 0, result.stderr)
        with open(self.folder / "out" / "loads.csv", encoding="utf-8") as file:
            rows = [{key: float(value) for key, value in row.items()}
                    for row in csv.DictReader(file)]
        return rows, json.loads((self.folder / "out" / "summary.json").read_text())

    def import_four_bar(self):
        """The URDF as fb.yaml, or a skip where the package behind it is absent."""
        self.write("fb.urdf", URDF)
        self.write("loops.yaml", LOOPS)
        result = self.run_vmech("import", "fb.urdf", "--loops", "loops.yaml", "--out", "fb.yaml")
        if "vmech was built without" in result.stderr:
            self.skipTest(result.stderr)
        return result

    def test_four_bar_of_a_urdf_with_nine_digits_closes(self):
        result = self.import_four_bar()
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        self.assertIn("mobility    1\n", result.stdout)
        report = self.check((self.folder / "fb.yaml").read_text(encoding="utf-8"))
        self.assertGreater(report["rounding"], 1e-12)
        self.assertLess(report["rounding"], 1e-9)  # of which nothing is said
        self.assertFalse(any("rounding" in note for note in report["notes"]))

    def test_links_in_line_are_left_and_told(self):
        report = self.check(FLAT.format(A=""))
        self.assertEqual(report["mobility"], 1)
        self.assertRegex(report["notes"][0], "lead to no assembled pose")
        self.assertRegex(report["notes"][1], r"moved .*'A' from 0 deg to -?\d")

    def test_every_command_begins_at_the_same_pose(self):
        self.write("m.yaml", FLAT.format(A=""))
        note = self.check(FLAT.format(A=""))["notes"][1]
        self.write("s.yaml", 'vmech_study: "1.0"\nmechanism: m.yaml\nunits: {angle: deg}\n'
                   "motion: {joint: A, speed: 1, duration: 1, steps: 2}\n")
        self.assertIn(note, self.run_vmech("loads", "s.yaml", "--out", "o").stdout)
        self.assertIn(note, self.run_vmech("ik", "m.yaml", "--target", "0.7 0.3 0").stdout)
        self.assertIn(note, self.run_vmech("haptic", "m.yaml", "--free", "--seconds", "0.1").stdout)

    def test_tolerance_decides_what_is_rounding(self):
        self.assertEqual(self.import_four_bar().returncode, 0)
        refused = self.run_vmech("check", "fb.yaml", "--tolerance", "1e-12")
        self.assertEqual(refused.returncode, 3)
        self.assertIn("--tolerance", refused.stdout)
        self.assertEqual(self.run_vmech("check", "fb.yaml", "--tolerance", "0.5").returncode, 1)

    def test_jack_needs_the_torque_of_its_thread_and_holds_itself(self):
        load = ("external: [{link: spindle, at: [0,0,0], force: [0,0,-2000], moment: [0,0,0]}]\n")
        rows, summary = self.loads(
            SCREW, "motion: {joint: thread, speed: 1, duration: 1, steps: 4}\n" + load)
        lead, friction = math.atan(0.006 / (2 * math.pi * 0.012)), math.atan(0.15)
        self.assertAlmostEqual(rows[0]["drive.force"], 2000 * 0.012 * math.tan(lead + friction), 8)
        self.assertTrue(any("self-locking" in text for text in summary["warnings"]))
        rows, _ = self.loads(SCREW,
                             "motion: {joint: thread, speed: 0, duration: 1, steps: 4}\n" + load)
        for row in rows:
            self.assertAlmostEqual(row["drive.force"], 0, 9)

    def test_block_is_dragged_against_mu_n_however_its_anchor_lies(self):
        for x in ("[1, 0, 0]", "[0.7071067811865476, 0.7071067811865475, 0]", "[0.6, -0.8, 0]"):
            along = [float(value) for value in x.strip("[]").split(",")]
            rows, _ = self.loads(
                BLOCK.format(x=x),
                "motion: [{{joint: p, freedom: x, speed: {}, duration: 1, steps: 2}}, "
                "{{joint: p, freedom: y, speed: {}}}, "
                "{{joint: p, freedom: rz, speed: 0}}]\n".format(along[0], -along[1]))
            force = [value for key, value in rows[0].items() if key.endswith(".force")
                     and "drive" in key]
            self.assertAlmostEqual(math.hypot(force[0], force[1]), 30, 9)
            self.assertAlmostEqual(force[0] * along[0] - force[1] * along[1], 30, 9)

    def test_power_is_measured_by_the_largest_of_the_study(self):
        for steps in (37, 39, 41):  # near to the dead centres no power flows
            _, summary = self.loads(
                PARALLELOGRAM, f"motion: {{joint: A, rpm: 60, turns: 1, steps: {steps}}}\n")
            self.assertLess(summary["max_power_error"], 1e-12)

    def test_still_studies_show_rounding(self):
        _, summary = self.loads(PARALLELOGRAM,
                                "motion: {joint: A, speed: 0, duration: 1, steps: 3}\n")
        self.assertLess(summary["max_power_error"], 1e-9)

    def test_limits_are_watched_and_can_stop(self):
        limited = FLAT.format(A=", start: 60, limits: [50, 70]")
        motion = ("units: {angle: deg}\n"
                  "motion: {joint: A, speed: 10, duration: 2, steps: 20}\n")
        _, summary = self.loads(limited, motion)
        self.assertRegex(summary["warnings"][0],
                         r"leaves the limits 50 deg to 70 deg of joint 'A' at 10 of 21 poses, from "
                         r"pose 11 .* by 10 deg at most, at pose 20")
        self.write("s.yaml", 'vmech_study: "1.0"\nmechanism: m.yaml\nlimits: stop\n' + motion)
        result = self.run_vmech("loads", "s.yaml", "--out", "stopped")
        self.assertEqual(result.returncode, 3)
        self.assertIn("leaves the limits", result.stderr)
        self.assertFalse((self.folder / "stopped").exists())

    def test_haptic_refuses_a_start_outside_the_limits_and_check_tells_it(self):
        lever = """vmech: "1.0"
units: {length: mm, angle: deg}
gravity: [0, 0, -9.81]
ground: post
links:
  post: {anchors: {hinge: {z: [0, 1, 0], x: [1, 0, 0]}}}
  lever:
    mass: 1
    center_of_gravity: [100, 0, 0]
    inertia: {xx: 10, yy: 4000, zz: 4000}
    anchors: {hinge: {z: [0, 1, 0], x: [1, 0, 0]}}
joints:
  hinge: {type: revolute, connects: [post/hinge, lever/hinge], limits: [-140, -35]}
grasps:
  knob: {link: lever, origin: [200, 0, 0], kind: point}
"""
        words = "joint 'hinge' starts at 0 deg, outside its limits -140 deg to -35 deg"
        self.assertIn(words, self.check(lever)["notes"])
        result = self.run_vmech("haptic", "m.yaml", "--free", "--seconds", "0.1")
        self.assertEqual(result.returncode, 2)
        self.assertIn(words, result.stderr)

    def test_dead_centre_is_told_in_the_degrees_of_the_study(self):
        self.write("m.yaml", FLAT.format(A=", start: 60"))
        self.write("s.yaml", 'vmech_study: "1.0"\nmechanism: m.yaml\nunits: {angle: deg}\n'
                   "motion: {joint: D, speed: 100, duration: 3, steps: 100}\n")
        result = self.run_vmech("loads", "s.yaml")
        self.assertEqual(result.returncode, 3)
        self.assertRegex(result.stderr, r"with 'D' at -?[\d.]+ deg")
        self.assertIn("Drive another joint", result.stderr)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
