"""haptic_test.py VMECH EXAMPLES: vmech haptic and vmech replay as their users meet them."""

import csv
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

import mcap_reader

VMECH = ""
EXAMPLES = pathlib.Path()

MECHANISMS = ("crank", "two-link-arm", "slider-crank", "four-bar", "rssr", "bennett",
              "stewart-gough")
TIMES = ("late", "interval", "compute")


class Haptic(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="vmech-"))
        self.addCleanup(shutil.rmtree, self.folder)

    def run_vmech(self, *arguments, code=0):
        result = subprocess.run([VMECH, *map(str, arguments)], cwd=self.folder, text=True,
                                capture_output=True, stdin=subprocess.DEVNULL, timeout=120)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return result

    def hold(self, name, *options, code=0):
        return self.run_vmech("haptic", EXAMPLES / f"{name}.yaml", "--grasp", "handle", "--free",
                              *options, code=code)

    @staticmethod
    def outcome(report):
        """What does not depend on the machine and its clock."""
        return [line for line in report.splitlines()
                if not line.strip().startswith((*TIMES, "recorded"))]

    def test_every_example_is_held_to_the_end(self):
        for name in MECHANISMS:
            with self.subTest(name=name):
                report = self.hold(name, "--seconds", 2).stdout
                self.assertIn("finished after 2000 ticks", report)
                self.assertIn("virtual coupling", report)
                self.assertEqual("what this device can render" in report, name == "stewart-gough")

    def test_paper_coupling_names_its_share_of_the_inertia(self):
        report = self.hold("slider-crank", "--seconds", 1, "--coupling", "paper").stdout
        self.assertIn("felt up to", report)
        self.assertIn("largest force at guide", report)

    def test_gripper_takes_hold_twice_in_six_seconds(self):
        report = self.hold("crank", "--seconds", 6, "--gripper").stdout
        self.assertIn("2 grasps", report)

    def test_replay_gives_the_same_report(self):
        for options in ((), ("--coupling", "paper"), ("--gripper", "--scale", 0.5)):
            with self.subTest(options=options):
                first = self.hold("four-bar", "--seconds", 2, "--record", "hand.csv", "--force",
                                  *options)
                again = self.run_vmech("replay", "hand.csv")
                self.assertEqual(self.outcome(again.stdout), self.outcome(first.stdout))

    def test_a_recording_is_audited_and_says_what_was_felt(self):
        self.hold("slider-crank", "--seconds", 6, "--grip", "firm", "--record", "hand.csv")
        report = self.run_vmech("replay", "hand.csv", "--audit").stdout
        self.assertIn("verdict: sound", report)
        self.assertIn("inertia was felt as promised", report)
        rows = (self.folder / "hand.csv").read_text(encoding="utf-8").splitlines()
        middle = len(rows) - 3000
        cells = rows[middle].split(",")
        names = next(row for row in rows if row.startswith("sequence")).split(",")
        place = next(i for i, name in enumerate(names) if name.startswith("velocity"))
        cells[place] = str(float(cells[place]) + 0.01)
        rows[middle] = ",".join(cells)
        (self.folder / "hand.csv").write_text("\n".join(rows) + "\n", encoding="utf-8")
        report = self.run_vmech("replay", "hand.csv", "--audit", code=3).stdout
        self.assertIn("NOT SOUND", report)

    def test_a_recording_in_mcap_is_whole_and_the_same(self):
        self.hold("four-bar", "--seconds", 1, "--record", "hand.csv")
        self.run_vmech("replay", "hand.csv", "--record", "hand.mcap", "--quiet")
        messages, metadata, attachments = mcap_reader.read(
            (self.folder / "hand.mcap").read_bytes())
        self.assertEqual(len(messages["vmech/tick"]), 1000)
        self.assertEqual(len(messages["tf"]), 50)
        self.assertEqual(metadata["vmech end"], {"ticks": "1000", "lost": "0"})
        self.assertEqual(metadata["vmech recording"]["period"], "0.001")
        self.assertIn(b"vmech:", attachments["mechanism.yaml"][1])
        with open(self.folder / "hand.csv", newline="", encoding="utf-8") as file:
            table = list(csv.DictReader(line for line in file if not line.startswith("#")))
        times = ("late_ns", "compute_ns")
        for row, (_, message) in zip(table, messages["vmech/tick"]):
            tick = json.loads(message)
            self.assertEqual(list(tick), list(row))
            for name, value in tick.items():
                if name in times:
                    continue
                if isinstance(value, str):
                    self.assertEqual(value, row[name])
                else:
                    self.assertEqual(float(value), float(row[name]), name)
        self.assertIn("sound", self.run_vmech("replay", "hand.mcap", "--audit").stdout)

    def test_options_that_mean_nothing_are_refused_by_name(self):
        for options, word in ((("--seconds", "nan"), "--seconds: 'nan'"),
                              (("--scale", "nan"), "--scale: 'nan'"),
                              (("--home", "a,b,c"), "--home: 'a'"),
                              (("--stiffness", 100), "--coupling paper"),
                              (("--estimator", "kalman"), "--coupling paper"),
                              (("--motion-scale", 0.01), "--motion-scale: makes"),
                              (("--master", "udp:localhost:9"), "this machine is 127.0.0.1"),
                              (("--master", "plugin:"), "plugin:LIBRARY"),
                              (("--force",), "--record")):
            with self.subTest(options=options):
                said = self.run_vmech("haptic", EXAMPLES / "crank.yaml", "--free", *options, code=1)
                self.assertIn(word, said.stderr)

    def test_an_old_recording_is_not_written_over(self):
        (self.folder / "hand.csv").write_text("precious", encoding="utf-8")
        error = self.hold("crank", "--seconds", 0.1, "--record", "hand.csv", code=2).stderr
        self.assertIn("--force", error)
        self.assertEqual((self.folder / "hand.csv").read_text(encoding="utf-8"), "precious")
        self.hold("crank", "--seconds", 0.1, "--record", "hand.csv", "--force")
        self.run_vmech("replay", "hand.csv", "--record", "hand.csv", "--force", code=2)
        self.run_vmech("replay", "hand.csv", "--audit")

    def test_a_full_disk_ends_the_session_at_once(self):
        error = self.hold("crank", "--seconds", 1e6, "--record", "/dev/full", code=2).stderr
        self.assertIn("No space left on device", error)

    def test_a_killed_session_leaves_all_but_its_last_second(self):
        for name in ("hand.csv", "hand.mcap"):
            with self.subTest(name=name):
                command = [VMECH, "haptic", EXAMPLES / "crank.yaml", "--seconds", "1000",
                           "--record", name, "--quiet"]
                with subprocess.Popen(command, cwd=self.folder) as session:
                    deadline = time.monotonic() + 60
                    while time.monotonic() < deadline:
                        time.sleep(0.1)
                        file = self.folder / name
                        if file.exists() and file.stat().st_size > 3_000_000:
                            break
                    session.kill()
                report = self.run_vmech("replay", name, "--audit").stdout
                self.assertIn("cut short", report)
                self.assertIn("verdict: sound", report)

    def test_recorded_hand_moves_a_study(self):
        self.hold("slider-crank", "--seconds", 1, "--record", "hand.csv", "--quiet")
        self.run_vmech("replay", "hand.csv", "--quiet", "--motion", "motion.csv")
        with open(self.folder / "motion.csv", newline="", encoding="utf-8") as file:
            rows = list(csv.reader(file))
        self.assertEqual(rows[0], ["t", "x", "y", "z", "qw", "qx", "qy", "qz"])
        self.assertEqual(len(rows), 1001)
        shutil.copy(EXAMPLES / "slider-crank.yaml", self.folder)
        study = self.folder / "study.yaml"
        study.write_text('vmech_study: "1.0"\nmechanism: slider-crank.yaml\n'
                         'units: {length: m, angle: rad}\n'
                         'motion: {grasp: handle, table: motion.csv}\n', encoding="utf-8")
        self.run_vmech("haptic", "study.yaml", "--free", "--seconds", 0.5)

    def test_replay_refuses_what_is_no_recording_of_a_session(self):
        self.assertIn("cannot be opened", self.run_vmech("replay", "absent.csv", code=2).stderr)
        (self.folder / "table.csv").write_text("t,x\n0,1\n", encoding="utf-8")
        self.assertIn("table.csv: is a table", self.run_vmech("replay", "table.csv", code=2).stderr)
        self.hold("crank", "--seconds", 0.1, "--record", "hand.csv", "--quiet")
        text = (self.folder / "hand.csv").read_text(encoding="utf-8")
        bare = "".join(line for line in text.splitlines(keepends=True) if "note" not in line)
        (self.folder / "bare.csv").write_text(bare, encoding="utf-8")
        self.assertIn("what was held", self.run_vmech("replay", "bare.csv", code=2).stderr)
        damaged = text.replace("# note scale 0", "# note scale much")
        (self.folder / "damaged.csv").write_text(damaged, encoding="utf-8")
        self.assertIn("note scale much", self.run_vmech("replay", "damaged.csv", code=2).stderr)

    def test_wrong_words_are_code_1_or_2(self):
        self.assertIn("coupling", self.hold("crank", "--coupling", "glue", code=1).stderr)
        self.assertIn("grip", self.hold("crank", "--grip", "iron", code=1).stderr)
        self.assertIn("--master: 'mouse'", self.hold("crank", "--master", "mouse", code=1).stderr)


if __name__ == "__main__":
    VMECH, EXAMPLES = (pathlib.Path(argument).resolve() for argument in sys.argv[1:])
    unittest.main(argv=sys.argv[:1])
