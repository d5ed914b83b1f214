"""The commands of the workbench: ask, call the core, show what it says."""

import pathlib

import FreeCAD
import FreeCADGui
from PySide2 import QtWidgets

from . import command, marks, results


def ask(question, default=""):
    """A line of text from the user; None if they think better of it."""
    text, accepted = QtWidgets.QInputDialog.getText(None, "vmech", question, text=default)
    return text.strip() if accepted and text.strip() else None


def tell(text):
    """A report, to stay in the report view."""
    FreeCAD.Console.PrintMessage(text + "\n")


def warn(text):
    """What went wrong, in a window."""
    FreeCAD.Console.PrintError(text + "\n")
    QtWidgets.QMessageBox.warning(None, "vmech", text)


def selected():
    """The selected object and the name of its element, which may be empty."""
    selection = FreeCADGui.Selection.getSelectionEx()
    if not selection:
        raise marks.MarkError("select something first")
    names = selection[0].SubElementNames
    return selection[0].Object, names[0] if names else ""


def mechanism_path(document):
    """Beside the document, under its name."""
    if not document.FileName:
        raise marks.MarkError("save the document first: the mechanism file is written beside it")
    return pathlib.Path(document.FileName).with_suffix(".yaml")


def add_anchor():
    thing, element = selected()
    answer = ask("Joint, and its type if it is not revolute: elbow, or guide prismatic")
    if answer:
        marks.mark_anchor(thing, element, *answer.split(maxsplit=1))


def add_grasp():
    thing, element = selected()
    name = ask("Name of the grasp", "handle")
    if name:
        marks.mark_grasp(thing, element, name)


def set_density():
    thing, _ = selected()
    density = ask("Density of it, in kg/m^3, or a material", "steel")
    if density:
        marks.set_density(thing, density)


def set_ground():
    link = marks.link_of(selected()[0])
    gravity = ask("Gravity in the axes of the document, m/s^2", "0 0 -9.81")
    if gravity:
        marks.set_ground(link, FreeCAD.Vector(*map(float, gravity.split())))


def export():
    document = FreeCAD.ActiveDocument
    tell(command.export(document, mechanism_path(document)))


def check():
    document = FreeCAD.ActiveDocument
    path = mechanism_path(document)
    command.export(document, path)
    tell(command.run("check", path, accepted=(0, 3)))


def show_loads():
    document = FreeCAD.ActiveDocument
    path = mechanism_path(document)
    answer = ask("Driven joint and its speed in rpm", "main 60")
    if not answer:
        return
    joint, rpm = answer.rsplit(maxsplit=1)
    study = path.with_name(path.stem + "-study.yaml")
    folder = path.with_name(path.stem + "-loads")
    command.export(document, path, study=study, drives=[joint], rpm=float(rpm))
    command.loads(study, folder)
    loads = results.Loads(path, folder)
    pose = ask(f"Pose, 0 to {len(loads) - 1}", "0")
    results.show(document, loads, int(pose or 0) % len(loads))
    tell(f"All figures are in {folder / 'report.html'}")


def clear_loads():
    results.clear(FreeCAD.ActiveDocument)


class Command:
    """A function of this module as a command of FreeCAD."""

    def __init__(self, function, text, tip):
        self._function, self._text, self._tip = function, text, tip

    def GetResources(self):
        return {"MenuText": self._text, "ToolTip": self._tip}

    def IsActive(self):
        return FreeCAD.ActiveDocument is not None

    def Activated(self):
        try:
            self._function()
            FreeCAD.ActiveDocument.recompute()
        except (ValueError, TypeError, OSError, RuntimeError) as error:
            warn(str(error))


COMMANDS = {
    "Vmech_Anchor": Command(add_anchor, "Anchor", "An anchor of a joint on the selected circle"),
    "Vmech_Grasp": Command(add_grasp, "Grasp", "A grasp on the selected circle"),
    "Vmech_Density": Command(set_density, "Density", "Density of the selected solid or part"),
    "Vmech_Ground": Command(set_ground, "Ground", "The selected part stands still"),
    "Vmech_Export": Command(export, "Export", "Write the mechanism file beside the document"),
    "Vmech_Check": Command(check, "Check", "Links, joints, mobility, loops"),
    "Vmech_Loads": Command(show_loads, "Joint loads", "Run the mechanism, draw the joint forces"),
    "Vmech_ClearLoads": Command(clear_loads, "Clear loads", "Take the arrows away"),
}


def register():
    """Makes the commands known to FreeCAD. Returns their names."""
    for name, each in COMMANDS.items():
        FreeCADGui.addCommand(name, each)
    return list(COMMANDS)
