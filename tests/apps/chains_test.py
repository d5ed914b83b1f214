"""chains_test.py VMECH: vmech check of long mechanisms takes memory in proportion to them."""

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
HEAD = """vmech: "1.0"
units: {length: mm, angle: deg}
gravity: [0, -9810, 0]
ground: base
links:
"""
INSTRUMENTED = 40.0  # MB that no program takes for a mechanism of ten joints, but with sanitizers


def anchor(name, x, z="[0, 0, 1]"):
    return f"      {name}: {{origin: [{x}, 0, 0], z: {z}, x: [1, 0, 0]}}\n"


def link(name, *anchors):
    return f"  {name}:\n    mass: 0.1\n    anchors:\n" + "".join(anchors)


def joint(name, first, second, start):
    return f"  {name}: {{type: revolute, connects: [{first}, {second}], start: {start!r}}}\n"


def open_chain(joints):
    """One link after the other, about z and y in turn: `joints` freedoms."""
    axes = ("[0, 0, 1]", "[0, 1, 0]")
    text = HEAD + link("base", anchor("j0", 0))
    for i in range(joints):
        text += link(f"l{i}", anchor("in", 0, axes[i % 2]), anchor(f"j{i + 1}", 10, axes[~i % 2]))
    text += "joints:\n"
    for i in range(joints):
        text += joint(f"j{i}", f"l{i - 1}/j{i}" if i else "base/j0", f"l{i}/in", 7 * i % 30)
    return text


def star(joints):
    """All links on the base: `joints` freedoms."""
    text = HEAD + link("base", *(anchor(f"j{i}", 10 * i) for i in range(joints)))
    text += "".join(link(f"l{i}", anchor("in", 0)) for i in range(joints)) + "joints:\n"
    return text + "".join(joint(f"j{i}", f"base/j{i}", f"l{i}/in", i % 7) for i in range(joints))


def tower(joints, flat=-1):
    """Parallelograms, each on the coupler of the one below: a freedom and a loop for four joints.
    The storey `flat` has all its links in line."""
    storeys = joints // 4
    text, connections = HEAD + link("base", anchor("a", 0), anchor("b", 50)), "joints:\n"
    for i in range(storeys):
        below = f"floor{i - 1}" if i else "base"
        angle = 0 if i == flat else 70
        text += "".join(link(f"{side}{i}", anchor("low", 0), anchor("up", 30)) for side in "pq")
        text += link(f"floor{i}", anchor("c", 0), anchor("d", 50), anchor("a", 0), anchor("b", 50))
        connections += joint(f"A{i}", f"{below}/a", f"p{i}/low", angle)
        connections += joint(f"B{i}", f"{below}/b", f"q{i}/low", angle)
        connections += joint(f"C{i}", f"p{i}/up", f"floor{i}/c", -angle)
        connections += joint(f"D{i}", f"q{i}/up", f"floor{i}/d", -angle)
    return text + connections


def ring(joints):
    """A regular polygon with a hinge at every corner: a loop with `joints` - 3 freedoms."""
    corner = 360 / joints
    text = HEAD + link("base", anchor("in", 0), anchor("out", 10))
    text += "".join(link(f"l{i}", anchor("in", 0), anchor("out", 10)) for i in range(1, joints))
    text += "joints:\n" + joint("j1", "base/out", "l1/in", corner)
    text += "".join(joint(f"j{i}", f"l{i - 1}/out", f"l{i}/in", corner) for i in range(2, joints))
    return text + joint("j0", f"l{joints - 1}/out", "base/in", corner)


FAMILIES = {"open chain": (open_chain, lambda n: n, lambda n: 0),
            "star": (star, lambda n: n, lambda n: 0),
            "tower": (tower, lambda n: n // 4, lambda n: n // 4 * 2),
            "ring": (ring, lambda n: n - 3, lambda n: 2)}


class LongMechanisms(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="vmech-"))
        self.addCleanup(shutil.rmtree, self.folder)

    def check(self, text):
        """What vmech check says, and the largest memory that it has had [MB]."""
        (self.folder / "long.yaml").write_text(text, encoding="utf-8")
        with open(self.folder / "answer.json", "wb") as out:
            process = subprocess.Popen([VMECH, "check", "--json", self.folder / "long.yaml"],
                                       stdout=out)
            _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        self.assertEqual(process.returncode, 0)
        return json.loads((self.folder / "answer.json").read_bytes()), usage.ru_maxrss / 1024

    def expect_right(self, family, joints, answer):
        _, mobility, rank = FAMILIES[family]
        self.assertEqual((answer["mobility"], answer["rank"]), (mobility(joints), rank(joints)))
        self.assertTrue(all(entry["moves"] for entry in answer["joints"]))
        self.assertFalse(answer["singular_start"])
        self.assertLess(answer["closure_error"], 1e-12)

    def test_are_understood_in_memory_in_proportion(self):
        for family, (make, _, _) in FAMILIES.items():
            memory = {}
            for joints in (8, 100, 400, 1000):
                with self.subTest(family=family, joints=joints):
                    answer, memory[joints] = self.check(make(joints))
                    self.expect_right(family, joints, answer)
            if memory[8] > INSTRUMENTED:
                continue
            with self.subTest(family=family, memory=memory):
                self.assertLess(memory[400], 40)
                per_joint = (memory[400] - memory[8]) / 392
                # The free motions of one loop are a dense basis, n by n - 6: 8 MB, a few times.
                if family == "ring":
                    self.assertLess(memory[1000], 90)
                    continue
                self.assertLess((memory[1000] - memory[400]) / 600, 1.5 * per_joint + 0.005)

    def test_with_one_dead_centre_are_singular_there_alone(self):
        answer, _ = self.check(tower(40, flat=4))
        self.assertEqual((answer["mobility"], answer["rank"]), (10, 20))
        self.assertTrue(answer["singular_start"])


if __name__ == "__main__":
    VMECH = pathlib.Path(sys.argv[1]).resolve()
    unittest.main(argv=sys.argv[:1])
