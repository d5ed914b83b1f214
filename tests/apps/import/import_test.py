"""import_test.py VMECH SAMPLES: `vmech import` as its users meet it."""

import csv
import json
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest

VMECH = ""
SAMPLES = pathlib.Path()
STEEL = 7850  # kg/m^3


def vmech(*arguments, folder=None):
    return subprocess.run([VMECH, *map(str, arguments)], cwd=folder, capture_output=True,
                          text=True, stdin=subprocess.DEVNULL, timeout=120)


def stl_volume(path):
    """Sum of a.(b x c) / 6 over the triangles of a binary STL file."""
    data = path.read_bytes()
    count = struct.unpack_from("<I", data, 80)[0]
    assert len(data) == 84 + 50 * count
    volume = 0
    for i in range(count):
        ax, ay, az, bx, by, bz, cx, cy, cz = struct.unpack_from("<9f", data, 84 + 50 * i + 12)
        volume += (ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz)
                   + az * (bx * cy - by * cx)) / 6
    return volume


class Import(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_import(self, *arguments):
        return vmech("import", *arguments, folder=self.folder)

    def written(self):
        return sorted(str(p.relative_to(self.folder)) for p in self.folder.rglob("*")
                      if p.is_file())

    def test_every_sample_becomes_a_mechanism_that_closes(self):
        for sample in sorted(SAMPLES.glob("*.step")):
            run = self.run_import(sample)
            self.assertEqual(run.returncode, 0, run.stderr)
            check = vmech("check", self.folder / (sample.stem + ".yaml"), "--json")
            self.assertEqual(check.returncode, 0, check.stderr)

    def test_study_of_the_import_runs_and_takes_bearings_that_fit_the_shafts(self):
        run = self.run_import(SAMPLES / "slider-crank.step", "--out", "a/crank.yaml", "--study",
                              "b/study.yaml", "--rpm", 1500, "--gravity", "0 -9.81 0")
        self.assertEqual(run.returncode, 0, run.stderr)
        loads = vmech("loads", "b/study.yaml", "--out", "loads", folder=self.folder)
        self.assertEqual(loads.returncode, 0, loads.stderr)
        with open(self.folder / "loads/bearings.csv", newline="", encoding="utf-8") as file:
            bores = {row["joint"]: float(row["bore"]) for row in csv.DictReader(file)}
        self.assertEqual(bores, {"main": 0.020, "pin": 0.017, "wrist": 0.012})

    def test_pins_with_play_get_the_bearings_of_their_nominal_diameter(self):
        run = self.run_import(SAMPLES / "pump.step", "--study", "study.yaml", "--gravity",
                              "0 -9.81 0", "--rpm", 600)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("mobility    1", run.stdout)
        self.assertIn("shaft 9.98 mm in a bore of 10 mm, nominal 10 mm", run.stdout)
        self.assertIn("wrist-pin belongs to rod, fastener: shaft of 9.98 mm in a bore of 10 mm "
                      "(--moving wrist-pin)", run.stdout)
        loads = vmech("loads", "study.yaml", "--out", "loads", folder=self.folder)
        self.assertEqual(loads.returncode, 0, loads.stderr)
        with open(self.folder / "loads/bearings.csv", newline="", encoding="utf-8") as file:
            bores = {row["joint"]: float(row["bore"]) for row in csv.DictReader(file)}
        self.assertEqual(bores, {"housing-crank": 0.020, "crank-rod": 0.012, "rod-piston": 0.010})

    def test_a_door_is_made_of_the_bodies_that_are_asked_for(self):
        door = SAMPLES / "door.step"
        run = self.run_import(door)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("6 bodies", run.stdout)
        self.assertIn("mobility    1", run.stdout)
        run = self.run_import(door, "--weld", "frame,leaf-of-frame,leaf-of-frame-2", "--weld",
                              "door,leaf-of-door,leaf-of-door-2")
        self.assertIn("2 bodies", run.stdout)
        self.assertIn("leaf-of-door-2 belongs to door, asked for (--weld)", run.stdout)
        run = self.run_import(door, "--moving", "screw-3")
        self.assertIn("7 bodies", run.stdout)

    def test_tolerance_is_in_millimetres_and_a_gap_of_it_is_contact(self):
        for tolerance, kind in ((0.01, "cylindrical"), (0.05, "revolute")):  # the web is 0.05 off
            run = self.run_import(SAMPLES / "pump.step", "--tolerance", tolerance)
            self.assertEqual(run.returncode, 0, run.stderr)
            self.assertIn(f"housing-crank: {kind}", run.stdout)

    def test_a_density_in_grams_per_cubic_centimetre_is_doubted(self):
        crank = SAMPLES / "slider-crank.step"
        text = self.run_import(crank, "--density", "7.85").stdout
        self.assertRegex(text, r"warning +part '.*': its density is 7.85 kg/m\^3")
        self.assertNotIn("warning", self.run_import(crank, "--density", STEEL).stdout)
        self.assert_refused("its density is 7.85 kg/m^3", crank, "--density", "7.85", "--strict")

    def test_meshes_enclose_what_the_links_weigh(self):
        run = self.run_import(SAMPLES / "four-bar.step", "--meshes", "meshes", "--density", STEEL)
        self.assertEqual(run.returncode, 0, run.stderr)
        text = vmech("check", "four-bar.yaml", "--json", folder=self.folder).stdout
        masses = {link["name"]: link["mass"] for link in json.loads(text)["links"]}
        self.assertEqual(sorted(masses), ["coupler", "crank", "frame", "rocker"])
        for name, mass in masses.items():
            volume = stl_volume(self.folder / "meshes" / (name + ".stl"))
            self.assertAlmostEqual(volume * STEEL / mass, 1, delta=0.01)

    def test_report_names_sources_and_guesses(self):
        out = self.run_import(SAMPLES / "arm.step", "--density", "hand=abs").stdout
        self.assertIn("at 1050 kg/m^3, given for hand", out)
        self.assertIn("at 1800 kg/m^3, in the file, servo (mean)", out)
        self.assertIn("gravity is 9.81 m/s^2 against z (--gravity)", out)
        self.assertIn("joint 'elbow' is revolute", out)
        self.assertIn("Guessed: gravity", (self.folder / "arm.yaml").read_text())

    def assert_refused(self, message, *arguments, code=2):
        before = self.written()
        run = self.run_import(*arguments, "--out", "out/a.yaml", "--study", "out/b.yaml",
                              "--meshes", "out/c")
        self.assertEqual(run.returncode, code, run.stdout + run.stderr)
        self.assertIn(message, run.stderr)
        self.assertEqual(self.written(), before)
        self.assertFalse((self.folder / "out").exists())

    def test_leaves_nothing_behind_when_it_refuses(self):
        sample = SAMPLES / "four-bar.step"
        half = self.folder / "half.step"
        half.write_text(sample.read_text()[:60000])
        drawing = self.folder / "drawing.dwg"
        shutil.copy(sample, drawing)
        self.assert_refused("half.step: is cut off", half)
        self.assert_refused("a drawing: save STEP from the program that made it", drawing)
        self.assert_refused("neither a density in kg/m^3 nor one of the materials: steel",
                            sample, "--density", "steal")
        self.assert_refused("is not in 1e-3..1e5", sample, "--density", "crank=-1")
        self.assert_refused("no joint 'man' to drive (--drive); did you mean 'main'?",
                            sample, "--drive", "man")
        self.assert_refused("there is no body 'frme' to be the ground; did you mean 'frame'?",
                            sample, "--ground", "frme")
        self.assert_refused("'hinge' is none of revolute", sample, "--joint", "main=hinge")
        self.assert_refused("tolerance [mm] = 100 is not in 0.0001..10", sample, "--tolerance", 100)
        self.assert_refused("--weld 'crank' does not name two bodies", sample, "--weld", "crank")
        self.assert_refused("--gravity '0 down' is not three numbers", sample, "--gravity",
                            "0 down")
        robot = self.folder / "robot.urdf"
        robot.write_text("<robot name='r'><link name='a'/></robot>")
        self.assert_refused("--study and --meshes are for STEP files", robot)
        self.assert_refused("--sped", sample, "--sped", 3, code=1)

    def test_explains_itself(self):
        self.assertIn("anchor_<joint>", self.run_import("--help").stdout)
        self.assertIn("import", vmech("--help").stdout)


if __name__ == "__main__":
    VMECH, SAMPLES = sys.argv[1], pathlib.Path(sys.argv[2])
    unittest.main(argv=sys.argv[:1])
