"""What a document says about its mechanism, all of it visible in the tree.

A link is an App::Part with all that is in it, or an App::Link to something solid: an instance. An
App::Part that holds nothing but parts and instances is an assembly, whose members are links; plain
groups are looked through. A local coordinate system called anchor_JOINT, one on each of two links,
is a joint; grasp_NAME is a grasp. Density, ground and gravity are properties of the objects they
belong to (group "vmech").
"""

import contextlib

import FreeCAD
import Part

JOINT_TYPES = ("revolute", "prismatic", "cylindrical", "universal", "spherical", "planar", "weld")
GRAVITY = FreeCAD.Vector(0, 0, -9.81)  # m/s^2
GROUP = "vmech"
FOLDER = "App::DocumentObjectGroup"
MARKS = ("anchor_", "dof_", "closing_", "fix_", "frame_", "grasp_")


class MarkError(ValueError):
    """What was selected or asked for cannot be; the text says why."""


def links(document):
    """Parts and instances that are links, in the order of the document."""
    return [thing for thing in document.Objects
            if _can_be_link(thing) and not is_assembly(thing) and any(solids(thing))
            and all(is_assembly(group) for group in groups_around(thing))]


def groups_around(thing):
    """The parts that an object stands in, the innermost first."""
    group = thing.getParentGeoFeatureGroup()
    while group is not None:
        yield group
        group = group.getParentGeoFeatureGroup()


def is_assembly(part):
    """True for an App::Part of nothing but links: neither a solid nor a mark is directly in it."""
    if part.TypeId != "App::Part":
        return False
    members = _members(part)
    return (any(_can_be_link(member) and any(solids(member)) for member in members)
            and not any(_is_mark(member) or _is_solid(member) for member in members))


def is_container(link):
    """True for a link that is a group of the STEP file; else it is one shape there."""
    shown = link.getLinkedObject()
    return (shown.TypeId in ("App::Part", "App::LinkGroup")
            or getattr(link, "ElementCount", 0) > 0)


def file_name(label):
    """The name that `vmech import` gives to what is called so in the document."""
    return "".join("_" if c in '/,"\\' else c for c in label).strip()


def solids(link):
    """The objects with solids in a link, at any depth; of a PartDesign body only the body."""
    if _is_instance(link):
        yield link
    for member in _members(link) if link.TypeId == "App::Part" else ():
        if member.TypeId == "App::Part":
            yield from solids(member)
        elif _is_instance(member) or _is_solid(member):
            yield member


def roots(document):
    """The outermost objects that hold all links: what is to be exported."""
    found = []
    for link in links(document):
        root = [link, *groups_around(link)][-1]
        if root not in found:
            found.append(root)
    return found


@contextlib.contextmanager
def emptied_folders(document):
    """Empties the folders of parts for a while: FreeCAD writes what is in one twice, as a member of
    the folder and of the part."""
    folders = [(thing, thing.Group) for thing in document.Objects
               if thing.TypeId == FOLDER and thing.getParentGeoFeatureGroup() is not None]
    try:
        for folder, _ in folders:
            folder.Group = []
        yield
    finally:
        for folder, members in folders:
            folder.Group = members


def place(link, placement):
    """Puts a link at a placement in the axes of the document [mm]."""
    link.Placement = global_placement_of_group(link).inverse() * placement


def global_placement_of_group(thing):
    """Of the axes in which an object's placement is given."""
    group = thing.getParentGeoFeatureGroup()
    return FreeCAD.Placement() if group is None else group.getGlobalPlacement()


def link_of(thing):
    """The link of an object, as a part that can hold marks. A solid or an instance that stands
    alone becomes a part of its own name."""
    outermost = [each for each in (thing, *groups_around(thing)) if not is_assembly(each)][-1]
    if outermost.TypeId == "App::Part":
        return outermost
    group = outermost.getParentGeoFeatureGroup()
    link = thing.Document.addObject("App::Part", "Link")
    name = outermost.Label
    outermost.Label = name + "-solid"
    link.Label = name
    if group is not None:
        group.addObject(link)
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


def _members(part):
    """What is in a part; FreeCAD counts what is in its folders, too."""
    return [member for member in part.Group if member.TypeId != FOLDER]


def _can_be_link(thing):
    return thing.TypeId == "App::Part" or _is_instance(thing)


def _is_instance(thing):
    """True for an App::Link, or a group of them, that shows a solid."""
    return thing.TypeId in ("App::Link", "App::LinkGroup") and bool(Part.getShape(thing).Solids)


def _is_solid(thing):
    return thing.isDerivedFrom("Part::Feature") and bool(thing.Shape.Solids)


def _is_mark(thing):
    return thing.Label.lower().startswith(MARKS)


def _name(text):
    text = text.strip()
    if not text or any(c in text for c in '/,"\\=') or "__" in text:
        raise MarkError("a name has at least one character, and none of / , \" \\ = nor '__'")
    return text


def _mark(thing, element, label):
    if isinstance(element, str):
        element = Part.getShape(thing, element, needSubElement=True)
    placement = frame_on(element)
    # Elements of a shape stand in the axes of the group that holds the object.
    to_world = global_placement_of_group(thing)
    link = link_of(thing)
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
