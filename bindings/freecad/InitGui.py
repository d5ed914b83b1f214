"""The workbench, which FreeCAD's window makes of this file at its start."""

import FreeCADGui


class VmechWorkbench(FreeCADGui.Workbench):
    """Mechanisms: anchors, densities, joint loads."""

    MenuText = "vmech"
    ToolTip = "Joints, masses and joint loads of mechanisms"

    def Initialize(self):
        from vmech_freecad import gui
        names = gui.register()
        self.appendToolbar("vmech", names)
        self.appendMenu("vmech", names)

    def GetClassName(self):
        return "Gui::PythonWorkbench"


FreeCADGui.addWorkbench(VmechWorkbench())
