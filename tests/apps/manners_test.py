"""manners_test.py VMECH EXAMPLES: how vmech answers slips, and which exit code goes with which.

0 done; 1 the command line; 2 a file; 3 no solution; 4 bearings that do not do what is asked.
"""

import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

VMECH = ""
EXAMPLES = pathlib.Path()
SOURCES = pathlib.Path(__file__).resolve().parent.parent.parent
COMMANDS = ("check", "loads", "compare", "import", "ik", "haptic", "replay", "export",
            "completion", "help")

TUBE = """vmech: "1.0"
units: {length: mm, angle: deg}
gravity: [0, 0, 0]
ground: post
links:
  post: {anchors: {a: {}}}
  arm: {mass: 1, inertia: {xx: 1000, yy: 1000, zz: 1000}, anchors: {a: {}}}
joints:
  tube: {type: cylindrical, connects: [post/a, arm/a]}
grasps:
  tip: {link: arm, origin: [100, 0, 0]}
"""


class InFolder(unittest.TestCase):
    """A test with a folder of its own that holds a copy of the examples."""

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="vmech-"))
        self.addCleanup(shutil.rmtree, self.folder)
        for source in EXAMPLES.iterdir():
            shutil.copy(source, self.folder)

    def write(self, name, text):
        (self.folder / name).write_text(text, encoding="utf-8")
        return name

    def vmech(self, *arguments):
        return subprocess.run([VMECH, *map(str, arguments)], cwd=self.folder, capture_output=True,
                              text=True, stdin=subprocess.DEVNULL, timeout=120, check=False)

    def expect(self, code, *arguments, words=()):
        """Standard error of a call that ends with a code and says some words."""
        with self.subTest(arguments=arguments):
            result = self.vmech(*arguments)
            self.assertEqual(result.returncode, code, result.stdout + result.stderr)
            for word in words:
                self.assertIn(word, result.stderr)
            return result


class CommandLine(InFolder):
    def test_a_word_that_is_nearly_right_is_named(self):
        for arguments, words in (
                (("chek",), ("there is no command 'chek'; did you mean 'check'?",)),
                (("loads2", "x"), ("did you mean 'loads'?",)),
                (("frobnicate",), ("there is no command 'frobnicate'; there are check, loads,",)),
                (("help", "chek"), ("did you mean 'check'?",)),
                (("loads", "s.yaml", "--outt"), ("no option '--outt'; did you mean '--out'?",)),
                (("loads", "--thread=2"), ("no option '--thread'; did you mean '--threads'?",)),
                (("check", "--jsno", "x"), ("did you mean '--json'?",)),
                (("--versoin",), ("did you mean '--version'?",)),
                (("check", "-x", "crank.yaml"), ("no option '-x'",)),
                (("completion", "fish"), ("bash",))):
            self.expect(1, *arguments, words=(*words, "--help"))

    def test_version_and_help_have_their_short_ways(self):
        self.assertEqual(self.vmech("-V").stdout, self.vmech("--version").stdout)
        self.assertEqual(self.vmech("help").stdout, self.vmech("--help").stdout)
        for command in COMMANDS:
            with self.subTest(command=command):
                help_of = self.vmech("help", command)
                self.assertEqual(help_of.returncode, 0, help_of.stderr)
                self.assertEqual(help_of.stdout, self.vmech(command, "--help").stdout)
                self.assertIn("Usage:", help_of.stdout)

    def test_negative_numbers_are_values_and_no_options(self):
        self.expect(0, "ik", "two-link-arm.yaml", "--target", "0.5 0.3 0", "--start", "elbow=-60")


