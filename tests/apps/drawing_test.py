"""drawing_test.py VMECH EXAMPLES: the picture that `vmech check --draw` makes of a mechanism."""

import math
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

VMECH = ""
EXAMPLES = pathlib.Path()
SVG = "{http://www.w3.org/2000/svg}"
HUNDREDTHS = 0.011  # coordinates on the paper are hundredths of a unit


def texts(picture):
    return [element.text or "" for element in picture.iter(SVG + "text")]


def pivots(picture):
    """The places of the joints on the paper, in the order of the mechanism."""
    return [complex(float(circle.get("cx")), float(circle.get("cy")))
            for circle in picture.iter(SVG + "circle") if circle.get("class") == "pivot"]


def millimetre(picture):
    """The length of a millimetre on the paper, by the scale bar."""
    bar = next(line for line in picture.iter(SVG + "line") if line.get("class") == "scale"
               and line.get("x1") == "20" and line.get("y1") == line.get("y2"))
    label = next(text for text in texts(picture) if text.endswith(" mm"))
    return (float(bar.get("x2")) - float(bar.get("x1"))) / float(label[:-3])


class Drawing(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="vmech-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def check(self, *arguments):
        return subprocess.run([VMECH, "check", *map(str, arguments)], cwd=self.folder, text=True,
                              capture_output=True, stdin=subprocess.DEVNULL, timeout=120)

    def draw(self, mechanism):
        result = self.check(mechanism, "--draw", "picture.svg")
        self.assertEqual(result.returncode, 0, result.stderr)
        return xml.etree.ElementTree.parse(self.folder / "picture.svg").getroot()

    def test_every_link_joint_and_grasp_is_named(self):
        for path in EXAMPLES.glob("*.yaml"):
            text = path.read_text(encoding="utf-8")
            if "\nvmech:" not in text or "\nlinks:" not in text:
                continue
            with self.subTest(mechanism=path.name):
                words = " ".join(texts(self.draw(path)))
                for block in ("links", "joints", "grasps"):
                    found = re.search(rf"^{block}:\n((?:[ #].*\n|\n)*)", text, re.MULTILINE)
                    for name in re.findall(r"^  (\w+):", found.group(1) if found else "",
                                           re.MULTILINE):
                        self.assertIn(name, words)

    def test_joints_are_where_the_closed_slider_crank_has_them(self):
        picture = self.draw(EXAMPLES / "slider-crank.yaml")
        main, pin, wrist, guide = pivots(picture)
        unit = millimetre(picture)
        crank = 50 * complex(math.cos(math.radians(40)), -math.sin(math.radians(40)))  # y is down
        slide = crank.real + math.sqrt(150 ** 2 - crank.imag ** 2)
        for place, expected in ((pin, crank), (wrist, slide), (guide, slide)):
            self.assertLess(abs(place - main - unit * expected), 3 * HUNDREDTHS)

    def test_space_diagonal_shortens_all_axes_alike(self):
        # Arms of 100 mm along x, y, z; seen along (1, 1, 1) each is sqrt(2/3) as long.
        axes = {"a": "z: [0, 1, 0], x: [1, 0, 0]", "b": "z: [0, 0, 1], x: [1, 0, 0]",
                "c": "z: [1, 0, 0], x: [0, 1, 0]"}
        ends = {"a": "100, 0, 0", "b": "0, 100, 0", "c": "0, 0, 100"}
        lines = ['vmech: "1.0"', "name: star", "units: {length: mm, angle: deg}",
                 "gravity: [0, 0, 0]", "ground: g", "links:", "  g:", "    anchors:"]
        lines += [f"      {arm}: {{{axes[arm]}}}" for arm in "abc"]
        for arm in "abc":
            lines += [f"  {arm}:", "    anchors:", f"      hub: {{{axes[arm]}}}",
                      f"      end: {{origin: [{ends[arm]}], {axes[arm]}}}",
                      f"  t{arm}:", "    anchors:", f"      end: {{{axes[arm]}}}"]
        lines += ["joints:"]
        lines += [f"  j{arm}: {{type: revolute, connects: [g/{arm}, {arm}/hub]}}" for arm in "abc"]
        lines += [f"  e{arm}: {{type: weld, connects: [{arm}/end, t{arm}/end]}}" for arm in "abc"]
        (self.folder / "star.yaml").write_text("\n".join(lines) + "\n", encoding="utf-8")
        picture = self.draw("star.yaml")
        *hubs, x, y, z = pivots(picture)
        for place in (x, y, z):
            self.assertAlmostEqual(abs(place - hubs[0]) / millimetre(picture),
                                   100 * math.sqrt(2 / 3), delta=0.1)
        self.assertAlmostEqual(z.real, hubs[0].real, delta=HUNDREDTHS)  # up
        self.assertLess(z.imag, hubs[0].imag)

    def test_hostile_names_stay_text(self):
        text = (EXAMPLES / "crank.yaml").read_text(encoding="utf-8")
        evil = "<script>alert(1)<&>"
        (self.folder / "evil.yaml").write_text(
            re.sub(r"^name: .*$", f"name: '{evil}'", text, flags=re.MULTILINE))
        picture = self.draw("evil.yaml")
        self.assertIn(evil, texts(picture))
        self.assertEqual([e for e in picture.iter() if "script" in e.tag], [])

    def test_other_endings_and_several_mechanisms_are_refused(self):
        crank, arm = EXAMPLES / "crank.yaml", EXAMPLES / "two-link-arm.yaml"
        for arguments, words in (((crank, "--draw", "a.png"), "the ending of 'a.png'"),
                                 ((crank, arm, "--draw", "a.svg"), "one mechanism")):
            result = self.check(*arguments)
            self.assertEqual(result.returncode, 1)
            self.assertIn(words, result.stderr)
        self.assertEqual(list(self.folder.iterdir()), [])


if __name__ == "__main__":
    VMECH, EXAMPLES = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve()
    unittest.main(argv=sys.argv[:1])
