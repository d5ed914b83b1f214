"""What a document says about its mechanism, all of it visible in the tree.

A link is an App::Part that stands in no other one, with all that is in it. A local coordinate
system called anchor_JOINT, one on each of two links, is a joint; grasp_NAME is a grasp. Density,
ground and gravity are properties of the objects they belong to (group "vmech").
"""

import FreeCAD
import Part

JOINT_TYPES = ("revolute", "prismatic", "cylindrical", "universal", "spherical", "planar", "weld")
GRAVITY = FreeCAD.Vector(0, 0, -9.81)  # m/s^2
GROUP = "vmech"


class MarkError(ValueError):
    """What was selected or asked for cannot be; the text says why."""


def links(document):
    """The App::Parts that stand in no other one and hold a solid."""
    return [part for part in document.Objects
            if part.TypeId == "App::Part" and part.getParentGeoFeatureGroup() is None
            and any(solids(part))]


def solids(link):
    """The objects with solids in a link, at any depth; of a PartDesign body only the body."""
    for child in link.Group:
        if child.TypeId == "App::Part":
            yield from solids(child)
        elif getattr(child, "Shape", None) is not None and child.Shape.Solids:
            yield child


def link_of(thing):
    """The link of an object. One that stands alone becomes a link of its own name."""
    outermost = thing
    while outermost.getParentGeoFeatureGroup() is not None:
        outermost = outermost.getParentGeoFeatureGroup()
    if outermost.TypeId == "App::Part":
        return outermost
    link = thing.Document.addObject("App::Part", "Link")
    name = outermost.Label
    outermost.Label = name + "-solid"
    link.Label = name
    link.addObject(outermost)
    return link


def frame_on(element):
    """A placement on a piece of a shape: z the axis of a circle or cylinder, or the normal of a
    plane; origin in its middle."""
    curve = getattr(element, "Curve", None) if element.ShapeType == "Edge" else None
    if isinstance(curve, Part.Circle):
        return _placement(curve.Center, curve.Axis)
    surface = getattr(element, "Surface", None) if element.ShapeType == "Face" else None
    if isinstance(surface, Part.Cylinder):
        low, high = element.ParameterRange[2:]
        return _placement(surface.Center + 0.5 * (low + high) * surface.Axis, surface.Axis)
    if isinstance(surface, Part.Sphere):
        return _placement(surface.Center, FreeCAD.Vector(0, 0, 1))
    if isinstance(surface, Part.Plane):
        return _placement(element.CenterOfMass, element.normalAt(0, 0))
    raise MarkError("select a circle, a cylinder, a sphere or a plane face")


def mark_anchor(thing, element, joint, kind=None):
    """An anchor of a joint on the named element ("Edge3") of an object. Returns it."""
    if kind is not None and kind not in JOINT_TYPES:
        raise MarkError(f"'{kind}' is no type of joint: " + ", ".join(JOINT_TYPES))
    return _mark(thing, element, "anchor_" + _name(joint) + (f"__{kind}" if kind else ""))


def mark_grasp(thing, element, name, point=False):
    """A frame by which a hand holds the link; `point`: by its position only."""
    return _mark(thing, element, "grasp_" + _name(name) + ("__point" if point else ""))


def set_density(thing, density):
    """Of a solid, or of all in a link: kg/m^3 or the name of a material that vmech knows."""
    _property(thing, "App::PropertyString", "VmechDensity", "kg/m^3, or a material")
    thing.VmechDensity = str(density)


def set_ground(link, gravity=GRAVITY):
    """The link that stands still, and gravity [m/s^2] in the axes of the document."""
    for other in links(link.Document):
        if hasattr(other, "VmechGround"):
            other.VmechGround = False
    _property(link, "App::PropertyBool", "VmechGround", "stands still")
    _property(link, "App::PropertyVector", "VmechGravity", "m/s^2, if this is the ground")
    link.VmechGround = True
    link.VmechGravity = FreeCAD.Vector(gravity)


def ground(document):
    """The link that stands still, or None."""
    marked = [link for link in links(document) if getattr(link, "VmechGround", False)]
    return marked[0] if marked else None


def densities(document):
    """Label and density of everything that has one, links after what is in them."""
    for link in links(document):
        for thing in (*solids(link), link):
            if getattr(thing, "VmechDensity", ""):
                yield thing.Label, thing.VmechDensity


def _name(text):
    text = text.strip()
    if not text or any(c in text for c in '/,"\\=') or "__" in text:
        raise MarkError("a name has at least one character, and none of / , \" \\ = nor '__'")
    return text


def _mark(thing, element, label):
    if isinstance(element, str):
        element = thing.Shape.getElement(element)
    placement = frame_on(element)
    link = link_of(thing)
    # Elements of a shape stand in the axes of the group that holds the object.
    to_world = thing.getGlobalPlacement() * thing.Placement.inverse()
    frame = link.Document.addObject("PartDesign::CoordinateSystem", "LCS")
    frame.Label = label
    link.addObject(frame)
    frame.Placement = link.getGlobalPlacement().inverse() * to_world * placement
    return frame


def _placement(origin, axis):
    return FreeCAD.Placement(origin, FreeCAD.Rotation(FreeCAD.Vector(0, 0, 1), axis))


def _property(thing, kind, name, text):
    if not hasattr(thing, name):
        thing.addProperty(kind, name, GROUP, text)
