"""progress_bar_test.py VMECH EXAMPLES: long studies say on a terminal how far they are."""

import os
import pathlib
import pty
import select
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

VMECH = ""
EXAMPLES = pathlib.Path()


class Progress(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="vmech-"))
        self.addCleanup(shutil.rmtree, self.folder)
        for source in EXAMPLES.glob("stewart-gough*"):
            shutil.copy(source, self.folder)
        study = (self.folder / "stewart-gough-study.yaml").read_text(encoding="utf-8")
        self.assertIn("leg1, table", study)
        (self.folder / "long.yaml").write_text(
            study.replace("leg1, table", "leg1, steps: 400000, table"), encoding="utf-8")

    def start(self, *arguments, stderr):
        process = subprocess.Popen([VMECH, "loads", "long.yaml", "--threads", "1", *arguments],
                                   cwd=self.folder, stderr=stderr, stdout=subprocess.DEVNULL)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def read_until(self, descriptor, mark, seconds):
        text, end = b"", time.monotonic() + seconds
        while mark not in text and time.monotonic() < end:
            if select.select([descriptor], [], [], 0.1)[0]:
                text += os.read(descriptor, 4096)
        return text.decode()

    def terminal(self):
        ours, theirs = pty.openpty()
        self.addCleanup(os.close, ours)
        self.addCleanup(os.close, theirs)
        return ours, theirs

    def test_is_shown_on_a_terminal_while_a_long_study_runs(self):
        ours, theirs = self.terminal()
        self.start("--out", "out", stderr=theirs)
        text = self.read_until(ours, b"left", 60)
        self.assertRegex(text, r"\rloads \[#* *\] +\d+ %  \d+ s left")
        self.assertFalse((self.folder / "out").exists())

    def test_is_not_shown_if_quiet(self):
        ours, theirs = self.terminal()
        self.start("--quiet", stderr=theirs)
        self.assertEqual(self.read_until(ours, b"left", 2.5), "")

    def test_is_not_shown_without_a_terminal(self):
        pipe = self.start(stderr=subprocess.PIPE).stderr
        self.addCleanup(pipe.close)
        self.assertEqual(self.read_until(pipe.fileno(), b"left", 2.5), "")


if __name__ == "__main__":
    VMECH, EXAMPLES = (pathlib.Path(argument).resolve() for argument in sys.argv[1:])
    unittest.main(argv=sys.argv[:1])
