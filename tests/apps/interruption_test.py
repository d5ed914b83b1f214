"""interruption_test.py VMECH EXAMPLES INTERRUPT_CALLS: result folders, whatever happens.

INTERRUPT_CALLS is a library that ends a program at a call that changes files, or lets its disk be
full (interrupt_calls.cc)."""

import csv
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

VMECH = ""
EXAMPLES = pathlib.Path()
INTERRUPT_CALLS = pathlib.Path()

LOADS = ("loads.csv", "motion.csv", "joints.csv", "certainty.csv", "bearings.csv", "summary.json",
         "report.html")
COMPARISON = ("results.csv", "summary.json", "report.html")
MOST_CALLS = 200

SUITE = """vmech_suite: "1.0"
repetitions: 1
targets: {near: {kind: reachable, count: 2}}
mechanisms:
  four-bar: {file: four-bar.yaml, grasp: {link: coupler}}
"""


def contents(folder, names):
    return {name: (folder / name).read_bytes() for name in names if (folder / name).exists()}


class Interrupted(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="vmech-"))
        self.addCleanup(shutil.rmtree, self.folder)
        for source in EXAMPLES.glob("four-bar*.yaml"):
            shutil.copy(source, self.folder)
        self.edit("four-bar-study.yaml", "old.yaml", r"steps: \d+", "steps: 40")
        self.edit("four-bar-study.yaml", "new.yaml", r"steps: \d+", "steps: 30")
        (self.folder / "suite.yaml").write_text(SUITE, encoding="utf-8")

    def edit(self, source, name, passage, replacement):
        text = (self.folder / source).read_text(encoding="utf-8")
        self.assertRegex(text, passage)
        (self.folder / name).write_text(re.sub(passage, replacement, text), encoding="utf-8")

    def run_vmech(self, *arguments, cwd=None, **variables):
        environment = dict(os.environ)
        if variables:
            # Sanitizers want to be first; here they need not be.
            options = os.environ.get("ASAN_OPTIONS", "") + ":verify_asan_link_order=0"
            environment.update(variables, LD_PRELOAD=str(INTERRUPT_CALLS), ASAN_OPTIONS=options)
        return subprocess.run([VMECH, *arguments], cwd=cwd or self.folder, env=environment,
                              capture_output=True, text=True, stdin=subprocess.DEVNULL, timeout=300)

    def succeed(self, *arguments, **options):
        result = self.run_vmech(*arguments, **options)
        self.assertEqual(result.returncode, 0, result.stderr)

    @staticmethod
    def wait_for(path):
        end = time.monotonic() + 60
        while not path.exists() and time.monotonic() < end:
            time.sleep(0.005)

    def visible_entries(self):
        """All there is but files of the test, none of it hidden."""
        entries = [path for path in self.folder.rglob("*") if path.suffix != ".yaml"]
        self.assertEqual([path for path in entries if path.name.startswith(".")], [])
        return sorted(str(path.relative_to(self.folder)) for path in entries)

    def add_files_of_the_user(self, folder):
        (folder / "notes.txt").write_text("mine", encoding="utf-8")
        (folder / "figures").mkdir()
        (folder / "figures" / "one.svg").write_text("drawn", encoding="utf-8")
        return (folder / "notes.txt").stat().st_ino, (folder / "figures").stat().st_ino

    def expect_files_of_the_user(self, folder, inodes):
        self.assertEqual((folder / "notes.txt").read_text(encoding="utf-8"), "mine")
        self.assertEqual((folder / "figures" / "one.svg").read_text(encoding="utf-8"), "drawn")
        found = (folder / "notes.txt").stat().st_ino, (folder / "figures").stat().st_ino
        self.assertEqual(found, inodes)

    def expect_one_of(self, folder, names, *sets):
        self.assertIn(contents(folder, names), sets)

    def kill_at_every_call(self, *command, after_each, cwd=None):
        """Runs the command until no call is left at which it could be killed."""
        for call in range(1, MOST_CALLS):
            result = self.run_vmech(*command, cwd=cwd, VMECH_KILL_AT=str(call))
            if result.returncode == 0:
                self.assertGreater(call, 10)
                return
            self.assertEqual(result.returncode, -signal.SIGKILL, result.stderr)
            after_each(call)
        self.fail("there is no end of calls")


