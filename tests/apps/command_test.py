"""command_test.py VMECH EXAMPLES: the vmech command as its users meet it."""

import csv
import hashlib
import html.parser
import json
import math
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

VMECH = ""
EXAMPLES = pathlib.Path()

# Degrees of freedom of every example, counted by hand from how it is built.
MOBILITY = {
    "andrews-squeezer": 1, "beam-on-three-supports": 0, "bennett": 1, "bricard": 1, "crank": 1,
    "delta-robot": 3, "dietmaier-platform": 6, "door-on-two-hinges": 1, "flyball-governor": 4,
    "four-bar": 1, "manseur-doty": 6, "marghitu-slider-crank": 1, "modelica-engine1a": 1,
    "modelica-four-bar": 1,
    "n-window-four-bar": 1, "puma-560": 6, "redundant-arm": 7, "rssr": 2, "rsup": 1,
    "slider-crank": 1, "spherical-four-bar": 1,
    "four-bar-by-lengths": 1, "hexapod": 6, "hexapod-leg": 3,
    "square-four-bar": 1, "stewart-gough": 6, "stewart-gough-sps": 12,
    "sundials-slider-crank": 1, "two-link-arm": 2,
}
OUTPUTS = {"loads.csv", "motion.csv", "joints.csv", "certainty.csv", "bearings.csv",
           "summary.json", "report.html"}
WRENCH = ("fx", "fy", "fz", "mx", "my", "mz")
MOTION = ("x", "y", "z", "qw", "qx", "qy", "qz", "vx", "vy", "vz", "wx", "wy", "wz", "ax", "ay",
          "az", "alphax", "alphay", "alphaz")
POWER_TOLERANCE = 1e-9  # of the largest term of the balance
UNIT_TOLERANCE = 1e-12  # of a unit quaternion: rounding of a rotation matrix


def vmech(*arguments, folder=None, epoch="1700000000"):
    """Runs the command as a shell would, without a terminal, on a day of its own."""
    return subprocess.run([VMECH, *map(str, arguments)], cwd=folder, capture_output=True,
                          text=True, stdin=subprocess.DEVNULL, timeout=120,
                          env={**os.environ, "SOURCE_DATE_EPOCH": epoch})


def skew_rocker(angle):
    """The pose of the grasp 'rocker' of rssr.yaml: position, and quaternion of the turn about x
    that takes z to the output axis, then about z by the angle."""
    tilt = math.atan2(0.644217687237691, 0.7648421872844886)
    x, y = 0.6 * math.cos(angle), 0.6 * math.sin(angle)
    position = (1 + x, 0.3 + y * math.cos(tilt), 0.2 + y * math.sin(tilt))
    ct, st = math.cos(tilt / 2), math.sin(tilt / 2)
    ca, sa = math.cos(angle / 2), math.sin(angle / 2)
    return " ".join(repr(value) for value in (*position, ct * ca, st * ca, -st * sa, ct * sa))


def studies():
    return sorted(EXAMPLES.glob("*-study.yaml"))


def suites():
    return [path for path in EXAMPLES.glob("*.yaml")
            if "\nvmech_suite:" in "\n" + path.read_text(encoding="utf-8")]


def read_csv(path):
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.reader(file))


class InFolder(unittest.TestCase):
    """A test with a folder of its own that holds a copy of the examples."""

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="vmech-"))
        self.addCleanup(shutil.rmtree, self.folder)
        for source in EXAMPLES.iterdir():
            shutil.copy(source, self.folder)

    def run_vmech(self, *arguments):
        return vmech(*arguments, folder=self.folder)

    def edit(self, source, name, *changes):
        """A copy of an example under a new name, with pieces of its text replaced."""
        text = (self.folder / source).read_text(encoding="utf-8")
        for old, new in changes:
            self.assertIn(old, text)
            text = text.replace(old, new)
        (self.folder / name).write_text(text, encoding="utf-8")
        return name

    def names(self):
        return sorted(path.name for path in self.folder.rglob("*"))