class ExitCodes(InFolder):
    def test_values_of_options_that_mean_nothing_are_code_1(self):
        ik = ("ik", "four-bar.yaml", "--target")
        haptic = ("haptic", "crank.yaml", "--free", "--seconds", "0.1")
        suite = "closed-chains.yaml"
        for arguments in (
                (*ik, "1 2"), (*ik, "1 2 x"), (*ik, "1 2 3 0 0 0 0"),
                (*ik, "1 2 3", "--grasp", "handel"), (*ik, "1 2 3", "--solver", "newton"),
                (*ik, "1 2 3", "--start", "mein=1"), (*ik, "1 2 3", "--start", "main"),
                (*ik, "1 2 3", "--stiffness", "1 2"), (*ik, "1 2 3", "--stiffness", "-1 1 1 1 1 1"),
                (*ik, "1 2 3", "--tolerance", "7"),
                (*haptic, "--grasp", "handel"), (*haptic, "--grip", "iron"),
                (*haptic, "--master", "mouse"), (*haptic, "--master", "udp:host"),
                (*haptic, "--coupling", "glue"), (*haptic, "--rate", "0"),
                ("compare", suite, "--solvers", "nulspace"), ("compare", suite, "--jobs", "-1"),
                ("loads", "four-bar-study.yaml", "--threads", "65"),
                ("export", "crank.yaml", "--out", "crank.dwg"),
                ("check", "crank.yaml", "--tolerance", "x")):
            result = self.expect(1, *arguments, words=("--help",))
            self.assertEqual(result.stdout, "")

    def test_files_that_cannot_be_read_are_code_2_and_named(self):
        absent = "absent.yaml"
        for arguments in (("check", absent), ("loads", absent), ("compare", absent),
                          ("ik", absent, "--target", "0 0 0"), ("haptic", absent),
                          ("replay", absent), ("export", absent, "--out", "x.sdf"),
                          ("haptic", "crank.yaml", "--master", "replay:" + absent),
                          ("haptic", "crank.yaml", "--master", "plugin:./" + absent)):
            self.expect(2, *arguments, words=(absent,))

    def test_files_that_cannot_be_written_are_code_2_and_named(self):
        place = "/proc/vmech"
        self.vmech("haptic", "crank.yaml", "--free", "--seconds", "0.1", "--record", "hand.csv")
        for arguments in (("loads", "four-bar-study.yaml", "--out", place),
                          ("compare", "closed-chains.yaml", "--out", place),
                          ("export", "crank.yaml", "--out", place + "/crank.sdf"),
                          ("haptic", "crank.yaml", "--free", "--seconds", "0.1", "--record",
                           place + "/hand.csv"),
                          ("replay", "hand.csv", "--motion", place + "/motion.csv")):
            self.expect(2, *arguments, words=(place,))

    def test_a_mechanism_that_lacks_what_is_asked_is_code_2(self):
        text = TUBE.split("grasps:")[0]
        self.write("bare.yaml", text)
        self.expect(2, "ik", "bare.yaml", "--target", "0 0 0", words=("bare.yaml", "grasps"))
        self.expect(2, "haptic", "bare.yaml", words=("bare.yaml", "grasps"))

    def test_the_codes_of_the_help_are_those_of_the_manual(self):
        help_text = self.vmech("--help").stdout
        manual = (SOURCES / "docs" / "loads.md").read_text(encoding="utf-8")
        for code in range(6):
            self.assertRegex(help_text, rf"\b{code} [a-z]")
            self.assertRegex(manual, rf"(?m)^\| {code} \| [a-z]")


