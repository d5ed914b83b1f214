"""Runs the example that plots, where matplotlib is installed: plot_test.py SOURCE BUILD CMAKE"""

import importlib.util
import pathlib
import runpy
import sys
import tempfile

source = pathlib.Path(sys.argv[1])
if importlib.util.find_spec("matplotlib") is None:
    print("skipped: python3-matplotlib is not installed")
    sys.exit(77)
with tempfile.TemporaryDirectory() as folder:
    picture = pathlib.Path(folder) / "loads.svg"
    sys.argv = ["plot_loads.py", str(source / "mechanisms/examples/four-bar-study.yaml"),
                str(picture)]
    runpy.run_path(str(source / "bindings/python/examples/plot_loads.py"), run_name="__main__")
    drawing = picture.read_text()
# An axis with a curve for each of four joints: a legend entry draws each again.
assert drawing.count("clip-path") >= 4, drawing[:400]
print(f"{len(drawing)} bytes of picture")
