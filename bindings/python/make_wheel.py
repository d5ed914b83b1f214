"""Packs the Python package of a build as a wheel: make_wheel.py BUILD FOLDER [--cmake CMAKE]

By `cmake --install` and `python3 -m wheel pack`; nothing is downloaded.
"""

import argparse
import pathlib
import subprocess
import sys
import sysconfig
import tempfile

METADATA = """Metadata-Version: 2.1
Name: vmech
Version: {version}
Summary: Mechanisms: closed-chain kinematics, joint loads and bearings
Requires-Python: >=3.9
Requires-Dist: numpy
"""
WHEEL = """Wheel-Version: 1.0
Generator: vmech
Root-Is-Purelib: false
Tag: {tag}
"""


def tag():
    """For this version of Python on this kind of machine."""
    version = f"cp{sys.version_info.major}{sys.version_info.minor}"
    platform = sysconfig.get_platform().replace("-", "_").replace(".", "_")
    return f"{version}-{version}-{platform}"


def version_of(cache):
    [line] = [line for line in cache.read_text().splitlines()
              if line.startswith("CMAKE_PROJECT_VERSION:")]
    return line.partition("=")[2]


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--cmake", default="cmake")
    arguments = parser.parse_args()
    version = version_of(arguments.build / "CMakeCache.txt")
    with tempfile.TemporaryDirectory() as name:
        root = pathlib.Path(name)
        subprocess.run([arguments.cmake, "--install", arguments.build, "--component", "wheel",
                        "--prefix", root], check=True, stdout=subprocess.DEVNULL)
        info = root / f"vmech-{version}.dist-info"
        info.mkdir()
        (info / "METADATA").write_text(METADATA.format(version=version))
        (info / "WHEEL").write_text(WHEEL.format(tag=tag()))
        subprocess.run([sys.executable, "-m", "wheel", "pack", root, "--dest-dir",
                        arguments.folder], check=True)


main()