class Help(unittest.TestCase):
    def test_lists_subcommands_and_every_exit_code(self):
        result = vmech("--help")
        self.assertEqual(result.returncode, 0)
        for word in ("check", "loads", "ik", "Exit codes", *(f"{code} " for code in range(6))):
            self.assertIn(word, result.stdout)

    def test_of_subcommands_names_arguments_options_outputs_and_exit_codes(self):
        for name, words in (("check", ("MECHANISM", "--json")),
                            ("ik", ("MECHANISM", "--target", "--grasp", "--solver", "--start",
                                    "--json")),
                            ("loads", ("STUDY", "--out", "--threads", "--quiet", *OUTPUTS))):
            result = vmech(name, "--help")
            self.assertEqual(result.returncode, 0)
            for word in ("Usage: vmech " + name, "YAML or JSON", "Exit codes", *words):
                self.assertIn(word, result.stdout)

    def test_version_is_name_and_number_then_commit_compiler_and_packages(self):
        first, *lines = vmech("--version").stdout.splitlines()
        self.assertRegex(first, r"^vmech \d+\.\d+\.\d+$")
        self.assertEqual([line.split()[0] for line in lines],
                         ["commit", "compiler", "with", "without"])
        self.assertRegex(lines[0], r" [0-9a-f]{12}( and changes to it)?$| unknown: ")

    def test_wrong_command_lines_are_code_1_on_standard_error(self):
        for arguments in ((), ("chekc",), ("check",), ("loads",), ("loads", "a", "b"),
                          ("ik", EXAMPLES / "four-bar.yaml"),
                          ("loads", "s.yaml", "--threads", "65"),
                          ("loads", "s.yaml", "--outt")):
            with self.subTest(arguments=arguments):
                result = vmech(*arguments)
                self.assertEqual(result.returncode, 1)
                self.assertEqual(result.stdout, "")
                self.assertIn("--help", result.stderr)


class Check(InFolder):
    def test_tells_mobility_of_every_example(self):
        mechanisms = {path.stem for path in EXAMPLES.glob("*.yaml")}
        mechanisms -= {path.stem for path in [*studies(), *suites()]}
        self.assertEqual(mechanisms, set(MOBILITY))
        for name, mobility in MOBILITY.items():
            with self.subTest(name=name):
                result = self.run_vmech("check", name + ".yaml", "--json")
                self.assertEqual(result.returncode, 0, result.stderr)
                report = json.loads(result.stdout)
                self.assertTrue(report["assembled"])
                self.assertEqual(report["mobility"], mobility)
                self.assertEqual(report["mobility"],
                                 report["gruebler"] + report["redundant_equations"])
                self.assertEqual(len(report["loops"]), sum(j["cut"] for j in report["joints"]))

    def test_says_in_text_what_it_says_in_json(self):
        for name, mobility in MOBILITY.items():
            with self.subTest(name=name):
                result = self.run_vmech("check", name + ".yaml")
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertRegex(result.stdout, rf"(?m)^mobility +{mobility}\b")
                report = json.loads(self.run_vmech("check", name + ".yaml", "--json").stdout)
                for part in report["links"] + report["joints"]:
                    self.assertIn(part["name"], result.stdout)

    def test_calls_nothing_locked_that_merely_stands_still_for_a_moment(self):
        # Both start at a pose where the velocity of some joints passes through zero.
        for name in ("andrews-squeezer", "sundials-slider-crank"):
            with self.subTest(name=name):
                self.assertNotIn("locked", self.run_vmech("check", name + ".yaml").stdout)
        self.assertRegex(self.run_vmech("check", "beam-on-three-supports.yaml").stdout,
                         r"(?m)^locked +left, middle_track, middle, right_track, right$")

    def test_lists_every_error_with_file_line_and_column(self):
        self.edit("slider-crank.yaml", "bad.yaml", ("crank/pin,", "cranc/pin,"),
                  ("mass: 0.35", "mass: -0.35"), ("type: prismatic", "type: prismatik"))
        result = self.run_vmech("check", "bad.yaml")
        self.assertEqual((result.returncode, result.stdout), (2, ""))
        lines = result.stderr.splitlines()
        self.assertEqual(len(lines), 3)
        for line in lines:
            self.assertRegex(line, r"^bad\.yaml:\d+:\d+: ")
        self.assertIn("did you mean 'crank/pin'?", result.stderr)
        self.assertIn("did you mean 'prismatic'?", result.stderr)

    def test_loop_that_cannot_be_closed_is_code_3_and_says_where(self):
        self.edit("four-bar.yaml", "open.yaml", ("[1.1, 0, 0]", "[11, 0, 0]"))
        result = self.run_vmech("check", "open.yaml")
        self.assertEqual(result.returncode, 3)
        self.assertIn("NOT ASSEMBLED", result.stdout)
        broken = json.loads(self.run_vmech("check", "open.yaml", "--json").stdout)
        self.assertFalse(broken["assembled"])
        self.assertIn("message", broken)

    def test_points_from_a_study_to_the_other_command_and_back(self):
        result = self.run_vmech("check", "slider-crank-study.yaml")
        self.assertEqual(result.returncode, 2)
        self.assertIn("vmech loads", result.stderr)
        result = self.run_vmech("loads", "slider-crank.yaml")
        self.assertEqual(result.returncode, 2)
        self.assertIn("vmech check", result.stderr)

    def test_absent_file_and_folder_are_code_2(self):
        for name, words in (("nothing.yaml", "cannot be opened"), (".", "is a folder")):
            result = self.run_vmech("check", name)
            self.assertEqual(result.returncode, 2)
            self.assertIn(words, result.stderr)