class Loads(Interrupted):
    def both_sets(self):
        self.succeed("loads", "old.yaml", "--out", "old")
        self.succeed("loads", "new.yaml", "--out", "new")
        old, new = contents(self.folder / "old", LOADS), contents(self.folder / "new", LOADS)
        self.assertEqual((len(old), len(new)), (7, 7))
        self.assertNotEqual(old["loads.csv"], new["loads.csv"])
        return old, new

    def test_killed_anywhere_leave_the_old_set_or_the_new_one(self):
        old, new = self.both_sets()
        out = self.folder / "out"
        seen = set()

        def look(_):
            self.visible_entries()
            self.expect_one_of(out, LOADS, old, new)
            seen.add(contents(out, LOADS) == new)
            self.assertEqual((out / "notes.txt").read_text(encoding="utf-8"), "mine")
            self.succeed("loads", "old.yaml", "--out", "out")
            self.assertEqual(contents(out, LOADS), old)
            self.expect_files_of_the_user(out, inodes)
            self.assertEqual(len(list(self.folder.glob("out*"))), 1)

        self.succeed("loads", "old.yaml", "--out", "out")
        inodes = self.add_files_of_the_user(out)
        self.kill_at_every_call("loads", "new.yaml", "--out", "out", after_each=look)
        self.assertEqual(seen, {False, True})
        self.assertEqual(contents(out, LOADS), new)

    def test_killed_anywhere_leave_all_of_a_first_set_or_no_folder(self):
        _, new = self.both_sets()
        out = self.folder / "there" / "out"

        def look(_):
            self.visible_entries()
            if out.exists():
                self.expect_one_of(out, LOADS, new)
            self.succeed("loads", "new.yaml", "--out", "there/out")
            self.assertEqual([path.name for path in out.parent.iterdir()], ["out"])
            shutil.rmtree(out.parent)

        self.kill_at_every_call("loads", "new.yaml", "--out", "there/out", after_each=look)

    def test_in_the_current_folder_never_mix_two_sets(self):
        old, new = self.both_sets()
        out = self.folder / "out"

        def look(_):
            self.visible_entries()
            found = contents(out, LOADS)
            self.assertTrue(found.items() <= old.items() or found.items() <= new.items(), found)
            self.succeed("loads", "../old.yaml", "--out", ".", cwd=out)
            self.assertEqual(contents(out, LOADS), old)
            self.expect_files_of_the_user(out, inodes)
            self.assertEqual(len(list(out.iterdir())), len(LOADS) + 2)

        self.succeed("loads", "old.yaml", "--out", "out")
        inodes = self.add_files_of_the_user(out)
        place = out.stat().st_ino
        self.kill_at_every_call("loads", "../new.yaml", "--out", ".", cwd=out, after_each=look)
        self.assertEqual(contents(out, LOADS), new)
        self.assertEqual(out.stat().st_ino, place)

    def test_on_a_full_disk_leave_the_old_set_and_say_so(self):
        self.succeed("loads", "old.yaml", "--out", "out")
        inodes = self.add_files_of_the_user(self.folder / "out")
        old, before = contents(self.folder / "out", LOADS), self.visible_entries()
        for write in range(1, len(LOADS) + 1):
            result = self.run_vmech("loads", "new.yaml", "--out", "out", VMECH_FULL_AT=str(write))
            self.assertEqual(result.returncode, 2)
            self.assertRegex(result.stderr, r"^out/[a-z]+\.\w+: cannot be written: No space left")
            self.assertEqual(self.visible_entries(), before)
            self.assertEqual(contents(self.folder / "out", LOADS), old)
        self.expect_files_of_the_user(self.folder / "out", inodes)
        result = self.run_vmech("loads", "new.yaml", "--out", "a/b", VMECH_FULL_AT="3")
        self.assertEqual(result.returncode, 2)
        self.assertEqual(self.visible_entries(), before)

    def test_two_at_once_are_one_and_a_refusal_that_names_it(self):
        self.edit("four-bar-study.yaml", "long.yaml", r"steps: \d+", "steps: 300000")
        self.succeed("loads", "old.yaml", "--out", "there")
        for out in ("there", "first"):
            running = subprocess.Popen([VMECH, "loads", "long.yaml", "--out", out, "--quiet"],
                                       cwd=self.folder, stdout=subprocess.DEVNULL)
            self.addCleanup(running.wait)
            self.addCleanup(running.kill)
            stage = self.folder / (out + ".vmech-unfinished")
            self.wait_for(stage)
            result = self.run_vmech("loads", "new.yaml", "--out", out)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertIn(f"{out}: another vmech (process {running.pid}) is writing here",
                          result.stderr)
            running.kill()
            running.wait()
            self.succeed("loads", "new.yaml", "--out", out)
        self.assertEqual({path.name for path in self.folder.iterdir() if path.suffix != ".yaml"},
                         {"there", "first"})


    def test_interrupted_leave_nothing(self):
        self.edit("four-bar-study.yaml", "long.yaml", r"steps: \d+", "steps: 300000")
        self.succeed("loads", "old.yaml", "--out", "there")
        before = self.visible_entries()
        for out in ("there", "new/out"):
            for interrupt in (signal.SIGINT, signal.SIGTERM):
                running = subprocess.Popen([VMECH, "loads", "long.yaml", "--out", out],
                                           cwd=self.folder, stdout=subprocess.DEVNULL)
                self.addCleanup(running.kill)
                self.wait_for(self.folder / (out + ".vmech-unfinished"))
                running.send_signal(interrupt)
                self.assertEqual(running.wait(), -interrupt)
                self.assertEqual(self.visible_entries(), before)


