"""Runs clang-tidy on the sources of the library and the apps, as .clang-tidy says.

Usage: clang_tidy.py CLANG_TIDY BUILD_FOLDER

Nine tenths of the time of a source go into the headers of Eigen and the standard library. So
sources are looked at in batches, as one source that includes them all. Two that give a name of
their own to different things are not put into one batch; a batch that is not clean is halved until
it is, or one source is left.

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

MODULES = ("base", "mechanisms", "solvers", "kinematics", "dynamics", "comparison", "hw_interface",
           "studies", "apps")
BATCH = 20  # sources; clang-tidy takes about 1 GB for them
INCLUDE = re.compile(r'^#include "vmech/([^"]+)"', re.MULTILINE)
# What clang refuses: options of g++, and headers that g++ has precompiled.
GCC_ALONE = re.compile(r"-m(move|store)-max=\d+|-fpch-preprocess|-Winvalid-pch")
# What stands between `namespace {` and its end, and the names that are defined there at the left
# margin.
HIDDEN = re.compile(r"^namespace \{$(.*?)^\}  // namespace$", re.MULTILINE | re.DOTALL)
AT_MARGIN = re.compile(r"^(?!//|#|\}|template)\S.*$", re.MULTILINE)
DEFINED = re.compile(r"^(?:struct|class|enum class) (\w+)"
                     r"|[\w>&*] ([A-Za-z]\w*)(?:\[.*\])?(?:\(| = |\{|;)"
                     r"|, ([A-Za-z]\w*) = ", re.MULTILINE)
ALIAS = re.compile(r"namespace|using")  # clash only if they differ
MAIN = re.compile(r"^int (main)\(", re.MULTILINE)


@dataclasses.dataclass
class Source:
    path: pathlib.Path
    flags: list
    passed: pathlib.Path  # exists if the source is known to be clean

    def hidden_names(self):
        """Names of what only this source sees, by which it may clash with others."""
        text = self.path.read_text()
        lines = AT_MARGIN.findall("".join(HIDDEN.findall(text)))
        defined = DEFINED.findall("\n".join(line for line in lines if not ALIAS.match(line)))
        return {name for names in defined for name in names if name} | set(MAIN.findall(text))


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


def with_included_headers(source):
    """The source and the project's headers that it includes, directly or not."""
    found, waiting = set(), [source]
    while waiting:
        path = waiting.pop()
        if path not in found and path.is_file():
            found.add(path)
            waiting += [ROOT / name for name in INCLUDE.findall(path.read_text())]
    return sorted(found)


def fingerprint(path, flags, tidy_version):
    digest = hashlib.sha256(f"{tidy_version}\n{flags}\n".encode())
    for file in [ROOT / ".clang-tidy", *with_included_headers(path)]:
        digest.update(f"{relative(file)}\n".encode() + file.read_bytes())
    return digest.hexdigest()


def sources_of_modules(build, cache, tidy_version):
    """The sources of the modules in the compile database."""
    sources = {}
    for entry in json.loads((build / "compile_commands.json").read_text()):
        path = pathlib.Path(entry["file"])
        if ROOT in path.parents and path.relative_to(ROOT).parts[0] in MODULES:
            flags = clang_flags(entry["command"])
            sources[path] = Source(path, flags, cache / fingerprint(path, flags, tidy_version))
    return [sources[path] for path in sorted(sources)]


def batches_of(sources):
    """Sources in batches of at most BATCH, in which no two define the same name of their own."""
    batches = []  # pairs of sources and their names
    for source in sources:
        names = source.hidden_names()
        for batch, taken in batches:
            if len(batch) < BATCH and not names & taken:
                batch.append(source)
                taken |= names
                break
        else:
            batches.append(([source], names))
    return [batch for batch, _ in batches]


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
    batches = batches_of([source for source in sources if not source.passed.exists()])
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        checks = [pool.submit(check, tidy, batch, cache / f"batch_{number}.cc")
                  for number, batch in enumerate(batches)]
        findings = sum((task.result() for task in checks), [])
    print("\n".join(findings) or f"{len(sources)} sources are clean")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
