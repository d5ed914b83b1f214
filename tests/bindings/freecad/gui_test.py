"""gui_test.py VMECH ADDON: the commands of the FreeCAD workbench, in a window that nobody sees."""

import os
import pathlib
import sys
import tempfile
import traceback

HOME = tempfile.TemporaryDirectory()
os.environ.update(HOME=HOME.name, QT_QPA_PLATFORM="offscreen", VMECH=sys.argv[1])
sys.path += ["/usr/lib/freecad-python3/lib", "/usr/share/freecad/Mod",
             "/usr/share/freecad/Mod/Part", sys.argv[2]]
try:
    import FreeCAD
    import FreeCADGui
    import Part
except ImportError as error:
    print(f"skipped: {error}; install freecad-python3")
    sys.exit(77)


def select(thing, element=""):
    FreeCADGui.Selection.clearSelection()
    FreeCADGui.Selection.addSelection(thing.Document.Name, thing.Name, element)


def run():
    FreeCADGui.showMainWindow()
    addon = pathlib.Path(sys.argv[2])
    exec(compile((addon / "InitGui.py").read_text(), "InitGui.py", "exec"), {})  # as FreeCAD does
    FreeCADGui.activateWorkbench("VmechWorkbench")
    from vmech_freecad import gui
    answers, warnings = [], []
    gui.ask = lambda question, default="": answers.pop(0)
    gui.warn = warnings.append

    def press(name, *replies):
        answers.extend(replies)
        FreeCADGui.runCommand(name)
        assert not answers, f"{name} asked less than expected"

    document = FreeCAD.newDocument("door")
    for name, height in (("post", 100), ("wing", 80)):
        solid = document.addObject("Part::Feature", name)
        solid.Shape = Part.makeCylinder(10, height)
        select(solid, "Edge1")  # the circle at the top
        press("Vmech_Anchor", "hinge")
    press("Vmech_Export")
    assert "save the document first" in warnings.pop(), warnings
    document.saveAs(os.path.join(HOME.name, "door.FCStd"))
    select(document.getObjectsByLabel("post")[0])
    press("Vmech_Ground", "0 0 -9.81")
    select(document.getObjectsByLabel("wing")[0])
    press("Vmech_Density", "aluminium")
    press("Vmech_Check")
    press("Vmech_Loads", "hinge 60", "5")
    assert not warnings, warnings
    assert document.getObjectsByLabel("vmech loads"), "no arrows"
    press("Vmech_ClearLoads")
    assert not document.getObjectsByLabel("vmech loads"), "arrows are left"
    FreeCADGui.Selection.clearSelection()
    press("Vmech_Grasp")
    assert "select something first" in warnings.pop()


if __name__ == "__main__":
    code = 0
    try:
        run()
    except BaseException:  # FreeCAD would end with 0
        traceback.print_exc()
        code = 1
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code)  # the window does not close in order without a display
