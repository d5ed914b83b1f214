"""exchange_test.py VMECH EXAMPLES: vmech import and vmech export as their users run them."""

import json
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

VMECH, EXAMPLES = sys.argv[1], pathlib.Path(sys.argv[2])
MECHANISMS = ("andrews-squeezer", "beam-on-three-supports", "bennett", "delta-robot", "four-bar",
              "flyball-governor", "modelica-engine1a", "puma-560", "rssr", "rsup", "slider-crank",
              "stewart-gough")
URDF = """<robot name="bars">
  <link name="base"/>
  {links}
  <joint name="a" type="continuous"><parent link="base"/><child link="left"/>
    <axis xyz="0 0 1"/></joint>
  <joint name="b" type="continuous"><parent link="left"/><child link="top"/>
    <origin xyz="0 1 0"/><axis xyz="0 0 1"/></joint>
  <joint name="d" type="continuous"><parent link="base"/><child link="right"/>
    <origin xyz="2 0 0"/><axis xyz="0 0 1"/></joint>
</robot>""".format(links="".join(
    f'<link name="{name}"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" '
    'iyz="0" izz="1"/></inertial></link>' for name in ("left", "top", "right")))
LEVER = """<robot name="lever">
 <link name="stand"><inertial><mass value="0"/>
  <inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>
 <link name="bar"><inertial><origin xyz="0.5 0 0"/><mass value="2"/>
  <inertia ixx="0.001" iyy="0.002" izz="0.0035" ixy="0" ixz="0" iyz="0"/></inertial></link>
 <joint name="pivot" type="continuous"><parent link="stand"/><child link="bar"/>
  <axis xyz="0 1 0"/></joint>
</robot>"""
# What YAML 1.1 takes for a number (yaml.org/type/float.html, as PyYAML has it) and JSON does, too.
YAML_NUMBER = re.compile(r"-?(0|[1-9][0-9]*)(\.[0-9]+(e[-+][0-9]+)?)?$")
LOOPS = """vmech_loops: "1.0"
links:
  top:   {anchors: {c: {origin: [2, 0, 0]}}}
  right: {anchors: {c: {origin: [0, 1.2, 0]}}}
loops:
  c: {type: revolute, connects: [top/c, right/c]}
"""


