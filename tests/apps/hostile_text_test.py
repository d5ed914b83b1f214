"""hostile_text_test.py VMECH EXAMPLES: no text out of files acts on a terminal or a spreadsheet."""

import csv
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

RED = "\x1b[31m"
ACTS = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069]")
FORMULA = re.compile(r"[=+@\t\r-]")


class HostileText(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="vmech-"))
        self.addCleanup(shutil.rmtree, self.folder)
        for source in EXAMPLES.glob("four-bar*.yaml"):
            shutil.copy(source, self.folder)

    def run_vmech(self, *arguments):
        result = subprocess.run([VMECH, *arguments], cwd=self.folder, capture_output=True,
                                stdin=subprocess.DEVNULL, timeout=60)
        return result.returncode, result.stdout.decode(), result.stderr.decode()

    def edit(self, source, name, *changes):
        text = (self.folder / source).read_text(encoding="utf-8")
        for passage, replacement in changes:
            self.assertRegex(text, passage)
            text = re.sub(passage, replacement, text)
        (self.folder / name).write_text(text, encoding="utf-8")

    def test_names_of_files_are_printed_without_control_characters(self):
        shutil.copy(self.folder / "four-bar.yaml", self.folder / f"{RED}\u202e\x9bx.yaml")
        shutil.copy(self.folder / "four-bar-study.yaml", self.folder / f"{RED}s.yaml")
        for arguments in (("check", f"no{RED}.yaml"), ("check", f"no\rsuch\u202e{RED}.yaml"),
                          ("loads", f"{RED}\u202e\x9bx.yaml"), ("loads", f"{RED}s.yaml"),
                          ("check", "four-bar.yaml", f"--{RED}"),
                          ("check", "four-bar.yaml", f"{RED}"), ("compare", "x", f"--jobs={RED}")):
            with self.subTest(arguments=arguments):
                _, out, err = self.run_vmech(*arguments)
                self.assertIn("\ufffd", out + err)
                self.assertIsNone(ACTS.search(out + err))

    def test_bytes_that_are_no_text_are_printed_as_such(self):
        code, _, err = self.run_vmech("check", os.fsencode("M") + b"\xfcller.yaml")
        self.assertEqual((code, err.partition(":")[0]), (2, "M\ufffdller.yaml"))

    def test_names_that_are_formulas_are_disarmed_in_tables(self):
        self.edit("four-bar.yaml", "four-bar.yaml", (r"\n  main: ", '\n  "=1+1": '),
                  (r"\n  crank_pin: ", '\n  "@pin": '), (r"\n  rocker_pin: ", '\n  "-pin": '))
        self.edit("four-bar-study.yaml", "study.yaml", (r"joint: main", 'joint: "=1+1"'),
                  (r"\n  main: ", '\n  "=1+1": '))
        code, out, err = self.run_vmech("loads", "study.yaml", "--out", "out")
        self.assertEqual(code, 0, err)
        self.assertIn("=1+1", out)
        disarmed = 0
        for name in ("loads.csv", "motion.csv", "joints.csv", "certainty.csv", "bearings.csv"):
            with open(self.folder / "out" / name, newline="", encoding="utf-8") as file:
                for row in csv.reader(file):
                    for cell in row:
                        disarmed += cell.startswith("'")
                        if FORMULA.match(cell):
                            float(cell)
        self.assertGreater(disarmed, 20)


if __name__ == "__main__":
    VMECH, EXAMPLES = (pathlib.Path(argument).resolve() for argument in sys.argv[1:])
    unittest.main(argv=sys.argv[:1])
