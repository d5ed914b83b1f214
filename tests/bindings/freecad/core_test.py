"""core_test.py VMECH ADDON: the core of the FreeCAD add-on without a window. Run by the Python
that FreeCAD is built for; exit code 77 if FreeCAD is not there."""

import math
import os
import pathlib
import sys
import tempfile
import unittest

HOME = tempfile.TemporaryDirectory()
os.environ.update(HOME=HOME.name, QT_QPA_PLATFORM="offscreen", VMECH=sys.argv[1])
sys.path += ["/usr/lib/freecad-python3/lib", "/usr/share/freecad/Mod", sys.argv[2]]
try:
    import FreeCAD
    import Part
    import yaml
except ImportError as error:
    print(f"skipped: {error}; install freecad-python3")
    sys.exit(77)
from FreeCAD import Placement, Rotation, Vector

from vmech_freecad import command, marks, results

STEEL, ALUMINIUM = 7850, 2700  # kg/m^3
CRANK, ROD = 50.0, 150.0  # mm
ANGLE = math.radians(40)
MASS_TOLERANCE = 1e-9  # of the mass: STEP files have 12 digits
Z = Vector(0, 0, 1)


def box(low, high):
    return Part.makeBox(*(b - a for a, b in zip(low, high)), Vector(*low))


def cylinder(foot, radius, height, axis=Z):
    return Part.makeCylinder(radius, height, Vector(*foot), axis)


def circle(solid, center, radius):
    """The name of the edge that is this circle, in the axes of the solid's group."""
    for i, edge in enumerate(solid.Shape.Edges, start=1):
        curve = edge.Curve
        if isinstance(curve, Part.Circle) and abs(curve.Radius - radius) < 1e-6:
            if (curve.Center - Vector(*center)).Length < 1e-6:
                return f"Edge{i}"
    raise AssertionError("no such circle")


class SliderCrank:
    """A crank with a pin, a rod of blocks and bores, a piston on a slide, as a user draws them."""

    def __init__(self):
        self.document = FreeCAD.newDocument("slider")
        rod_angle = -math.asin(CRANK * math.sin(ANGLE) / ROD)
        pin = Vector(CRANK * math.cos(ANGLE), CRANK * math.sin(ANGLE), 0)
        wrist = pin + Vector(ROD * math.cos(rod_angle), ROD * math.sin(rod_angle), 0)
        self.frame = self.add("frame", box((-30, -30, -40), (30, 30, -10)).cut(
            cylinder((0, 0, -40), 10, 30)), Placement())
        self.crank = self.add("crank", cylinder((0, 0, -40), 10, 30).fuse(
            box((-15, -15, -10), (65, 15, 0))).fuse(cylinder((CRANK, 0, 0), 8.5, 20)),
                              Placement(Vector(), Rotation(Z, math.degrees(ANGLE))))
        self.rod = self.add("rod", box((-20, -20, 0), (20, 20, 20)).cut(
            cylinder((0, 0, 0), 8.5, 20)).fuse(box((20, -8, 4), (135, 8, 16))).fuse(
                box((135, -15, 0), (165, 15, 20)).cut(cylinder((ROD, 0, 0), 6, 20))),
                            Placement(pin, Rotation(Z, math.degrees(rod_angle))))
        self.piston = self.add("piston", cylinder((0, 0, 0), 6, 20).fuse(
            cylinder((20, 0, 10), 30, 40, Vector(1, 0, 0))), Placement(wrist, Rotation()))
        self.document.recompute()

    def add(self, name, shape, placement):
        solid = self.document.addObject("Part::Feature", name)
        solid.Label = name
        solid.Shape = shape.removeSplitter()
        solid.Placement = placement
        return solid

    def mark(self):
        marks.mark_anchor(self.frame, circle(self.frame, (0, 0, -40), 10), "main")
        # A solid's own placement is in its shape: centers are those of the model as drawn.
        pin = self.crank.Placement.multVec(Vector(CRANK, 0, 20))
        marks.mark_anchor(self.crank, circle(self.crank, (0, 0, -40), 10), "main", "revolute")
        marks.mark_anchor(self.crank, circle(self.crank, pin, 8.5), "pin", "revolute")
        marks.mark_anchor(self.rod, circle(self.rod, pin, 8.5), "pin")
        wrist = self.rod.Placement.multVec(Vector(ROD, 0, 20))
        marks.mark_anchor(self.rod, circle(self.rod, wrist, 6), "wrist", "revolute")
        end = self.piston.Placement.multVec(Vector(0, 0, 20))
        marks.mark_anchor(self.piston, circle(self.piston, end, 6), "wrist")
        crown = self.piston.Placement.multVec(Vector(60, 0, 10))
        marks.mark_anchor(self.piston, circle(self.piston, crown, 30), "guide", "prismatic")
        guide = self.document.addObject("PartDesign::CoordinateSystem", "LCS")
        guide.Label = "anchor_guide__prismatic"
        marks.link_of(self.frame).addObject(guide)
        guide.Placement = Placement(Vector(0, 0, 10), Rotation(Vector(0, 0, 1), Vector(1, 0, 0)))
        marks.mark_grasp(self.piston, circle(self.piston, crown, 30), "crown")
        marks.set_density(self.piston, "aluminium")
        marks.set_density(marks.link_of(self.rod), STEEL)
        marks.set_ground(marks.link_of(self.frame), Vector(0, -9.81, 0))


