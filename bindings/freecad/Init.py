# FreeCAD runs this at every start. The add-on has no file formats of its own.
