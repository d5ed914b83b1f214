"""Runs clang-tidy on the sources of the library and the apps, as .clang-tidy says.

Usage: clang_tidy.py CLANG_TIDY BUILD_FOLDER

Sources are looked at in batches (cmake/batches.py), as one source that includes them all. A batch
that is not clean is halved until it is, or one source is left. Most of the time goes into the
headers of Eigen and the standard library, once for a batch.

A source that passed is not looked at again until it, a header of the project that it includes, its
compile command, .clang-tidy or clang-tidy itself changes: BUILD_FOLDER/tidy holds one empty file,
named by a hash of all these, per clean source.
"""

import concurrent.futures
import dataclasses
import hashlib
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys

from sources import ROOT, relative

sys.path.insert(0, str(ROOT / "cmake"))
from batches import batches_of, with_included_headers

MODULES = ("base", "mechanisms", "solvers", "kinematics", "dynamics", "comparison", "hw_interface",
           "studies", "apps")
BATCH = 40  # sources; clang-tidy takes 1 GB for 20 of them
# What clang refuses: options of g++, and headers that g++ has precompiled.
GCC_ALONE = re.compile(r"-m(move|store)-max=\d+|-fpch-preprocess|-Winvalid-pch")
# The sources of a batch that is compiled as one.
BATCHED = re.compile(r'^#include "(/.+)"$', re.MULTILINE)


@dataclasses.dataclass
class Source:
    path: pathlib.Path
    flags: list
    passed: pathlib.Path  # exists if the source is known to be clean


def clang_flags(command):
    """The options of a compile command as clang takes them, without source and output."""
    words = iter(shlex.split(command))
    flags = []
    for word in words:
        if word in ("-o", "-c") or word == "-include":
            next(words)
        elif word == "-isystem":
            flags.append(word + next(words))
        elif word.startswith("-") and not GCC_ALONE.fullmatch(word):
            flags.append(word)
    return flags


def fingerprint(path, flags, tidy_version):
    digest = hashlib.sha256(f"{tidy_version}\n{flags}\n".encode())
    for file in [ROOT / ".clang-tidy", *sorted(with_included_headers(path))]:
        digest.update(f"{relative(file)}\n".encode() + file.read_bytes())
    return digest.hexdigest()


def sources_of(path):
    """The sources that are compiled by way of this one: itself, or those of a batch."""
    if path.parent.name != "Unity":
        return [path]
    return [pathlib.Path(included) for included in BATCHED.findall(path.read_text())]


def sources_of_modules(build, cache, tidy_version):
    """The sources of the modules in the compile database."""
    sources = {}
    for entry in json.loads((build / "compile_commands.json").read_text()):
        flags = clang_flags(entry["command"])
        for path in sources_of(pathlib.Path(entry["file"])):
            if ROOT in path.parents and path.relative_to(ROOT).parts[0] in MODULES:
                sources[path] = Source(path, flags, cache / fingerprint(path, flags, tidy_version))
    return [sources[path] for path in sorted(sources)]


def run(tidy, path, flags):
    """What clang-tidy finds; None if nothing."""
    result = subprocess.run(
        [tidy, f"--config-file={ROOT / '.clang-tidy'}", "--quiet", str(path), "--", *flags,
         "-Wno-unknown-warning-option"], capture_output=True, text=True)
    return None if result.returncode == 0 else result.stdout + result.stderr


def check(tidy, batch, unity):
    """The findings in a batch of sources, by way of the source `unity`."""
    unity.write_text("".join(f'#include "{source.path}"\n' for source in batch))
    flags = list(dict.fromkeys(sum((source.flags for source in batch), [])))
    found = run(tidy, batch[0].path if len(batch) == 1 else unity, flags)
    if not found:
        for source in batch:
            source.passed.touch()
        return []
    if len(batch) == 1:
        return [found]
    half = len(batch) // 2
    return check(tidy, batch[:half], unity) + check(tidy, batch[half:], unity)


def main():
    tidy, build = sys.argv[1], pathlib.Path(sys.argv[2])
    cache = build / "tidy"
    cache.mkdir(exist_ok=True)
    version = subprocess.run([tidy, "--version"], capture_output=True, text=True, check=True).stdout
    sources = sources_of_modules(build, cache, version)
    if not sources:
        print("the compile database names no source of a module")
        return 1
    waiting = {source.path: source for source in sources if not source.passed.exists()}
    batches = [[waiting[path] for path in batch] for batch in batches_of(waiting, BATCH)]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        checks = [pool.submit(check, tidy, batch, cache / f"batch_{number}.cc")
                  for number, batch in enumerate(batches)]
        findings = sum((task.result() for task in checks), [])
    print("\n".join(findings) or f"{len(sources)} sources are clean")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