class Exchange(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="vmech-"))
        self.addCleanup(shutil.rmtree, self.folder)

    def run_vmech(self, *arguments):
        return subprocess.run([VMECH, *map(str, arguments)], cwd=self.folder, capture_output=True,
                              text=True, stdin=subprocess.DEVNULL, timeout=120, check=False)

    def succeed(self, *arguments):
        result = self.run_vmech(*arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result.stdout

    def refuse(self, code, *arguments):
        """The error text of a run that must fail and leave nothing behind."""
        before = sorted(self.folder.rglob("*"))
        result = self.run_vmech(*arguments)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        self.assertEqual(sorted(self.folder.rglob("*")), before)
        return result.stderr

    def read(self, *arguments):
        """vmech import, or a skip where the package behind it is absent."""
        result = self.run_vmech("import", *arguments)
        if "vmech was built without" in result.stderr:
            self.skipTest(result.stderr)
        return result

    def check(self, mechanism):
        return json.loads(self.succeed("check", mechanism, "--dh", "--json"))

    def write(self, name, text):
        (self.folder / name).write_text(text, encoding="utf-8")
        return name

    def test_sdf_and_back_keeps_mobility_and_masses(self):
        for name in MECHANISMS:
            with self.subTest(name=name):
                self.succeed("export", EXAMPLES / f"{name}.yaml", "--out", "there.sdf")
                self.assertEqual(self.read("there.sdf", "--out", "back.yaml").returncode, 0)
                before, after = self.check(EXAMPLES / f"{name}.yaml"), self.check("back.yaml")
                self.assertEqual(after["mobility"], before["mobility"])
                self.assertEqual(sum(link["mass"] for link in after["links"]),
                                 sum(link["mass"] for link in before["links"]))

    def test_mjcf_has_a_body_for_every_link_that_moves(self):
        for name in MECHANISMS:
            with self.subTest(name=name):
                out = self.succeed("export", EXAMPLES / f"{name}.yaml", "--out", "there.xml")
                self.assertIn("written to there.xml", out)
                root = xml.etree.ElementTree.parse(self.folder / "there.xml")
                bodies = {body.get("name") for body in root.iter("body")}
                report = self.check(EXAMPLES / f"{name}.yaml")
                self.assertLessEqual({link["name"] for link in report["links"]}
                                     - {report["ground"]}, bodies)

    def test_native_export_in_dh_frames_has_the_same_table(self):
        self.succeed("export", EXAMPLES / "puma-560.yaml", "--out", "dh.yaml", "--dh-frames")
        before, after = self.check(EXAMPLES / "puma-560.yaml"), self.check("dh.yaml")
        for old, new in zip(before["denavit_hartenberg"], after["denavit_hartenberg"]):
            for key in ("theta", "d", "a", "alpha"):
                self.assertAlmostEqual(old[key], new[key], places=12)

    def test_import_reports_what_it_found_and_guessed(self):
        self.succeed("export", EXAMPLES / "slider-crank.yaml", "--out", "s.sdf")
        out = self.read("s.sdf", "--out", "s.yaml").stdout
        for part in ("links       4", "0.35 kg, centre of gravity [55, 0, 0] mm", "ground",
                     "prismatic    frame - slider", "gravity     [0, -9.81, 0]",
                     "loops       1, which close from", "written to s.yaml"):
            self.assertIn(part, out)
        self.assertTrue((self.folder / "s.yaml").read_text().startswith("# From s.sdf (SDFormat)"))

    def test_urdf_gets_its_loops_from_a_side_file(self):
        self.write("bars.urdf", URDF)
        self.write("loops.yaml", LOOPS)
        result = self.read("bars.urdf", "--loops", "loops.yaml", "--out", "bars.yaml",
                           "--gravity", "0 -9.81 0")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("1 of the joints come from loops.yaml", result.stdout)
        self.assertEqual(self.check("bars.yaml")["mobility"], 1)
        self.assertIn("gravity: [0, -9.81, 0]", (self.folder / "bars.yaml").read_text())

    def test_a_loop_that_cannot_close_is_code_3_with_its_gap(self):
        self.write("bars.urdf", URDF)
        self.write("loops.yaml", LOOPS.replace("1.2", "9"))
        result = self.read("bars.urdf", "--loops", "loops.yaml", "--out", "bars.yaml")
        self.assertEqual(result.returncode, 3, result.stderr)
        self.assertIn("NOT ASSEMBLED", result.stdout)

    def test_a_robot_is_mended_and_told_or_refused_by_name(self):
        self.write("lever.urdf", LEVER)
        out = self.succeed("import", "lever.urdf", "--out", "lever.yaml")
        self.assertIn("'stand' is the ground: its inertia is dropped (lever.urdf:2)", out)
        self.assertIn("link 'bar': the largest moment of inertia exceeds", out)
        self.assertIn("to [0.00125, 0.00225, 0.0035] kg m^2 (lever.urdf:4)", out)
        self.assertEqual(self.check("lever.yaml")["links"][1]["mass"], 2)
        error = self.refuse(2, "import", "lever.urdf", "--out", "new.yaml", "--strict")
        self.assertIn("lever.urdf:4:1: link 'bar': the largest moment", error)

    def test_the_verdict_on_an_inertia_does_not_hang_on_the_frame(self):
        for x, izz in (("0", "0.0035"), ("0.5", "0.0035"), ("1", "0.0075")):
            with self.subTest(x=x):
                self.write("cg.urdf", LEVER.replace("0.5 0 0", x + " 0 0")
                           .replace('izz="0.0035"', f'izz="{izz}"'))
                self.assertIn("link 'bar': the largest moment",
                              self.succeed("import", "cg.urdf", "--out", "cg.yaml"))
                self.assertIn("link 'bar'", self.refuse(2, "import", "cg.urdf", "--strict"))

    def test_figures_that_are_not_finite_are_refused_by_element(self):
        for figure in ("nan", "inf", "1e999"):
            with self.subTest(figure=figure):
                self.write("mass.urdf", LEVER.replace('mass value="2"', f'mass value="{figure}"'))
                error = self.refuse(2, "import", "mass.urdf", "--out", "x.yaml")
                self.assertIn("mass.urdf:4:1: 'value' of <mass> of link 'bar': "
                              f"'{figure}' is not a finite", error)

    def test_links_that_go_round_in_a_circle_are_refused_by_name(self):
        self.write("cycle.urdf", URDF.replace('<parent link="base"/><child link="left"/>',
                                              '<parent link="top"/><child link="left"/>'))
        error = self.refuse(2, "import", "cycle.urdf", "--out", "x.yaml")
        self.assertIn("in a circle, left -> top -> left (joints 'b', 'a')", error)

    def test_grasps_are_proposed_at_the_ends_of_chains_or_asked_for(self):
        self.write("bars.urdf", URDF)
        out = self.succeed("import", "bars.urdf", "--out", "bars.yaml")
        self.assertIn("proposed grasps, at the ends of chains: top, right", out)
        self.assertIn("link: top", (self.folder / "bars.yaml").read_text())
        self.succeed("import", "bars.urdf", "--out", "bars.yaml", "--grasp", "left")
        grasps = (self.folder / "bars.yaml").read_text().split("grasps:")[1]
        self.assertIn("link: left", grasps)
        self.assertNotIn("link: top", grasps)
        self.assertIn("did you mean 'left'?",
                      self.refuse(2, "import", "bars.urdf", "--out", "x.yaml", "--grasp", "lfet"))

    def test_neither_command_writes_over_what_it_reads(self):
        crank = self.folder / "crank.yaml"
        shutil.copy(EXAMPLES / "crank.yaml", crank)
        self.write("loops.yaml", LOOPS)
        self.write("bars.urdf", URDF)
        (self.folder / "folder").mkdir()
        (self.folder / "soft.yaml").symlink_to("crank.yaml")
        (self.folder / "robot.urdf").symlink_to("bars.urdf")
        os.link(crank, self.folder / "hard.yaml")
        os.link(self.folder / "bars.urdf", self.folder / "bars.yaml")
        before = {path: path.read_bytes() for path in self.folder.rglob("*") if path.is_file()}
        for out in ("crank.yaml", "./crank.yaml", "folder/../crank.yaml", "soft.yaml", "hard.yaml",
                    crank):
            with self.subTest(out=out):
                self.assertIn("would be written over",
                              self.refuse(2, "export", "crank.yaml", "--out", out))
        for out in ("loops.yaml", "bars.yaml"):
            with self.subTest(out=out):
                self.assertIn("would be written over",
                              self.refuse(2, "import", "robot.urdf", "--out", out, "--loops",
                                          "loops.yaml"))
        for path, text in before.items():
            self.assertEqual(path.read_bytes(), text)
        self.succeed("export", "crank.yaml", "--out", "other.yaml")
        self.succeed("export", "crank.yaml", "--out", "other.yaml", "--si")

    def test_numbers_are_numbers_to_every_reader_of_yaml(self):
        text = (EXAMPLES / "crank.yaml").read_text(encoding="utf-8")
        self.assertIn("gravity:", text)
        self.write("odd.yaml", re.sub(r"gravity: .*", "gravity: [1e-7, -3e-9, 2e25]", text))
        for units in ((), ("--si",)):
            self.succeed("export", "odd.yaml", "--out", "new.yaml", *units)
            written = (self.folder / "new.yaml").read_text(encoding="utf-8")
            self.assertIn("gravity: [1.0e-07, -3.0e-09, 2.0e+25]", written)
            words = re.findall(r"(?<=[\[ ])-?[.0-9][^],} \n]*", written)
            self.assertGreater(len(words), 5)
            for word in words:
                self.assertRegex(word, YAML_NUMBER)
            try:
                import yaml  # not everywhere
            except ImportError:
                continue
            gravity = yaml.safe_load(written)["gravity"]
            self.assertEqual(gravity, [1e-7, -3e-9, 2e25])
            self.assertTrue(all(math.isfinite(value) for value in gravity))

    def test_files_that_are_not_read_get_the_way_round(self):
        for name, way in (("robot.urdf.xacro", "run xacro first"), ("crank.SLDASM", "SolidWorks"),
                          ("crank.ipt", "Inventor"), ("crank.iam", "Inventor"),
                          ("crank.f3d", "Fusion"), ("crank.prt", "NX"),
                          ("crank.CATProduct", "CATIA"), ("crank.x_t", "Parasolid"),
                          ("crank.igs", "STEP"), ("robot.dae", "mesh"), ("robot.usd", "USD"),
                          ("robot.xml", "reads none"), ("crank.FCStd", "freecad.md")):
            with self.subTest(name=name):
                self.write(name, "whatever")
                error = self.refuse(2, "import", name, "--out", "x.yaml")
                self.assertIn(way, error)
                self.assertIn("read are: .step", error)

    def test_options_that_do_nothing_for_a_file_are_refused(self):
        self.write("bars.urdf", URDF)
        self.write("crank.step", "")
        for arguments, words in ((("bars.urdf", "--model", "m"), "--model is for SDFormat"),
                                 (("crank.step", "--loops", "l.yaml"), "--loops is for URDF"),
                                 (("crank.step", "--grasp", "crank"), "grasp_NAME")):
            with self.subTest(arguments=arguments):
                self.assertIn(words, self.refuse(2, "import", *arguments, "--out", "x.yaml"))

    def test_wrong_files_leave_nothing_behind(self):
        self.read(self.write("bars.urdf", URDF), "--out", "probe.yaml")
        self.write("torn.urdf", URDF[:200])
        self.write("torn.sdf", "<sdf version='1.9'><model name='m'>")
        self.write("notes.txt", "hello")
        for arguments, words in (
                (("torn.urdf", "--out", "new/x.yaml"), "torn.urdf"),
                (("torn.sdf", "--out", "x.yaml"), "torn.sdf"),
                (("absent.sdf", "--out", "x.yaml"), "absent.sdf"),
                (("notes.txt", "--out", "x.yaml"), ".urdf"),
                (("bars.urdf", "--out", "x.sdf"), ".yaml"),
                (("bars.urdf", "--out", "x.yaml", "--ground", "bass"), "did you mean 'base'"),
                (("bars.urdf", "--out", "x.yaml", "--gravity", "0 0"), "three numbers"),
                (("bars.urdf", "--out", "x.yaml", "--loops", "absent.yaml"), "absent.yaml")):
            with self.subTest(arguments=arguments):
                self.assertIn(words, self.refuse(2, "import", *arguments))

    def test_export_refuses_what_it_cannot_write(self):
        text = (EXAMPLES / "four-bar.yaml").read_text(encoding="utf-8")
        self.assertIn("origin: [1.2, 0, 0]", text)
        self.write("open.yaml", text.replace("origin: [1.2, 0, 0]", "origin: [12, 0, 0]"))
        self.assertIn(".mjcf", self.refuse(1, "export", EXAMPLES / "crank.yaml", "--out", "x.step"))
        self.assertIn("apart", self.refuse(3, "export", "open.yaml", "--out", "x.sdf"))
        self.write("world.yaml", (EXAMPLES / "crank.yaml").read_text(encoding="utf-8")
                   .replace("crank:", "world:").replace("crank/", "world/")
                   .replace("link: crank", "link: world"))
        self.assertIn("rename", self.refuse(2, "export", "world.yaml", "--out", "x.sdf"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
