"""parameters_test.py VMECH EXAMPLES: parameters in files and on the command line.

Every command gives the same bytes for a file with parameters and for one with the numbers typed in.
"""

import csv
import json
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest
import urllib.request

VMECH = ""
EXAMPLES = pathlib.Path()
NAMED = (("ground: frame", "parameters: {crank: 40 mm, rod: 3*crank}\nground: frame"),
         ("[25, 0, 0]", "[crank/2, 0, 0]"), ("[50, 0, 0]", "[crank, 0, 0]"),
         ("[150, 0, 0]", "[rod, 0, 0]"), ("[100, 0, 0]", "[2*crank, 0, 0]"),
         ("yy: 100, zz: 110", "yy: 0.04 kg*crank^2, zz: 10 kg*mm^2 + 0.04 kg*crank^2"),
         ("mass: 0.3\n", "mass: sqrt(0.09)*1 kg\n"))


def without_times(text):
    """What a command prints, but for how long it took."""
    return re.sub(r"[\d.]+ ms", "", text)


class Parameters(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="vmech-"))
        self.addCleanup(shutil.rmtree, self.folder)
        for name in ("typed", "named"):
            (self.folder / name).mkdir()
            for source in EXAMPLES.glob("slider-crank*"):
                shutil.copy(source, self.folder / name)
        self.edit("named/slider-crank.yaml", *NAMED)
        self.edit("named/slider-crank-study.yaml", ("rpm: 1500", "rpm: speed"),
                  ("[-15, 15]", "[-15, 15*crank/50]"),
                  ("units:", "parameters: {speed: 1500 rpm, crank: 50}\nunits:"))

    def edit(self, name, *changes):
        text = (self.folder / name).read_text(encoding="utf-8")
        for passage, replacement in changes:
            self.assertIn(passage, text)
            text = text.replace(passage, replacement)
        (self.folder / name).write_text(text, encoding="utf-8")

    def vmech(self, folder, *arguments):
        return subprocess.run([VMECH, *arguments], cwd=self.folder / folder, capture_output=True,
                              text=True, stdin=subprocess.DEVNULL, timeout=120, check=False)

    def expect_same(self, *arguments, settings=("--set", "crank=50"), files=()):
        with self.subTest(arguments=arguments):
            named = self.vmech("named", *arguments, *settings)
            typed = self.vmech("typed", *arguments)
            self.assertEqual(typed.returncode, 0, typed.stderr)
            self.assertEqual((named.returncode, named.stderr), (0, ""))
            self.assertEqual(without_times(named.stdout), without_times(typed.stdout))
            for file in files:
                self.assertEqual((self.folder / "named" / file).read_bytes(),
                                 (self.folder / "typed" / file).read_bytes(), file)

    def test_every_command_gives_the_same_bytes(self):
        mechanism = "slider-crank.yaml"
        self.expect_same("check", mechanism)
        self.expect_same("check", "--json", "--dh", mechanism)
        self.expect_same("check", mechanism, "--draw", "a.svg", files=("a.svg",))
        self.expect_same("ik", mechanism, "--target", "80 30 0")
        for file in ("out.yaml", "out.sdf", "out.xml"):
            self.expect_same("export", mechanism, "--out", file, files=(file,))
        self.expect_same("haptic", mechanism, "--free", "--seconds", "0.05", "-q")

    def test_a_comparison_reads_its_mechanisms_with_what_is_set(self):
        suite = ("vmech_suite: '1.0'\ntargets: {near: {kind: reachable, count: 3}}\n"
                 "mechanisms: {slider-crank: {file: slider-crank.yaml, grasp: handle}}\n")
        results = []
        for folder, settings in (("named", ("--set", "crank=50")), ("typed", ())):
            (self.folder / folder / "suite.yaml").write_text(suite, encoding="utf-8")
            done = self.vmech(folder, "compare", "suite.yaml", "--solvers", "nullspace", "--jobs",
                              "1", "--out", "compared", "-q", *settings)
            self.assertEqual(done.returncode, 0, done.stderr)
            with open(self.folder / folder / "compared/results.csv", newline="",
                      encoding="utf-8") as file:
                results.append([{name: value for name, value in row.items()
                                 if not name.startswith("time")} for row in csv.DictReader(file)])
        self.assertEqual(len(results[0]), 3)
        self.assertEqual(*results)

    def test_a_simulation_is_of_the_mechanism_as_it_is_set(self):
        study = ("vmech_study: '1.0'\nmechanism: slider-crank.yaml\n"
                 "simulation: {duration: 0.02, steps: 5}\n")
        for folder in ("named", "typed"):
            (self.folder / folder / "falling.yaml").write_text(study, encoding="utf-8")
        self.expect_same("simulate", "falling.yaml", "--out", "fell", "-q",
                         files=("fell/loads.csv", "fell/motion.csv", "fell/energies.csv"))

    def test_the_page_shows_the_mechanism_as_it_is_set(self):
        typed = self.scene("typed", "slider-crank.yaml")
        named = self.scene("named", "slider-crank.yaml", "--set", "crank=50")
        other = self.scene("named", "slider-crank.yaml", "--set", "crank=45")
        self.assertIn("crank", json.dumps(named["session"]["parameters"]))
        for scene in (named, typed, other):
            scene["session"].pop("parameters", None)
        self.assertEqual(named, typed)
        self.assertNotEqual(other, typed)

    def scene(self, folder, *arguments):
        """What the page of vmech view draws."""
        with subprocess.Popen([VMECH, "view", *arguments], cwd=self.folder / folder, text=True,
                              stdout=subprocess.PIPE, stdin=subprocess.DEVNULL) as process:
            try:
                url = next(line for line in process.stdout if "http://" in line).strip()
                with urllib.request.urlopen(url, timeout=30) as page:
                    text = page.read().decode()
            finally:
                process.send_signal(signal.SIGINT)
                process.communicate(timeout=30)
        return json.loads(re.search(r'id="vmech-scene">(.*?)</script>', text, re.DOTALL)[1])

    def test_a_study_sets_parameters_and_states_them(self):
        results = [f"out/{name}.csv" for name in
                   ("loads", "motion", "joints", "certainty", "bearings")]
        self.expect_same("loads", "slider-crank-study.yaml", "--out", "out", "-q", settings=(),
                         files=results)
        named, typed = (json.loads((self.folder / name / "out/summary.json").read_text())
                        for name in ("named", "typed"))
        stated = named.pop("parameters")
        self.assertEqual({name: entry["value"] for name, entry in stated.items()},
                         {"crank": 50, "rod": 150, "speed": 1500})
        self.assertEqual(stated["rod"]["unit"], "mm")
        for summary in (named, typed):
            summary.pop("mechanism_sha256")
        self.assertEqual(named, typed)
        self.assertIn("1500 rpm", (self.folder / "named/out/report.html").read_text())
        slow = self.vmech("named", "loads", "slider-crank-study.yaml", "--out", "slow",
                          "--set", "speed=1000", "--set", "crank=45 mm")
        self.assertEqual(slow.returncode, 0, slow.stderr)
        stated = json.loads((self.folder / "named/slow/summary.json").read_text())["parameters"]
        self.assertEqual([stated[name]["value"] for name in ("crank", "rod", "speed")],
                         [45, 135, 1000])

    def test_what_is_wrong_is_said_with_its_place(self):
        for code, words, *arguments in (
                (1, "has no parameter 'crnak'; did you mean 'crank'?", "--set", "crnak=50"),
                (1, "--set crank=5 kg: '5 kg': a mass, and crank is a length", "--set",
                 "crank=5 kg"),
                (1, "--set crank=1/0: '1/0': division by zero", "--set", "crank=1/0"),
                (1, "is not of the form NAME=VALUE", "--set", "crank")):
            result = self.vmech("named", "check", "slider-crank.yaml", *arguments)
            self.assertEqual(result.returncode, code, result.stderr)
            self.assertIn(words, result.stderr)
        self.edit("named/slider-crank-study.yaml", ("speed: 1500 rpm", "sped: 1500 rpm"))
        result = self.vmech("named", "loads", "slider-crank-study.yaml")
        self.assertEqual(result.returncode, 2)
        self.assertIn("there is no parameter 'speed'; did you mean 'sped'?", result.stderr)
        self.edit("named/slider-crank-study.yaml", ("rpm: speed", "rpm: 1500"))
        result = self.vmech("named", "loads", "slider-crank-study.yaml")
        self.assertIn("slider-crank.yaml has no parameter 'sped', and nothing in this study names "
                      "it", result.stderr)


if __name__ == "__main__":
    VMECH, EXAMPLES = sys.argv[1], pathlib.Path(sys.argv[2])
    unittest.main(argv=sys.argv[:1])