class Ik(InFolder):
    """Lengths and angles on the command line are in the units of the file."""

    def answer(self, *arguments):
        result = self.run_vmech("ik", *arguments, "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(result.stdout)

    @staticmethod
    def value(answer, joint):
        return next(j["values"][0] for j in answer["joints"] if j["name"] == joint)

    def test_reaches_a_point_in_the_units_of_the_file(self):
        # Crank at 60 degrees: the piston is at 50 cos 60 + sqrt(150^2 - (50 sin 60)^2) mm. The
        # grasp is 100 mm along the rod, which leans by asin(50 sin 60 / 150).
        lean = math.asin(50 * math.sin(math.pi / 3) / 150)
        x = 50 * math.cos(math.pi / 3) + 100 * math.cos(lean)
        y = 50 * math.sin(math.pi / 3) - 100 * math.sin(lean)
        target = f"{x!r} {y!r} 0  0 0 {math.degrees(-lean)!r}"
        answer = self.answer("slider-crank.yaml", "--target", target)
        self.assertEqual((answer["verdict"], answer["branch"]), ("reached", "same"))
        self.assertAlmostEqual(self.value(answer, "main"), math.pi / 3, delta=1e-9)
        text = self.run_vmech("ik", "slider-crank.yaml", "--target", target).stdout
        self.assertRegex(text, r"(?m)^  main +60(\.0+\d)? deg$|^  main +59\.9+\d* deg$")

    def test_calls_what_is_too_far_out_of_reach_and_gives_the_nearest_pose(self):
        answer = self.answer("two-link-arm.yaml", "--target", "3 4 0")
        self.assertEqual(answer["verdict"], "out of reach")
        self.assertEqual(answer["status"], "converged")
        self.assertLess(answer["kkt_error"], 1e-8)
        # 0.9 m of arm point at a hand 5 m away.
        self.assertAlmostEqual(math.hypot(*answer["e1"]["position"]), 4.1, delta=1e-9)
        self.assertAlmostEqual(self.value(answer, "shoulder"), math.atan2(4, 3), delta=1e-6)

    def test_turns_no_hinge_round_to_get_there(self):
        # The tip, 0.3 m from its hinge and 40 degrees up, is to be where it cannot reach: a long
        # step of the solver overshoots by a whole turn, and a hand beyond twice the radius turns
        # against the steps of Gauss and Newton that the branch is followed by.
        for target, angle in (("-1 0 0", math.pi), ("1 0 0", 0), ("0.05 0.5 0", math.atan2(10, 1))):
            answer = self.answer("crank.yaml", "--target", target)
            self.assertEqual((answer["verdict"], answer["branch"]), ("out of reach", "same"))
            self.assertAlmostEqual(self.value(answer, "main"), angle, delta=1e-6)

    def test_goes_to_the_branch_of_the_start(self):
        up = self.answer("two-link-arm.yaml", "--target", "0.5 0.3 0", "--start", "elbow=-60")
        down = self.answer("two-link-arm.yaml", "--target", "0.5 0.3 0", "--start", "elbow=60")
        for answer in (up, down):
            self.assertEqual((answer["verdict"], answer["branch"]), ("reached", "same"))
        self.assertAlmostEqual(self.value(up, "elbow"), -self.value(down, "elbow"), delta=1e-8)

    def test_tells_the_branch_of_a_rocker_whatever_its_rod_does(self):
        # The rod between two balls spins as each solver leaves it; the crank tells the branch.
        for turn in (5, 12, 20):
            target = skew_rocker(1.422806772461814 + math.radians(turn))
            cranks = []
            for solver in ("nullspace", "augmented_lagrangian", "ceres_exact", "ipopt", "penalty"):
                with self.subTest(turn=turn, solver=solver):
                    result = self.run_vmech("ik", "rssr.yaml", "--grasp", "rocker", "--target",
                                            target, "--solver", solver, "--json")
                    answer = json.loads(result.stdout)
                    if answer["status"] == "unavailable":
                        self.skipTest(answer["message"])
                    self.assertEqual((answer["verdict"], answer["branch"]), ("reached", "same"))
                    cranks.append(self.value(answer, "input"))
            self.assertLess(max(cranks) - min(cranks), 1e-4)

    def test_is_the_same_by_every_exact_solver(self):
        target = "0.9 0.7 0.05  0 0 0.4"
        reference = self.answer("four-bar.yaml", "--target", target)
        self.assertEqual(reference["verdict"], "out of reach")
        for solver in ("augmented_lagrangian", "ipopt", "kinsol", "ceres_exact"):
            with self.subTest(solver=solver):
                result = self.run_vmech("ik", "four-bar.yaml", "--target", target, "--solver",
                                        solver, "--json")
                answer = json.loads(result.stdout)
                if answer["status"] == "unavailable":
                    self.skipTest(answer["message"])
                self.assertEqual(result.returncode, 0, result.stdout)
                self.assertAlmostEqual(self.value(answer, "main"), self.value(reference, "main"),
                                       delta=1e-8)
        biased = self.answer("four-bar.yaml", "--target", target, "--solver", "penalty")
        self.assertEqual(biased["verdict"], "biased")
        self.assertLessEqual(0, biased["bias_bound"])
        self.assertGreater(biased["e2"]["length"], 1e-9)

    def test_takes_a_rotation_vector_or_a_quaternion(self):
        half = math.radians(20) / 2
        one = self.answer("crank.yaml", "--grasp", "handle", "--target", "0.3 0.1 0 0 0 20")
        two = self.answer("crank.yaml", "--grasp", "handle", "--target",
                          f"0.3 0.1 0 {math.cos(half)!r} 0 0 {math.sin(half)!r}")
        self.assertAlmostEqual(self.value(one, "main"), self.value(two, "main"), delta=1e-10)

    def test_balances_the_pull_of_the_hand_at_the_cut_joints(self):
        answer = self.answer("four-bar.yaml", "--target", "0.9 0.9 0", "--stiffness",
                             "1000 1000 1000 0 0 0")
        self.assertGreater(math.hypot(*answer["loops"][0]["force"]), 1)
        self.assertEqual(answer["stiffness"], [1000, 1000, 1000, 0, 0, 0])

    def test_refuses_what_it_does_not_understand_with_a_remedy(self):
        for arguments, words in (
                (("--target", "1 2"), ("2 numbers", "x y z")),
                (("--target", "1 2 x"), ("'x' is not a number",)),
                (("--target", "1 2 3 0 0 0 0"), ("quaternion",)),
                (("--target", "1 2 3", "--grasp", "handel"), ("did you mean 'handle'?",)),
                (("--target", "1 2 3", "--solver", "newton"), ("nullspace",)),
                (("--target", "1 2 3", "--start", "mein=1"), ("did you mean 'main'?",)),
                (("--target", "1 2 3", "--start", "main"), ("--start joint=30",)),
                (("--target", "1 2 3", "--stiffness", "1 2"), ("six",))):
            with self.subTest(arguments=arguments):
                result = self.run_vmech("ik", "four-bar.yaml", *arguments)
                self.assertEqual((result.returncode, result.stdout), (1, ""))
                for word in words:
                    self.assertIn(word, result.stderr)


class WellFormed(html.parser.HTMLParser):
    """Checks that every element of a page is closed in its turn and that it loads nothing."""

    VOID = {"meta", "br", "hr", "img", "link", "input"}

    def __init__(self):
        super().__init__()
        self.open, self.faults, self.seen = [], [], set()

    def handle_starttag(self, tag, attributes):
        self.seen.add(tag)
        if tag not in self.VOID:
            self.open.append(tag)
        for key, value in attributes:
            if key in ("src", "href") and value and not value.startswith("#"):
                self.faults.append(f"{tag} loads {value}")

    def handle_startendtag(self, tag, attributes):
        self.seen.add(tag)

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            self.faults.append(f"</{tag}> at {self.getpos()}")


class Loads(InFolder):
    def expect_loads_header(self, out, summary):
        table = read_csv(out / "loads.csv")
        drives = summary["drives"]
        one = len(drives) == 1
        names = ["drive" if one else "drive." + drive["joint"] for drive in drives]
        by_hand = not drives and summary["motion"] != "at rest"
        hand = ["handle." + c for c in (*WRENCH, "distance")] if by_hand else []
        self.assertEqual(
            table[0],
            ["t", *(name + ".position" for name in names),
             *(f"{joint['name']}.{c}" for joint in summary["joints"] for c in WRENCH),
             *(name + ".force" for name in names), *hand, "power_error"])
        self.assertEqual(len(table), 1 + summary["poses"])
        for row in table[1:]:
            self.assertEqual(len(row), len(table[0]))
            self.assertTrue(all(math.isfinite(float(value)) for value in row))
            self.assertLess(abs(float(row[-1])), POWER_TOLERANCE)
        self.assertNotIn("-0", {value for row in table[1:] for value in row})

    def expect_motion(self, out, mechanism):
        ground, links = mechanism["ground"], [link["name"] for link in mechanism["links"]]
        table = read_csv(out / "motion.csv")
        links.remove(ground)
        self.assertEqual(table[0], ["t"] + [f"{link}.{c}" for link in links for c in MOTION])
        for row in table[1:]:
            values = [float(value) for value in row]
            for start in range(1, len(values), len(MOTION)):
                norm = math.hypot(*values[start + 3:start + 7])
                self.assertLess(abs(norm - 1), UNIT_TOLERANCE)

    def expect_certainty(self, out, summary):
        rows = read_csv(out / "certainty.csv")
        self.assertEqual(rows[0], ["joint", "component", "verdict"])
        self.assertEqual(rows[1:], [[joint["name"], component, verdict]
                                    for joint in summary["joints"]
                                    for component, verdict in zip(WRENCH, joint["certainty"])])

    def test_writes_all_outputs_of_every_study(self):
        for study in studies():
            with self.subTest(study=study.name):
                out = self.folder / "out" / study.stem
                result = self.run_vmech("loads", study.name, "--out", out)
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertEqual({path.name for path in out.iterdir()}, OUTPUTS)
                summary = json.loads((out / "summary.json").read_text(encoding="utf-8"))
                mechanism = json.loads(self.run_vmech(
                    "check", summary["mechanism"] + ".yaml", "--json").stdout)
                self.assertEqual([joint["name"] for joint in summary["joints"]],
                                 [joint["name"] for joint in mechanism["joints"]])
                self.expect_loads_header(out, summary)
                self.expect_motion(out, mechanism)
                self.expect_certainty(out, summary)
                self.assertLess(summary["max_power_error"], POWER_TOLERANCE)

    def test_joints_table_is_the_slider_crank_of_the_textbook(self):
        self.run_vmech("loads", "slider-crank-study.yaml", "--out", "out")
        header, *rows = read_csv(self.folder / "out" / "joints.csv")
        self.assertEqual(header, ["t"] + [f"{joint}.{what}"
                                          for joint in ("main", "pin", "wrist", "guide")
                                          for what in ("position", "rate", "acceleration")])
        r, rod, w = 0.05, 0.15, 50 * math.pi
        for row in rows:
            angle, rate, acceleration, *others = map(float, row[1:])
            x, dx, ddx = others[-3:]
            s, c = math.sin(angle), math.cos(angle)
            along = math.sqrt(rod ** 2 - (r * s) ** 2)  # of the rod on the slide
            slope = -r * r * s * c / along
            self.assertAlmostEqual(rate, w, delta=1e-9 * w)
            self.assertEqual(acceleration, 0)
            self.assertAlmostEqual(x, r * c + along, delta=1e-12)
            self.assertAlmostEqual(dx, w * (slope - r * s), delta=1e-10)
            second = -(r * r * math.cos(2 * angle) + slope ** 2) / along
            self.assertAlmostEqual(ddx, w * w * (second - r * c), delta=1e-7)
        summary = json.loads((self.folder / "out" / "summary.json").read_text(encoding="utf-8"))
        guide, = summary["joints"][-1]["motion"]
        self.assertAlmostEqual(guide["stroke"], 2 * r, delta=1e-9)
        self.assertAlmostEqual(guide["greatest"], rod + r, delta=1e-9)
        self.assertAlmostEqual(summary["joints"][-1]["time_ratio"], 1, delta=1e-6)
        # Least where the crank stands across the slide: sin = r / rod from the normal.
        self.assertAlmostEqual(summary["transmission_angle"]["least"], math.acos(r / rod),
                               delta=1e-3)

    def test_report_names_what_it_was_computed_from(self):
        out = self.folder / "out"
        self.run_vmech("loads", "slider-crank-study.yaml", "--out", "out")
        page = (out / "report.html").read_text(encoding="utf-8")
        for name in ("slider-crank-study.yaml", "slider-crank.yaml", "slider-crank-gas.csv"):
            digest = hashlib.sha256((self.folder / name).read_bytes()).hexdigest()
            self.assertIn(f"<td>{name}</td><td><code>{digest}</code></td>", page)
        self.assertIn("on 2023-11-14 (UTC)", page)
        result = vmech("loads", "slider-crank-study.yaml", folder=self.folder, epoch="yesterday")
        self.assertEqual(result.returncode, 2)
        self.assertIn("SOURCE_DATE_EPOCH is 'yesterday'", result.stderr)

    def test_bearing_table_has_a_row_for_every_position(self):
        self.run_vmech("loads", "slider-crank-study.yaml", "--out", "out")
        rows = read_csv(self.folder / "out" / "bearings.csv")
        self.assertEqual([row[0] for row in rows], ["joint", "main", "main", "pin", "wrist"])
        self.assertEqual([float(row[1]) for row in rows[1:]], [-0.015, 0.015, 0, 0])
        self.assertEqual({row[3] for row in rows[1:]}, {"yes"})
        self.assertEqual({len(row) for row in rows}, {len(rows[0])})

    def test_report_is_one_well_formed_page_that_loads_nothing(self):
        for study in studies():
            with self.subTest(study=study.name):
                self.run_vmech("loads", study.name, "--out", "out")
                page = WellFormed()
                page.feed((self.folder / "out" / "report.html").read_text(encoding="utf-8"))
                self.assertEqual((page.faults, page.open), ([], []))
                self.assertLessEqual({"html", "title", "svg", "table"}, page.seen)

    def test_bytes_do_not_depend_on_the_number_of_threads(self):
        for study in studies():
            for threads in ("1", "2"):
                self.run_vmech("loads", study.name, "--out", "out" + threads, "--threads", threads)
            for name in OUTPUTS:
                with self.subTest(study=study.name, name=name):
                    one, two = (self.folder / ("out" + t) / name for t in ("1", "2"))
                    self.assertEqual(one.read_bytes(), two.read_bytes())

    def test_out_is_named_after_the_study_where_none_is_given(self):
        self.run_vmech("loads", "four-bar-study.yaml")
        self.assertTrue((self.folder / "four-bar-study-loads" / "report.html").exists())

    def test_quiet_prints_nothing(self):
        result = self.run_vmech("loads", "four-bar-study.yaml", "--quiet")
        self.assertEqual((result.returncode, result.stdout, result.stderr), (0, "", ""))

    def test_summary_names_open_components_and_hides_rounding(self):
        self.edit("slider-crank-study.yaml", "pushed.yaml",
                  ("external:", "external:\n  - {link: slider, force: [0, 0, 100]}"))
        result = self.run_vmech("loads", "pushed.yaml")
        self.assertRegex(result.stdout,
                         r"(?m)^ *main .*not determined by statics: fz mx my(; no load.*)?$")
        self.assertNotRegex(result.stdout.split("written to")[0].split("main ", 2)[2],
                            r"e-1\d N")

    def test_warns_of_bearings_that_carry_too_little(self):
        result = self.run_vmech("loads", "slider-crank-by-hand-study.yaml", "--out", "out")
        self.assertIn("warning: mean load 2.94 N is below the minimum load", result.stdout)
        summary = json.loads((self.folder / "out" / "summary.json").read_text(encoding="utf-8"))
        self.assertIn("minimum load", summary["bearings"][0]["positions"][0]["warnings"][0])

    def test_report_names_the_hardest_of_several_drives(self):
        self.run_vmech("loads", "stewart-gough-study.yaml", "--out", "out")
        summary = json.loads((self.folder / "out" / "summary.json").read_text(encoding="utf-8"))
        hardest = max(summary["drives"], key=lambda drive: drive["peak_force"])
        page = (self.folder / "out" / "report.html").read_text(encoding="utf-8")
        self.assertIn(f"at joint {hardest['joint']}, ", page)

    def test_json_study_gives_the_same_loads_as_yaml(self):
        (self.folder / "study.json").write_text(json.dumps({
            "vmech_study": "1.0", "mechanism": "slider-crank.yaml",
            "units": {"length": "mm", "angle": "deg"},
            "motion": {"joint": "main", "rpm": 60, "turns": 1, "steps": 36}}), encoding="utf-8")
        (self.folder / "study.yaml").write_text(
            'vmech_study: "1.0"\nmechanism: slider-crank.yaml\nunits: {length: mm, angle: deg}\n'
            "motion: {joint: main, rpm: 60, turns: 1, steps: 36}\n", encoding="utf-8")
        for kind in ("json", "yaml"):
            result = self.run_vmech("loads", "study." + kind, "--out", kind)
            self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual((self.folder / "json" / "loads.csv").read_bytes(),
                         (self.folder / "yaml" / "loads.csv").read_bytes())

    def test_a_motor_goes_on_through_hundreds_of_turns(self):
        (self.folder / "turns.yaml").write_text(
            f'vmech_study: "1.0"\nmechanism: {EXAMPLES / "four-bar.yaml"}\n'
            "motion: {joint: main, rpm: 60, turns: 1000.5, steps: 2001}\n", encoding="utf-8")
        result = self.run_vmech("loads", "turns.yaml", "--out", "out")
        self.assertEqual(result.returncode, 0, result.stderr)
        with (self.folder / "out" / "loads.csv").open(newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), 2002)
        for name in ("main.fx", "main.fy", "drive.force"):
            largest = max(abs(float(row[name])) for row in rows)
            for turn in (2, 200, 2000):
                self.assertAlmostEqual(float(rows[turn][name]), float(rows[0][name]),
                                       delta=1e-9 * largest)


