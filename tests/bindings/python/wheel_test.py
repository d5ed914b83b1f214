"""A wheel of the package, installed into a clean environment without a network, and run there:
wheel_test.py SOURCE BUILD CMAKE"""

import importlib.util
import pathlib
import subprocess
import sys
import tempfile
import venv

source, build, cmake = sys.argv[1:4]
for needed, package in (("wheel", "python3-wheel"), ("ensurepip", "python3-venv")):
    if importlib.util.find_spec(needed) is None:
        print(f"skipped: {package} is not installed")
        sys.exit(77)


def run(*command):
    subprocess.run(list(map(str, command)), check=True, cwd=folder, env={"PATH": "/usr/bin:/bin"})


with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    run(sys.executable, "-B", pathlib.Path(source) / "bindings/python/make_wheel.py", build, folder,
        "--cmake", cmake)
    [wheel] = folder.glob("vmech-*.whl")
    print(wheel.name, wheel.stat().st_size, "bytes")
    # numpy is Debian's; everything else of the environment is new.
    venv.create(folder / "clean", with_pip=True, system_site_packages=True)
    python = folder / "clean/bin/python3"
    run(python, "-m", "pip", "install", "--quiet", "--no-index", "--no-deps", wheel)
    run(python, "-B", "-c", "import vmech, sys; assert vmech.__file__.startswith(sys.prefix)")
    examples = pathlib.Path(source) / "mechanisms/examples"
    run(python, "-B", pathlib.Path(source) / "bindings/python/examples/four_bar_loads.py",
        examples / "four-bar-study.yaml")
    # The solver packages that are loaded late came along.
    ceres = "import vmech, sys; m = vmech.Mechanism.read(sys.argv[1]); " \
            "print(m.ik([0.5, 0.6, 0], grasp='midpoint', solver='ceres_exact').hand_errors)"
    run(python, "-B", "-c", ceres, examples / "four-bar.yaml")
