"""The page's glTF files under gltf-validator of npm. Usage: gltf_test.py NODE NPM FOLDER

FOLDER holds what page_test.py has saved. Where npm cannot be reached, the test is skipped."""

import pathlib
import subprocess
import sys

VALIDATOR = "gltf-validator@2.0.0-dev.3.10"
SKIPPED = 77

node, npm, folder = sys.argv[1], sys.argv[2], pathlib.Path(sys.argv[3])
modules = folder / "npm"
modules.mkdir(exist_ok=True)
if not (modules / "node_modules" / "gltf-validator").exists():
    install = subprocess.run(
        [npm, "install", "--prefix", modules, "--no-save", "--no-package-lock",
         "--ignore-scripts", "--no-audit", "--no-fund", VALIDATOR],
        capture_output=True, text=True, check=False, timeout=120)
    if install.returncode != 0:
        print(f"{VALIDATOR} could not be installed:\n{install.stderr}")
        sys.exit(SKIPPED)
files = sorted(folder.glob("*.gltf"))
sys.exit(subprocess.run([node, pathlib.Path(__file__).with_name("validate_gltf.js"),
                         modules / "node_modules", *files], check=False).returncode)
