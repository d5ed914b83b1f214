"""Mechanisms from FreeCAD documents: marks on parts, the vmech command, loads on the parts."""