class WrongKind(InFolder):
    def test_every_command_says_what_a_file_is_and_what_takes_it(self):
        self.vmech("haptic", "crank.yaml", "--free", "--seconds", "0.1", "--record", "hand.csv")
        self.vmech("loads", "four-bar-study.yaml", "--out", "results")
        self.write("part.step", "ISO-10303-21;\nHEADER;\n")
        self.write("arm.urdf", "<robot name='arm'/>\n")
        self.write("loops.yaml", 'vmech_loops: "1.0"\nloops: {}\n')
        self.write("gas.csv", "t,fx\n0,1\n")
        for arguments, words in (
                (("ik", "four-bar-study.yaml", "--target", "0 0 0"),
                 ("is a study, which `vmech loads` runs; `vmech ik` takes a mechanism, such as "
                  "four-bar.yaml, which it names",)),
                (("check", "four-bar-study.yaml"), ("is a study", "vmech loads", "four-bar.yaml")),
                (("check", "closed-chains.yaml"), ("is a suite, which `vmech compare` runs",)),
                (("loads", "closed-chains.yaml"), ("is a suite, which `vmech compare` runs",)),
                (("loads", "crank.yaml"), ("is a mechanism, which `vmech check` reads",
                                           "`vmech loads` takes a study")),
                (("compare", "crank.yaml"), ("is a mechanism", "takes a suite")),
                (("compare", "four-bar-study.yaml"), ("is a study", "takes a suite")),
                (("export", "four-bar-study.yaml", "--out", "x.sdf"), ("is a study",)),
                (("haptic", "closed-chains.yaml"), ("is a suite", "a mechanism or a study")),
                (("haptic", "hand.csv"), ("is a recording, which `vmech replay` runs",)),
                (("replay", "crank.yaml"), ("is a mechanism", "takes a recording")),
                (("check", "results"), ("is a folder of results, whose report.html",)),
                (("loads", "."), ("is a folder",)),
                (("check", "part.step"), ("`vmech import` makes a mechanism",)),
                (("check", "arm.urdf"), ("`vmech import` makes a mechanism",)),
                (("check", "loops.yaml"), ("`vmech import FILE --loops`",)),
                (("loads", "gas.csv"), ("is a table (CSV), which a study names",))):
            result = self.expect(2, *arguments, words=(arguments[1] + ": ", *words))
            self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)

    def test_what_is_wrong_with_the_right_kind_is_still_told(self):
        self.write("bad.yaml", TUBE.replace("mass: 1,", "mass: -1,"))
        self.expect(2, "check", "bad.yaml", words=("bad.yaml:7:", "must not be negative"))


class SeveralFiles(InFolder):
    def test_all_are_checked_and_the_greatest_code_returned(self):
        text = (self.folder / "four-bar.yaml").read_text(encoding="utf-8")
        self.write("open.yaml", text.replace("[1.1, 0, 0]", "[11, 0, 0]"))
        good = self.expect(0, "check", "crank.yaml", "four-bar.yaml")
        self.assertRegex(good.stdout, r"(?s)file +crank\.yaml\n.*file +four-bar\.yaml\n")
        self.assertEqual(good.stdout.count("mobility    1"), 2)
        self.expect(2, "check", "crank.yaml", "absent.yaml", words=("absent.yaml",))
        both = self.expect(3, "check", "absent.yaml", "open.yaml", "crank.yaml",
                           words=("absent.yaml",))
        self.assertIn("NOT ASSEMBLED", both.stdout)
        self.assertRegex(both.stdout, r"file +crank\.yaml\n")

    def test_json_is_one_list_with_names(self):
        result = self.expect(2, "check", "crank.yaml", "absent.yaml", "--json")
        reports = json.loads(result.stdout)
        self.assertEqual([report["file"] for report in reports], ["crank.yaml", "absent.yaml"])
        self.assertEqual(reports[0]["mobility"], 1)
        self.assertIn("absent.yaml", reports[1]["errors"][0])

    def test_denavit_hartenberg_rows_are_printed_where_they_are_asked_for(self):
        self.assertNotIn("Denavit", self.vmech("check", "crank.yaml").stdout)
        self.assertIn("Denavit-Hartenberg", self.vmech("check", "crank.yaml", "--dh").stdout)
        self.assertNotIn("denavit_hartenberg",
                         json.loads(self.vmech("check", "crank.yaml", "--json").stdout))
        table = json.loads(self.vmech("check", "crank.yaml", "--json", "--dh").stdout)
        self.assertEqual(table["denavit_hartenberg"][-1].get("freedom", "rz"), "rz")


