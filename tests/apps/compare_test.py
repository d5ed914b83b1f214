"""compare_test.py VMECH EXAMPLES: vmech compare as its users meet it."""

import csv
import json
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
import xml.etree.ElementTree

VMECH = ""
EXAMPLES = pathlib.Path()

SUITE = """vmech_suite: "1.0"
seed: 7
repetitions: 1
stopping: {constraint_tolerance: 1e-10, optimality_tolerance: 1e-8, max_iterations: 100}
targets:
  near:        {kind: reachable, count: 5}
  far:         {kind: reachable, start: far, count: 5}
  unreachable: {kind: unreachable, count: 4}
  dead_centre: {kind: dead_centre, count: 2, steps: 10}
  tracking:    {kind: tracking, count: 2, steps: 10}
mechanisms:
  slider-crank: {file: slider-crank.yaml, grasp: handle}
  rssr:         {file: rssr.yaml, grasp: handle, targets: [near, far, unreachable, tracking]}
"""
SOLVERS = "penalty,augmented_lagrangian,nullspace"
PROBLEMS = 2 * (5 + 5 + 4 + 2) + 2


class Compare(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="vmech-"))
        self.addCleanup(shutil.rmtree, self.folder)
        for source in EXAMPLES.glob("*.yaml"):
            shutil.copy(source, self.folder)
        self.write("suite.yaml", SUITE)

    def write(self, name, text):
        (self.folder / name).write_text(text, encoding="utf-8")

    def compare(self, *arguments, solvers=SOLVERS, before=()):
        command = [*before, VMECH, "compare", "suite.yaml", *arguments]
        if solvers:
            command += ["--solvers", solvers]
        return subprocess.run(command, cwd=self.folder, capture_output=True, text=True,
                              stdin=subprocess.DEVNULL, timeout=300)

    def rows(self, folder="suite-compare"):
        with open(self.folder / folder / "results.csv", newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def untimed(self, folder):
        return [{key: row[key] for key in row if key != "time"} for row in self.rows(folder)]

    def expect_same(self, *folders):
        first = self.untimed(folders[0])
        self.assertEqual(len(first), 3 * PROBLEMS)
        for folder in folders[1:]:
            self.assertEqual(self.untimed(folder), first)

    def test_gives_one_row_per_problem_and_solver(self):
        result = self.compare()
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stderr, "")
        rows = self.rows()
        names = [(row["mechanism"], row["block"], row["index"], row["solver"]) for row in rows]
        self.assertEqual(len(set(names)), 3 * PROBLEMS)
        self.assertEqual([row["solver"] for row in rows[:3]], SOLVERS.split(","))
        for row in rows:
            self.assertGreater(int(row["evaluations"]), 0)
            self.assertGreater(float(row["time"]), 0)
            if row["solver"] == "nullspace" and row["block"] == "near":
                self.assertEqual(row["verdict"], "solved", row)
                self.assertEqual(row["branch"], "own", row)
            if row["solver"] == "nullspace" and row["kind"] == "unreachable":
                self.assertEqual(row["verdict"], "unreachable", row)

    def test_sums_up_the_rows_in_json_and_on_a_page(self):
        result = self.compare()
        self.assertIn("written to suite-compare/report.html", result.stdout)
        folder = self.folder / "suite-compare"
        summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
        self.assertEqual(summary["seed"], 7)
        self.assertEqual(list(summary["solvers"]), SOLVERS.split(","))
        near = summary["solvers"]["nullspace"]["near"]
        self.assertEqual((near["problems"], near["succeeded"], near["own_branch"]), (10, 10, 10))
        path = summary["solvers"]["augmented_lagrangian"]["tracking"]
        self.assertEqual((path["targets"], path["reached"], path["jumps"]), (40, 40, 0))
        page = xml.etree.ElementTree.parse(folder / "report.html").getroot()
        text = "".join(page.itertext())
        for words in ("Who solves what", "Performance profiles", "Accuracy", "Failures",
                      "slider-crank", "the constraints stay open by multiplier / lambda^2"):
            self.assertIn(words, text)
        self.assertEqual(self.compare("--quiet").stdout, "")

    def test_gives_the_same_rows_whatever_the_number_of_jobs(self):
        for jobs in ("1", "2", "5"):
            self.assertEqual(self.compare("--jobs", jobs, "--out", "out" + jobs).returncode, 0)
        self.expect_same("out1", "out2", "out5")

    def test_gives_the_same_rows_under_mpirun(self):
        mpirun = shutil.which("mpirun")
        if not mpirun:
            self.skipTest("mpirun is not installed")
        before = [mpirun, "--allow-run-as-root", "--oversubscribe", "-n", "3"]
        result = self.compare("--out", "mpi", before=before)
        if "built without MPI" in result.stderr:
            self.skipTest("vmech was built without MPI")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.compare("--out", "alone")
        self.expect_same("alone", "mpi")

    def test_loses_nothing_when_it_is_killed(self):
        self.compare("--out", "whole")
        rows = self.folder / "cut" / "rows.jsonl"
        kills = 0
        for _ in range(60):
            process = subprocess.Popen([VMECH, "compare", "suite.yaml", "--out", "cut", "--solvers",
                                        SOLVERS], cwd=self.folder, stdout=subprocess.DEVNULL)
            before = rows.read_bytes() if rows.exists() else b""
            time.sleep(0.015)
            process.send_signal(signal.SIGKILL)
            kills += process.wait() == -signal.SIGKILL
            if not rows.exists():
                continue
            whole = before[:before.rfind(b"\n") + 1]
            self.assertTrue(rows.read_bytes().startswith(whole))
            if process.returncode == 0:
                break
        self.assertGreater(kills, 0)
        result = self.compare("--out", "cut")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.expect_same("whole", "cut")

    def test_goes_on_from_any_place_where_the_rows_end(self):
        self.compare("--out", "whole")
        text = (self.folder / "whole" / "rows.jsonl").read_text(encoding="utf-8")
        for share in (0.01, 0.3, 0.62, 0.999):
            folder = self.folder / f"cut-{share}"
            folder.mkdir()
            (folder / "rows.jsonl").write_text(text[:int(share * len(text))], encoding="utf-8")
            self.assertEqual(self.compare("--out", folder.name).returncode, 0)
            self.expect_same("whole", folder.name)

    def test_adds_the_rows_of_further_solvers(self):
        self.compare("--out", "whole")
        self.compare("--out", "parts", solvers="penalty")
        self.assertEqual(len(self.rows("parts")), PROBLEMS)
        self.compare("--out", "parts", solvers="nullspace,augmented_lagrangian")
        self.assertEqual(len(self.rows("parts")), 2 * PROBLEMS)
        self.compare("--out", "parts")
        self.expect_same("whole", "parts")

    def test_refuses_to_go_on_when_suite_or_mechanism_changed(self):
        self.compare(solvers="penalty")
        before = (self.folder / "suite-compare" / "results.csv").read_bytes()
        self.write("suite.yaml", SUITE.replace("seed: 7", "seed: 8"))
        result = self.compare(solvers="penalty")
        self.assertEqual(result.returncode, 2)
        self.assertIn("suite-compare/rows.jsonl: holds rows of another suite", result.stderr)
        self.assertIn("give another with --out", result.stderr)
        self.write("suite.yaml", SUITE)
        with open(self.folder / "rssr.yaml", "a", encoding="utf-8") as mechanism:
            mechanism.write("# touched\n")
        self.assertEqual(self.compare(solvers="penalty").returncode, 2)
        self.assertEqual((self.folder / "suite-compare" / "results.csv").read_bytes(), before)

    def test_says_which_solvers_there_are(self):
        result = self.compare(solvers="nulspace")
        self.assertEqual(result.returncode, 1)
        self.assertIn("'nulspace' is no solver; did you mean 'nullspace'?", result.stderr)
        self.assertFalse((self.folder / "suite-compare").exists())

    def test_sends_other_files_to_the_command_that_takes_them(self):
        takes = "; `vmech compare` takes a suite"
        for name, words in (("rssr.yaml", "is a mechanism, which `vmech check` reads" + takes),
                            ("four-bar-study.yaml",
                             "is a study, which `vmech loads` runs" + takes)):
            result = subprocess.run([VMECH, "compare", name], cwd=self.folder, capture_output=True,
                                    text=True, timeout=60)
            self.assertEqual(result.returncode, 2)
            self.assertIn(words, result.stderr)
        result = subprocess.run([VMECH, "check", "suite.yaml"], cwd=self.folder,
                                capture_output=True, text=True, timeout=60)
        self.assertIn("is a suite, which `vmech compare` runs", result.stderr)

    def test_says_which_mechanism_cannot_be_assembled(self):
        text = (self.folder / "rssr.yaml").read_text(encoding="utf-8")
        self.write("rssr.yaml", text.replace("origin: [1", "origin: [99", 1))
        result = self.compare()
        self.assertEqual(result.returncode, 3)
        self.assertIn("rssr: the loop through joint", result.stderr)


if __name__ == "__main__":
    VMECH = str(pathlib.Path(sys.argv[1]).resolve())
    EXAMPLES = pathlib.Path(sys.argv[2])
    unittest.main(argv=sys.argv[:1])
