"""doubts_test.py VMECH EXAMPLES: figures that are possible and seldom meant are doubted aloud.

Every kind of doubt comes with its figure on the terminal, in JSON and on the page, leaves the exit
code alone, and is an error with --strict. The examples raise none.
"""

import html
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

VMECH, EXAMPLES = sys.argv[1], pathlib.Path(sys.argv[2])

# Kind: what is replaced in slider-crank.yaml, and words of the warning, its figure among them.
OF_MECHANISMS = {
    "inertia in kg m^2 among millimetres": (
        [("length: mm", "length: mm, inertia: kg m^2")], ["'coupler'", "radius of gyration"]),
    "lengths in metres that are millimetres": ([("length: mm", "length: m")], ["150 m long"]),
    "gravity in mm/s^2": ([("-9.81", "-9810")], ["gravity is 9810 m/s^2"]),
    "a start of nine turns": (
        [("start: 40}", "start: 3404}")], ["'main' starts at 3404 deg", "9.46 turns"]),
}
# The same for slider-crank-study.yaml.
OF_STUDIES = {
    "few poses": ([("steps: 720", "steps: 12")], ["12 poses in a cycle"]),
}


def vmech(*arguments, code=0):
    result = subprocess.run([VMECH, *map(str, arguments)], capture_output=True, text=True)
    assert result.returncode == code, (arguments, result.returncode, result.stdout, result.stderr)
    return result.stdout + result.stderr


def changed(text, replacements):
    for old, new in replacements:
        assert old in text, old
        text = text.replace(old, new)
    return text


class Doubts(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="vmech-"))
        self.addCleanup(shutil.rmtree, self.folder)
        for path in EXAMPLES.glob("slider-crank*"):
            shutil.copy(path, self.folder)
        self.mechanism = self.folder / "slider-crank.yaml"
        self.study = self.folder / "slider-crank-study.yaml"
        self.out = self.folder / "out"

    def change(self, path, replacements):
        path.write_text(changed(path.read_text(), replacements))

    def expect(self, words, text):
        for word in words:
            self.assertIn(word, text)

    def expect_in_loads(self, words):
        text = vmech("loads", self.study, "--out", self.out)
        self.expect([*words, "warning: "], text)
        summary = json.loads((self.out / "summary.json").read_text())
        self.expect(words, "\n".join(summary["warnings"]))
        page = (self.out / "report.html").read_text()
        self.expect(words, html.unescape(page))
        shutil.rmtree(self.out)
        strict = vmech("loads", self.study, "--out", self.out, "--strict", code=2)
        self.expect(words, strict)
        self.assertFalse(self.out.exists())

    def test_mechanisms(self):
        original = self.mechanism.read_text()
        for kind, (replacements, words) in OF_MECHANISMS.items():
            with self.subTest(kind):
                self.mechanism.write_text(changed(original, replacements))
                self.expect([*words, "warning  "], vmech("check", self.mechanism))
                found = json.loads(vmech("check", self.mechanism, "--json"))["warnings"]
                self.expect(words, "\n".join(found))
                self.expect(words, vmech("check", self.mechanism, "--strict", code=2))

    def test_mechanisms_in_studies(self):
        self.change(self.mechanism, [("-9.81", "-31")])
        self.expect_in_loads(["gravity is 31 m/s^2"])

    def test_studies(self):
        original = self.study.read_text()
        for kind, (replacements, words) in OF_STUDIES.items():
            with self.subTest(kind):
                self.study.write_text(changed(original, replacements))
                self.expect_in_loads(words)

    def test_examples_raise_none(self):
        for path in sorted(EXAMPLES.glob("*.yaml")):
            with self.subTest(path.name):
                if path.name == "closed-chains.yaml":
                    continue
                if path.name.endswith("-study.yaml"):
                    vmech("loads", path, "--out", self.out, "--strict")
                    shutil.rmtree(self.out)
                else:
                    vmech("check", path, "--strict")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
