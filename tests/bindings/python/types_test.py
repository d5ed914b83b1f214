"""The stub says what the module has, and examples pass `mypy --strict`: types_test.py SOURCE ..."""

import importlib.util
import os
import pathlib
import subprocess
import sys
import tempfile

source = pathlib.Path(sys.argv[1])
if importlib.util.find_spec("mypy") is None:
    print("skipped: mypy is not installed")
    sys.exit(77)
# What pybind11 adds to every class: its metaclass, and a constructor where there is none.
ALLOWED = r"vmech\._vmech\.(Computed|Mechanism|Study|Tick)(\.__init__)?"
examples = sorted((source / "bindings/python/examples").glob("*.py"))
package = pathlib.Path(os.environ["PYTHONPATH"])
with tempfile.TemporaryDirectory() as folder:
    environment = dict(os.environ, MYPYPATH=str(package), MYPY_CACHE_DIR=folder)

    def run(*command):
        print(*command[:4], flush=True)
        subprocess.run([sys.executable, "-B", "-m", *map(str, command)], env=environment,
                       cwd=folder, check=True)

    allowed = pathlib.Path(folder) / "allowed"
    allowed.write_text(ALLOWED)
    run("mypy.stubtest", "vmech._vmech", "--allowlist", allowed, "--ignore-unused-allowlist")
    run("mypy", "--strict", "--ignore-missing-imports", package / "vmech", *examples)