class Comparison(Interrupted):
    def compare(self, *solvers, **options):
        return self.run_vmech("compare", "suite.yaml", "--out", "out", "--jobs", "2", "--solvers",
                              ",".join(solvers), **options)

    def solvers_of_the_set(self):
        """By results.csv, summary.json and report.html; these must agree."""
        out = self.folder / "out"
        if not any((out / name).exists() for name in COMPARISON):
            return None
        with open(out / "results.csv", newline="", encoding="utf-8") as file:
            by_rows = sorted({row["solver"] for row in csv.DictReader(file)})
        summary = json.loads((out / "summary.json").read_text(encoding="utf-8"))
        page = (out / "report.html").read_text(encoding="utf-8")
        on_page = [name for name in ("nullspace", "penalty") if name in page]
        self.assertEqual(sorted(summary["solvers"]), by_rows)
        self.assertEqual(on_page, by_rows)
        return by_rows

    def test_killed_anywhere_leaves_one_set_and_goes_on(self):
        self.assertEqual(self.compare("penalty").returncode, 0)
        out, start = self.folder / "out", self.folder / "start"
        self.add_files_of_the_user(out)
        shutil.copytree(out, start)
        seen = []

        def look(_):
            self.visible_entries()
            seen.append(self.solvers_of_the_set())
            rows = (out / "rows.jsonl").read_bytes()
            self.assertTrue(rows.startswith((start / "rows.jsonl").read_bytes()))
            result = self.compare("penalty", "nullspace")
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertTrue((out / "rows.jsonl").read_bytes().startswith(rows[:rows.rfind(b"\n")]))
            self.assertEqual(self.solvers_of_the_set(), ["nullspace", "penalty"])
            self.assertEqual((out / "notes.txt").read_text(encoding="utf-8"), "mine")
            self.assertTrue((out / "figures" / "one.svg").exists())
            self.assertEqual(len(list(self.folder.glob("out*"))), 1)
            shutil.rmtree(out)
            shutil.copytree(start, out)

        self.kill_at_every_call("compare", "suite.yaml", "--out", "out", "--jobs", "2",
                                "--solvers", "penalty,nullspace", after_each=look)
        self.assertIn(["penalty"], seen)
        self.assertIn(["nullspace", "penalty"], seen)

    def test_killed_anywhere_in_a_first_run_leaves_no_part_of_a_set(self):
        def look(_):
            self.visible_entries()
            self.assertIn(self.solvers_of_the_set(), (None, ["penalty"]))
            self.assertEqual(self.compare("penalty").returncode, 0)
            self.assertEqual({path.name for path in (self.folder / "out").iterdir()},
                             {*COMPARISON, "rows.jsonl"})
            shutil.rmtree(self.folder / "out")

        self.kill_at_every_call("compare", "suite.yaml", "--out", "out", "--solvers", "penalty",
                                after_each=look)

    def test_on_a_full_disk_leaves_the_old_set_and_goes_on(self):
        self.assertEqual(self.compare("penalty").returncode, 0)
        out, start = self.folder / "out", self.folder / "start"
        shutil.copytree(out, start)
        failures = 0
        for write in range(1, MOST_CALLS):
            result = self.compare("penalty", "nullspace", VMECH_FULL_AT=str(write))
            if result.returncode == 0:
                break
            failures += 1
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertIn("No space left on device", result.stderr)
            self.assertEqual(self.solvers_of_the_set(), ["penalty"])
            self.assertEqual(len(list(self.folder.glob("out*"))), 1)
            shutil.rmtree(out)
            shutil.copytree(start, out)
        self.assertGreater(failures, len(COMPARISON))
        self.assertEqual(self.solvers_of_the_set(), ["nullspace", "penalty"])

    def test_and_loads_do_not_share_a_folder(self):
        self.assertEqual(self.compare("penalty").returncode, 0)
        self.succeed("loads", "old.yaml", "--out", "loads")
        before = self.visible_entries()
        for command in (("loads", "new.yaml", "--out", "out"),
                        ("compare", "suite.yaml", "--out", "loads", "--solvers", "penalty")):
            result = self.run_vmech(*command)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertIn("must not be mixed", result.stderr)
        self.assertEqual(self.visible_entries(), before)


if __name__ == "__main__":
    VMECH, EXAMPLES, INTERRUPT_CALLS = (pathlib.Path(a).resolve() for a in sys.argv[1:])
    unittest.main(argv=sys.argv[:1])
