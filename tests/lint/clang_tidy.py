"""Runs clang-tidy on the sources of the library and the apps, as .clang-tidy says.

Usage: clang_tidy.py CLANG_TIDY BUILD_FOLDER

A source that passed is not looked at again until it, a header of the project that it includes, its
compile command, .clang-tidy or clang-tidy itself changes: BUILD_FOLDER/tidy holds one empty file,
named by a hash of all these, per clean source.
"""

import concurrent.futures
import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys

from sources import ROOT, relative

MODULES = ("mechanisms", "solvers", "kinematics", "dynamics", "comparison", "hw_interface",
           "apps")
# What clang refuses: options of g++, and headers that g++ has precompiled.
GCC_ALONE = re.compile(r" -m(move|store)-max=\d+| -Winvalid-pch| -include \S+/cmake_pch\.hxx")
INCLUDE = re.compile(r'^#include "vmech/([^"]+)"', re.MULTILINE)


def compile_commands(build):
    """The entry of each source of a module in the compile database, as clang takes it."""
    commands = {}
    for entry in json.loads((build / "compile_commands.json").read_text()):
        path = pathlib.Path(entry["file"])
        if ROOT in path.parents and path.relative_to(ROOT).parts[0] in MODULES:
            commands[path] = entry | {"command": GCC_ALONE.sub("", entry["command"])}
    return commands


def with_included_headers(source):
    """The source and the project's headers that it includes, directly or not."""
    found, waiting = set(), [source]
    while waiting:
        path = waiting.pop()
        if path not in found and path.is_file():
            found.add(path)
            waiting += [ROOT / name for name in INCLUDE.findall(path.read_text())]
    return sorted(found)


def fingerprint(source, command, tidy_version):
    digest = hashlib.sha256(f"{tidy_version}\n{command}\n".encode())
    for path in [ROOT / ".clang-tidy", *with_included_headers(source)]:
        digest.update(f"{relative(path)}\n".encode() + path.read_bytes())
    return digest.hexdigest()


def check(source, tidy, database, passed):
    """The findings in one source; None if there are none."""
    if passed.exists():
        return None
    result = subprocess.run(
        [tidy, "-p", str(database), "--quiet", "--extra-arg=-Wno-unknown-warning-option",
         str(source)],
        capture_output=True, text=True)
    if result.returncode == 0:
        passed.touch()
        return None
    return result.stdout + result.stderr


def main():
    tidy, build = sys.argv[1], pathlib.Path(sys.argv[2])
    cache = build / "tidy"
    cache.mkdir(exist_ok=True)
    version = subprocess.run([tidy, "--version"], capture_output=True, text=True, check=True).stdout
    commands = compile_commands(build)
    if not commands:
        print("the compile database names no source of a module")
        return 1
    (cache / "compile_commands.json").write_text(json.dumps(list(commands.values())))
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        checks = [pool.submit(check, source, tidy, cache,
                              cache / fingerprint(source, entry["command"], version))
                  for source, entry in commands.items()]
        findings = [found for found in (task.result() for task in checks) if found]
    print("\n".join(findings) or f"{len(commands)} sources are clean")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