class Freedoms(InFolder):
    """A joint with several freedoms names them wherever one is meant."""

    def study(self, motion, name="study.yaml"):
        self.write("tube.yaml", TUBE)
        return self.write(name, 'vmech_study: "1.0"\nmechanism: tube.yaml\n'
                          "units: {length: mm, angle: deg}\nmotion: " + motion + "\n")

    def test_in_studies_tables_and_summaries(self):
        self.study("[{joint: tube, freedom: rz, rpm: 60, turns: 1, steps: 18}, "
                   "{joint: tube, freedom: z, speed: 10}]")
        result = self.expect(0, "loads", "study.yaml", "--out", "out")
        self.assertIn("tube.rz at 60 rpm", result.stdout)
        header = (self.folder / "out" / "loads.csv").read_text().splitlines()[0].split(",")
        for column in ("drive.tube.rz.position", "drive.tube.z.position", "drive.tube.rz.force"):
            self.assertIn(column, header)
        summary = json.loads((self.folder / "out" / "summary.json").read_text())
        self.assertEqual([drive["freedom"] for drive in summary["drives"]], ["rz", "z"])
        page = (self.folder / "out" / "report.html").read_text(encoding="utf-8")
        self.assertIn("Joint tube.rz turns at 60 rpm", page)

    def test_numbers_of_earlier_studies_are_taken_with_the_name(self):
        turning, sliding = ", rpm: 60, turns: 1, steps: 18}", ", speed: 10}"
        for out, turn, slide in (("numbered", 1, 0), ("named", "rz", "z")):
            self.study(f"[{{joint: tube, freedom: {turn}{turning}, "
                       f"{{joint: tube, freedom: {slide}{sliding}]")
            result = self.expect(0, "loads", "study.yaml", "--out", out)
            self.assertIn("tube.rz at 60 rpm", result.stdout)
            self.assertEqual("note: freedom 1 of joint 'tube' is called rz now" in result.stdout,
                             out == "numbered")
        self.assertEqual((self.folder / "numbered" / "loads.csv").read_text(),
                         (self.folder / "named" / "loads.csv").read_text())
        self.study("{joint: tube, freedom: 2, rpm: 60, turns: 1, steps: 18}")
        self.expect(2, "loads", "study.yaml",
                    words=("study.yaml:4:", "freedoms have names", "has z, rz"))
        self.study("{joint: tube, rpm: 60, turns: 1, steps: 18}")
        self.expect(2, "loads", "study.yaml", words=("a cylindrical joint has z, rz",))
        self.study("{joint: tube, freedom: ry, rpm: 60, turns: 1, steps: 18}")
        self.expect(2, "loads", "study.yaml", words=("no freedom 'ry'",))

    def test_in_ik_and_check(self):
        self.write("tube.yaml", TUBE)
        answer = self.expect(0, "ik", "tube.yaml", "--target", "0 100 30 0 0 90", "--start",
                             "tube.rz=80", "--json")
        joint = json.loads(answer.stdout)["joints"][0]
        self.assertEqual(joint["coordinates"], ["z", "rz"])
        self.assertAlmostEqual(joint["values"][0], 0.03, 9)
        self.assertAlmostEqual(joint["values"][1], 1.5707963267948966, 9)
        text = self.vmech("ik", "tube.yaml", "--target", "0 100 30 0 0 90").stdout
        self.assertRegex(text, r"tube +z [\d.]+ mm, rz [\d.]+ deg")
        self.assertRegex(self.vmech("check", "tube.yaml").stdout, r"z 0 mm, rz 0 deg")
        for start, words in (("tube=3", ("has z, rz", "--start tube.z=30")),
                             ("tube.x=3", ("no joint 'tube.x'; did you mean 'tube.",))):
            self.expect(1, "ik", "tube.yaml", "--target", "0 0 0", "--start", start, words=words)


