"""Fails if a C++ file is not formatted as .clang-format says.

Usage: clang_format.py CLANG_FORMAT
"""

import subprocess
import sys

from sources import ROOT, cpp_files


def main():
    command = [sys.argv[1], "--dry-run", "-Werror", "--style=file", *map(str, cpp_files())]
    status = subprocess.run(command, cwd=ROOT).returncode
    if status != 0:
        print("Format the files above with: clang-format-14 -i FILE")
    return status


if __name__ == "__main__":
    sys.exit(main())
