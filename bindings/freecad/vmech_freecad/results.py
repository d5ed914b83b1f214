"""Results of `vmech loads` on the model: links in their poses, joint forces as arrows."""

import csv
import pathlib

import FreeCAD
import Part
import yaml

from . import marks

MILLIMETRES = 1000  # per metre
SHOWN = "vmech loads"
SHORTEST = 1e-3  # of the longest arrow; below it nothing would be seen


class Loads:
    """A mechanism file and the folder that `vmech loads` wrote for it."""

    def __init__(self, mechanism, folder):
        with open(mechanism, encoding="utf-8") as file:
            self._mechanism = yaml.safe_load(file)
        self._loads = _rows(pathlib.Path(folder) / "loads.csv")
        self._motion = _rows(pathlib.Path(folder) / "motion.csv")

    def __len__(self):
        return len(self._loads)

    def joints(self):
        return list(self._mechanism["joints"])

    def moving_links(self):
        return [link for link in self._mechanism["links"] if link != self._mechanism["ground"]]

    def placement(self, link, pose):
        """Of a link's drawing axes in the world [mm]."""
        if link == self._mechanism["ground"]:
            return FreeCAD.Placement()
        row = self._motion[pose]
        x, y, z, qw, qx, qy, qz = (row[f"{link}.{key}"] for key in
                                   ("x", "y", "z", "qw", "qx", "qy", "qz"))
        return FreeCAD.Placement(MILLIMETRES * FreeCAD.Vector(x, y, z),
                                 FreeCAD.Rotation(qx, qy, qz, qw))

    def force(self, joint, pose):
        """Where the first link of a joint pushes on the second [mm], and how [N], in the world."""
        first, second = (side.split("/") for side in self._mechanism["joints"][joint]["connects"])
        row = self._loads[pose]
        in_anchor = FreeCAD.Vector(*(row[f"{joint}.{key}"] for key in ("fx", "fy", "fz")))
        axes = self.placement(first[0], pose).Rotation * self._anchor(*first).Rotation
        at = self.placement(second[0], pose) * self._anchor(*second)
        return at.Base, axes.multVec(in_anchor)

    def _anchor(self, link, name):
        frame = self._mechanism["links"][link]["anchors"][name] or {}
        per_unit = 1 if self._mechanism.get("units", {}).get("length") == "mm" else MILLIMETRES
        origin = per_unit * FreeCAD.Vector(*frame.get("origin", (0, 0, 0)))
        z = FreeCAD.Vector(*frame.get("z", (0, 0, 1)))
        x = FreeCAD.Vector(*frame.get("x", (1, 0, 0)))
        return FreeCAD.Placement(origin, FreeCAD.Rotation(x, z.cross(x), z, "ZXY"))


def show(document, loads, pose=0, longest=None):
    """Moves the links to a pose and draws the force at every joint, on its second link by its
    first. The longest arrow of the whole cycle is `longest` [mm], by default a third of the
    largest solid. Returns the group of arrows."""
    clear(document)
    for link in marks.links(document):
        name = marks.file_name(link.Label)
        if name in loads.moving_links():
            marks.place(link, loads.placement(name, pose))
    largest = max((loads.force(joint, i)[1].Length
                   for joint in loads.joints() for i in range(len(loads))), default=0)
    longest = longest or _size(document) / 3
    per_newton = longest / largest if largest > 0 else 0
    group = document.addObject("App::DocumentObjectGroup", "VmechLoads")
    group.Label = SHOWN
    for joint in loads.joints():
        point, force = loads.force(joint, pose)
        if force.Length * per_newton < SHORTEST * longest:
            continue
        arrow = document.addObject("Part::Feature", "Load")
        arrow.Label = f"{joint}: {force.Length:.4g} N"
        arrow.Shape = _arrow(point, per_newton * force)
        group.addObject(arrow)
    document.recompute()
    return group


def clear(document):
    """Takes the arrows away."""
    for group in document.getObjectsByLabel(SHOWN):
        group.removeObjectsFromDocument()
        document.removeObject(group.Name)


def _arrow(point, vector):
    length, direction = vector.Length, FreeCAD.Vector(vector).normalize()
    radius, head = length / 50, length / 5
    shaft = Part.makeCylinder(radius, length - head, point, direction)
    cone = Part.makeCone(2.5 * radius, 0, head, point + (length - head) * direction, direction)
    return Part.makeCompound([shaft, cone])


def _size(document):
    """The largest solid, from corner to corner."""
    return max((Part.getShape(solid).BoundBox.DiagonalLength
                for link in marks.links(document) for solid in marks.solids(link)), default=0)


def _rows(path):
    with open(path, newline="", encoding="utf-8") as file:
        return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