class Bearings(InFolder):
    def study(self, bearings):
        text = (self.folder / "slider-crank-study.yaml").read_text(encoding="utf-8")
        self.write("study.yaml", text.split("bearings:")[0] + "bearings:\n  " + bearings + "\n")
        result = self.vmech("loads", "study.yaml", "--out", "out")
        summary = json.loads((self.folder / "out" / "summary.json").read_text())["bearings"][0]
        page = (self.folder / "out" / "report.html").read_text(encoding="utf-8")
        return result, summary, page

    MAIN = "main: {positions: [-15, 15], shaft: [15, 30], housing: 60, life_hours: 10000"

    def test_a_pair_lives_as_long_as_is_asked_of_it(self):
        result, each, page = self.study(self.MAIN + ", pair_life_hours: 0}")
        self.assertEqual(result.returncode, 0)
        asked = 1.5 * each["system_life_hours"]
        result, pair, page = self.study(f"{self.MAIN}, pair_life_hours: {asked}}}")
        self.assertEqual(result.returncode, 0, result.stdout)
        self.assertTrue(pair["met"])
        self.assertGreaterEqual(pair["system_life_hours"], asked)
        lives = [position["life_hours"] for position in pair["positions"]]
        self.assertAlmostEqual(sum(life ** (-10 / 9) for life in lives) ** -0.9,
                               pair["system_life_hours"], delta=1e-9 * asked)
        self.assertNotIn('class="notice bad"', page)

    def test_a_pair_that_is_short_is_code_4_and_red(self):
        result, pair, page = self.study(self.MAIN + ", pair_life_hours: 1000000000}")
        self.assertEqual(result.returncode, 4)
        self.assertTrue(pair["complete"])
        self.assertFalse(pair["met"])
        self.assertIn("TOO SHORT", result.stdout)
        self.assertIn("both bearings together reach", result.stdout)
        self.assertRegex(page, r'class="notice bad"[^<]*(<[^>]*>)*Both together')

    def test_a_catalogue_states_the_kind_of_every_row(self):
        self.write("own.csv", "designation,d_mm,D_mm,B_mm,C_kN,C0_kN,f0\n6004,20,42,12,9,5,14\n")
        text = (self.folder / "slider-crank-study.yaml").read_text(encoding="utf-8")
        self.write("study.yaml", text + "catalogue: own.csv\n")
        self.expect(2, "loads", "study.yaml", words=("own.csv:1: column 'kind' is missing",))