class Addon(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.model = SliderCrank()
        self.addCleanup(lambda: FreeCAD.closeDocument(self.model.document.Name))

    def export(self, **options):
        self.model.mark()
        return command.export(self.model.document, self.folder / "slider.yaml", **options)

    def test_a_marked_slider_crank_checks_and_has_one_freedom(self):
        report = self.export()
        self.assertIn("4 joints", report)
        check = command.check(self.folder / "slider.yaml")
        self.assertTrue(check["assembled"])
        self.assertEqual(check["mobility"], 1)
        self.assertEqual(check["ground"], "frame")

    def test_masses_are_those_of_the_closed_forms(self):
        self.export()
        masses = {link["name"]: link["mass"]
                  for link in command.check(self.folder / "slider.yaml")["links"]}
        crank = math.pi * 10**2 * 30 + 80 * 30 * 10 + math.pi * 8.5**2 * 20
        rod = (40 * 40 * 20 - math.pi * 8.5**2 * 20 + 115 * 16 * 12 + 30 * 30 * 20
               - math.pi * 6**2 * 20)
        for name, volume in (("crank", crank), ("rod", rod)):
            expected = STEEL * 1e-9 * volume
            self.assertAlmostEqual(masses[name] / expected, 1, delta=MASS_TOLERANCE)
        piston = ALUMINIUM * 1e-9 * self.model.piston.Shape.Volume
        self.assertAlmostEqual(masses["piston"] / piston, 1, delta=MASS_TOLERANCE)

    def test_the_file_has_gravity_grasp_and_the_shafts_of_the_study(self):
        self.export(study=self.folder / "study.yaml", drives=["main"], rpm=1500)
        with open(self.folder / "slider.yaml", encoding="utf-8") as file:
            mechanism = yaml.safe_load(file)
        self.assertEqual(mechanism["gravity"], [0, -9.81, 0])
        self.assertIn("crown", mechanism["grasps"])
        with open(self.folder / "study.yaml", encoding="utf-8") as file:
            study = yaml.safe_load(file)
        self.assertEqual(study["motion"]["rpm"], 1500)
        shafts = {joint: asked["shaft"] for joint, asked in study["bearings"].items()}
        self.assertEqual(shafts, {"main": [20, 20], "pin": [17, 17], "wrist": [12, 12]})

    def test_joint_loads_stand_as_arrows_at_the_joints(self):
        self.export(study=self.folder / "study.yaml", drives=["main"], rpm=1500)
        command.loads(self.folder / "study.yaml", self.folder / "loads")
        loads = results.Loads(self.folder / "slider.yaml", self.folder / "loads")
        self.assertEqual(len(loads), 360)
        group = results.show(self.model.document, loads, pose=90, longest=100)
        self.assertEqual(len(group.Group), 4)
        turned = marks.link_of(self.model.crank).Placement.Rotation
        self.assertAlmostEqual(math.degrees(turned.Angle), 90, places=6)  # from the start
        pin, force = loads.force("pin", 90)
        crank = loads.placement("crank", 90)
        self.assertLess((pin - crank.multVec(self.pin_in_crank())).Length, 1e-6)
        labels = [arrow.Label for arrow in group.Group]
        self.assertIn(f"pin: {force.Length:.4g} N", labels)
        results.show(self.model.document, loads, pose=0)
        self.assertEqual(len(self.model.document.getObjectsByLabel(results.SHOWN)), 1)

    def pin_in_crank(self):
        with open(self.folder / "slider.yaml", encoding="utf-8") as file:
            anchors = yaml.safe_load(file)["links"]["crank"]["anchors"]
        return Vector(*anchors["pin"]["origin"])

    def test_forces_of_both_ends_of_the_rod_and_its_weight_keep_newton(self):
        self.export(study=self.folder / "study.yaml", drives=["main"], rpm=1e-3)  # at rest
        command.loads(self.folder / "study.yaml", self.folder / "loads")
        loads = results.Loads(self.folder / "slider.yaml", self.folder / "loads")
        weight = 9.81 * next(link["mass"] for link in
                             command.check(self.folder / "slider.yaml")["links"]
                             if link["name"] == "rod")
        on_rod = loads.force("pin", 30)[1] - loads.force("wrist", 30)[1]
        self.assertLess((on_rod - Vector(0, weight, 0)).Length, 1e-6 * weight)

    def test_what_cannot_be_marked_is_refused_in_words(self):
        with self.assertRaisesRegex(marks.MarkError, "select a circle"):
            straight = next(f"Edge{i}" for i, edge in enumerate(self.model.frame.Shape.Edges, 1)
                            if isinstance(edge.Curve, Part.Line))
            marks.mark_anchor(self.model.frame, straight, "a")
        with self.assertRaisesRegex(marks.MarkError, "'hinge' is no type of joint"):
            marks.mark_anchor(self.model.frame, "Face1", "a", "hinge")
        with self.assertRaisesRegex(marks.MarkError, "a name has"):
            marks.mark_anchor(self.model.frame, "Face1", "a/b")

    def test_what_vmech_refuses_reaches_the_user_and_leaves_no_file(self):
        self.model.mark()
        marks.mark_anchor(self.model.rod, "Face1", "alone")
        with self.assertRaisesRegex(command.VmechError, "'anchor_alone' of 'rod' has no partner"):
            command.export(self.model.document, self.folder / "slider.yaml")
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_a_document_without_links_says_what_to_do(self):
        with self.assertRaisesRegex(marks.MarkError, "holds no link"):
            command.export(self.model.document, self.folder / "slider.yaml")


class Containers(unittest.TestCase):
    """Two levers on the pins of a base, in an assembly with folders and instances."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.file = pathlib.Path(folder.name) / "levers.yaml"
        self.document = FreeCAD.newDocument("levers")
        self.addCleanup(lambda: FreeCAD.closeDocument(self.document.Name))
        self.assembly = self.document.addObject("App::Part", "Assembly")
        self.assembly.Placement = Placement(Vector(5, 6, 7), Rotation(Z, 20))
        self.folder = self.document.addObject("App::DocumentObjectGroup", "Folder")
        self.assembly.addObject(self.folder)
        self.base = self.part("base", box((-30, -30, -10), (230, 30, 0)).fuse(
            cylinder((0, 0, 0), 5, 20)).fuse(cylinder((200, 0, 0), 5, 20)))

    def part(self, name, shape):
        part = self.document.addObject("App::Part", name)
        solid = self.document.addObject("Part::Feature", name + "-solid")
        solid.Shape = shape.removeSplitter()
        part.addObject(solid)
        self.folder.addObject(part)
        return part

    def lever_shape(self):
        return box((-10, -10, 0), (80, 10, 20)).cut(cylinder((0, 0, 0), 5, 20))

    def instance(self, shown, label, placement):
        link = self.document.addObject("App::Link", "Instance")
        link.LinkedObject = shown
        link.Label = label
        link.Placement = placement
        self.folder.addObject(link)
        return link

    def check(self):
        self.document.recompute()
        self.report = command.export(self.document, self.file)
        self.assertIn(self.base, self.folder.Group)
        check = command.check(self.file)
        self.assertTrue(check["assembled"])
        self.assertEqual(check["mobility"], 2)
        self.assertEqual([joint["type"] for joint in check["joints"]], ["revolute"] * 2)
        volume = 90 * 20 * 20 - math.pi * 25 * 20
        for link in check["links"]:
            if link["name"] != "base":
                self.assertAlmostEqual(link["mass"] / (STEEL * 1e-9 * volume), 1,
                                       delta=MASS_TOLERANCE)
        return sorted(link["name"] for link in check["links"])

    def test_instances_of_a_part_in_a_folder_of_an_assembly_are_links(self):
        lever = self.part("lever", self.lever_shape())
        self.instance(lever, "Hebel groß", Placement(Vector(200, 0, 0), Rotation(Z, 100)))
        self.assertEqual(self.check(), ["Hebel groß", "base", "lever"])
        self.assertEqual([root.Label for root in marks.roots(self.document)], ["Assembly"])

    def test_instances_of_a_solid_can_be_marked(self):
        solid = self.document.addObject("Part::Feature", "drawing")
        solid.Shape = self.lever_shape()
        for name, x in (("left", 0), ("right", 200)):
            lever = self.instance(solid, name, Placement(Vector(x, 0, 0), Rotation(Z, 50)))
            self.document.recompute()
            top = self.edge(lever, Vector(x, 0, 20))
            marks.mark_anchor(lever, top, name)
            marks.mark_anchor(self.base.Group[0], self.edge(self.base.Group[0],
                                                             Vector(x, 0, 20)), name)
        self.assertEqual(self.check(), ["base", "left", "right"])
        self.assertNotIn("by its geometry", self.report)

    def edge(self, thing, center):
        for i, edge in enumerate(Part.getShape(thing).Edges, start=1):
            if isinstance(edge.Curve, Part.Circle) and (edge.Curve.Center - center).Length < 1e-6:
                return f"Edge{i}"
        raise AssertionError("no such circle")

    def test_poses_of_links_in_an_assembly_are_those_of_the_world(self):
        lever = self.part("lever", self.lever_shape())
        world = Placement(Vector(1, 2, 3), Rotation(Z, 77))
        marks.place(lever, world)
        self.assertLess((lever.getGlobalPlacement().Base - world.Base).Length, 1e-9)
        self.assertTrue(lever.getGlobalPlacement().Rotation.isSame(world.Rotation, 1e-9))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