class Failure(InFolder):
    def expect_untouched(self, code, *arguments):
        before = self.names()
        result = self.run_vmech(*arguments)
        self.assertEqual(result.returncode, code, result.stderr)
        self.assertEqual(result.stdout, "")
        self.assertEqual(self.names(), before)
        return result.stderr

    def test_bad_study_leaves_no_folder(self):
        self.edit("slider-crank-study.yaml", "bad.yaml", ("joint: main", "joint: mian"),
                  ("rule: stiffness", "rule: guess"))
        error = self.expect_untouched(2, "loads", "bad.yaml", "--out", "new")
        self.assertEqual(len(error.splitlines()), 2)
        for line in error.splitlines():
            self.assertRegex(line, r"^bad\.yaml:\d+:\d+: ")
        self.assertIn("did you mean 'main'?", error)

    def test_study_and_its_mechanism_are_reported_together(self):
        self.edit("slider-crank.yaml", "bad.yaml", ("mass: 0.35", "mass: -0.35"))
        self.edit("slider-crank-study.yaml", "study.yaml",
                  ("mechanism: slider-crank.yaml", "mechanism: bad.yaml"),
                  ("rule: stiffness", "rule: guess"))
        error = self.expect_untouched(2, "loads", "study.yaml")
        self.assertRegex(error, r"(?m)^bad\.yaml:\d+:\d+: ")
        self.assertRegex(error, r"(?m)^study\.yaml:\d+:\d+: ")

    def test_bad_study_does_not_change_an_old_result(self):
        self.run_vmech("loads", "four-bar-study.yaml", "--out", "out")
        old = (self.folder / "out" / "loads.csv").read_bytes()
        self.edit("four-bar-study.yaml", "bad.yaml", ("joint: main", "joint: mian"))
        self.expect_untouched(2, "loads", "bad.yaml", "--out", "out")
        self.assertEqual((self.folder / "out" / "loads.csv").read_bytes(), old)

    def test_dead_centre_is_code_3_and_names_the_pose(self):
        (self.folder / "dead.yaml").write_text(
            'vmech_study: "1.0"\nmechanism: slider-crank.yaml\nunits: {length: mm, angle: deg}\n'
            "motion: {joint: guide, speed: 100, duration: 1, steps: 100}\n", encoding="utf-8")
        error = self.expect_untouched(3, "loads", "dead.yaml", "--out", "new")
        # The piston starts at 184.8 mm and can reach 200 mm, 15 steps of 1 mm away.
        self.assertIn("dead.yaml: the motion cannot be followed to pose 16 (t = 0.16 s)", error)
        self.assertIn("dead centre", error)

    def test_drives_that_contradict_each_other_are_code_2_and_name_the_study(self):
        self.edit("slider-crank-study.yaml", "two.yaml",
                  ("steps: 720}", "steps: 720}, {joint: pin, rpm: 60}]"),
                  ("motion: {", "motion: [{"))
        error = self.expect_untouched(2, "loads", "two.yaml")
        self.assertRegex(error, r"^two\.yaml: the drives at 'main', 'pin' cannot all move")

    def test_output_that_cannot_be_written_is_code_2(self):
        with open("/dev/full", "w", encoding="utf-8") as full:
            result = subprocess.run([VMECH, "check", self.folder / "crank.yaml"], stdout=full,
                                    stderr=subprocess.PIPE, text=True, check=False)
        self.assertEqual(result.returncode, 2)
        self.assertIn("standard output: cannot be written", result.stderr)

    def test_folder_that_cannot_be_written_is_code_2(self):
        for out in ("/proc/vmech", self.folder / "crank.yaml", self.folder / "crank.yaml" / "out"):
            with self.subTest(out=out):
                error = self.expect_untouched(2, "loads", "four-bar-study.yaml", "--out", out)
                self.assertIn(str(out), error)
                self.assertIn("--out", error)

    def test_name_taken_by_a_folder_is_code_2_and_leaves_no_parts(self):
        (self.folder / "out" / "motion.csv").mkdir(parents=True)
        error = self.expect_untouched(2, "loads", "four-bar-study.yaml", "--out", "out")
        self.assertIn("motion.csv", error)

    def test_requirements_nobody_meets_are_code_4_with_results_and_reasons(self):
        self.edit("slider-crank-study.yaml", "hard.yaml", ("housing: 60", "housing: 30"))
        result = self.run_vmech("loads", "hard.yaml", "--out", "out")
        self.assertEqual((result.returncode, result.stderr), (4, ""))
        self.assertIn("no bearing of the catalogue fits", result.stdout)
        self.assertEqual({path.name for path in (self.folder / "out").iterdir()}, OUTPUTS)
        rows = read_csv(self.folder / "out" / "bearings.csv")
        self.assertEqual([row[3] for row in rows[1:]], ["no", "no", "yes", "yes"])


if __name__ == "__main__":
    VMECH, EXAMPLES = (pathlib.Path(argument).resolve() for argument in sys.argv[1:])
    unittest.main(argv=sys.argv[:1])