class Reports(InFolder):
    def test_numbers_are_the_same_on_terminal_and_page(self):
        text = (self.folder / "slider-crank-study.yaml").read_text(encoding="utf-8")
        self.write("heavy.yaml", text.replace("rpm: 1500", "rpm: 15000"))
        result = self.vmech("loads", "heavy.yaml", "--out", "out")
        page = (self.folder / "out" / "report.html").read_text(encoding="utf-8")
        largest = re.search("(?m)^  main +([0-9\u202f]+)", result.stdout).group(1)
        self.assertIn("\u202f", largest)  # thousands are apart
        self.assertIn(f">{largest}<", page)

    def test_angles_stay_within_a_turn_and_dead_centres_are_marked(self):
        text = (self.folder / "slider-crank.yaml").read_text(encoding="utf-8")
        self.assertIn("start: 40", text)
        self.write("far.yaml", text.replace("start: 40", "start: 3640"))
        self.write("study.yaml", 'vmech_study: "1.0"\nmechanism: far.yaml\n'
                   "motion: {joint: main, rpm: 60, turns: 2, steps: 720}\n")
        result = self.expect(0, "loads", "study.yaml", "--out", "out")
        # The crank and the rod of a slider-crank without offset are in line at 0 and 180 degrees.
        self.assertIn("dead centres: guide turns back at 0° and 180.0°",
                      result.stdout.replace("180°", "180.0°"))
        summary = json.loads((self.folder / "out" / "summary.json").read_text())
        angles = [centre["angle"] for centre in summary["dead_centres"]]
        self.assertEqual([centre["joint"] for centre in summary["dead_centres"]], ["guide"] * 2)
        self.assertAlmostEqual(angles[0], 0, 5)
        self.assertAlmostEqual(angles[1], 3.141592653589793, 5)
        page = (self.folder / "out" / "report.html").read_text(encoding="utf-8")
        shown = {int(angle) for angle in re.findall(r">(\d+)°", page)}
        self.assertTrue(shown)
        self.assertLessEqual(max(shown), 360)
        self.assertIn(">dead centre<", page)

    def test_partly_determined_is_only_what_a_load_reaches(self):
        study = ('vmech_study: "1.0"\nmechanism: four-bar.yaml\n'
                 "motion: {joint: main, rpm: 60, turns: 1, steps: 36}\n")
        self.write("flat.yaml", study)
        self.write("tilted.yaml", study + "external: [{link: coupler, force: [0, 0, 50]}]\n")
        flat = self.expect(0, "loads", "flat.yaml", "--out", "flat")
        page = (self.folder / "flat" / "report.html").read_text(encoding="utf-8")
        self.assertNotIn("partly determined", page)
        self.assertIn("zero by every rule", page)
        self.assertNotIn("not determined by statics", flat.stdout)
        tilted = self.expect(0, "loads", "tilted.yaml", "--out", "tilted")
        page = (self.folder / "tilted" / "report.html").read_text(encoding="utf-8")
        self.assertIn("partly determined", page)
        self.assertIn("not determined by statics: fz", tilted.stdout)
        for name in ("flat", "tilted"):  # what statics says does not depend on the load
            rows = (self.folder / name / "certainty.csv").read_text()
            self.assertIn("main,fz,not determined by statics", rows)


class Completion(InFolder):
    def complete(self, *words):
        """What a bash offers behind words, the last of which is being typed."""
        script = self.vmech("completion", "bash").stdout
        line = " ".join(f"'{word}'" for word in words)
        program = (f"{script}\nCOMP_WORDS=({line})\nCOMP_CWORD={len(words) - 1}\n"
                   f"_vmech '{VMECH}' '{words[-1]}' '{words[-2]}'\n"
                   'printf "%s\\n" "${COMPREPLY[@]}"\ncomplete -p vmech\n')
        result = subprocess.run(["bash", "-c", program], cwd=self.folder, capture_output=True,
                                text=True, timeout=60, check=False,
                                env={**os.environ, "LC_ALL": "C.UTF-8"})
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        *offers, registered = result.stdout.splitlines()
        self.assertEqual(registered, "complete -o default -F _vmech vmech")
        return [offer for offer in offers if offer]

    def test_commands_options_and_choices(self):
        self.assertLessEqual(set(COMMANDS), set(self.complete("vmech", "")))
        self.assertEqual(self.complete("vmech", "che"), ["check"])
        self.assertEqual(self.complete("vmech", "help", "loa"), ["loads"])
        self.assertEqual(self.complete("vmech", "loads", "--thr"), ["--threads"])
        self.assertLessEqual({"-q", "--quiet", "--out"},
                             set(self.complete("vmech", "loads", "-")))
        self.assertIn("--loops", self.complete("vmech", "import", "--lo"))
        self.assertEqual(self.complete("vmech", "haptic", "--coupling", ""), ["virtual", "paper"])
        self.assertEqual(self.complete("vmech", "ik", "--solver", "nulls"), ["nullspace"])
        self.assertEqual(self.complete("vmech", "completion", ""), ["bash"])

    def test_files_are_left_to_bash(self):
        self.assertEqual(self.complete("vmech", "check", "slider"), [])
        self.assertEqual(self.complete("vmech", "loads", "--out", ""), [])


if __name__ == "__main__":
    VMECH, EXAMPLES = (pathlib.Path(argument).resolve() for argument in sys.argv[1:])
    unittest.main(argv=sys.argv[:1])
