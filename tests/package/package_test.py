"""Packs the build for Debian, unpacks the package elsewhere and runs the command from there.

Usage: package_test.py CPACK BUILD_FOLDER EXAMPLES
"""

import pathlib
import re
import subprocess
import sys
import tempfile

NEEDED = ("libc6", "libfmt9", "libyaml-cpp0.7")
NOT_NEEDED = ("libgtest", "libbenchmark", "valgrind")


def output_of(*command):
    return subprocess.run(list(map(str, command)), capture_output=True, text=True,
                          check=True).stdout


def main():
    cpack, build, examples = sys.argv[1], sys.argv[2], pathlib.Path(sys.argv[3])
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        output_of(cpack, "--config", f"{build}/CPackConfig.cmake", "-B", root / "made")
        [package] = (root / "made").glob("*.deb")
        depends = output_of("dpkg-deb", "--field", package, "Depends")
        for name in NEEDED:
            assert name in depends, f"Depends: lacks {name}: {depends}"
        for name in NOT_NEEDED:
            assert name not in depends, f"Depends: {name} is not needed: {depends}"
        output_of("dpkg-deb", "--extract", package, root / "unpacked")
        vmech = root / "unpacked/usr/bin/vmech"
        version = output_of(vmech, "--version")
        assert re.match(r"vmech \d+\.\d+\.\d+\ncommit ", version), version
        print(version, end="")
        print(output_of(vmech, "loads", examples / "slider-crank-study.yaml", "--out",
                        root / "report"), end="")
        assert (root / "report/report.html").stat().st_size > 10_000


main()
