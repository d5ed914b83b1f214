"""Compiles a source; a batch of sources that does not compile as one, source by source.

Usage: compile_batch.py COMPILER ARGUMENT... -o OBJECT -c SOURCE

Sources of a batch (cmake/VmechBatches.cmake) may clash in a name that each has for itself. Then
they are compiled one at a time and their objects joined, so that a batch is never an error that its
sources alone are not.
"""

import pathlib
import re
import subprocess
import sys

INCLUDED = re.compile(r'^#include "(.+)"$', re.MULTILINE)


def value_of(option, command):
    return command[command.index(option) + 1]


def with_value(option, value, command):
    at = command.index(option) + 1
    return command[:at] + [str(value)] + command[at + 1:]


def succeeds(command):
    """Runs the command with its messages shown."""
    return subprocess.run(command).returncode == 0


def compile_each(command, sources):
    """Compiles the sources one by one into the object of the command."""
    target = value_of("-o", command)
    objects = [f"{target}.{number}.o" for number in range(len(sources))]
    each = [with_value("-o", part, with_value("-c", source, command))
            for source, part in zip(sources, objects)]
    # What the object depends on: the headers of all sources, found by the preprocessor alone.
    depend = with_value("-o", "/dev/null", command) + ["-E"]
    compiler = command[:next(at for at, word in enumerate(command) if word.startswith("-"))]
    joined = [*compiler, "-r", "-o", target, *objects]
    try:
        return all(succeeds(part) for part in [*each, depend, joined])
    finally:
        for part in objects:
            pathlib.Path(part).unlink(missing_ok=True)


def main():
    command = sys.argv[1:]
    source = pathlib.Path(value_of("-c", command))
    sources = INCLUDED.findall(source.read_text()) if source.parent.name == "Unity" else []
    if len(sources) < 2:
        return 0 if succeeds(command) else 1
    whole = subprocess.run(command, capture_output=True, text=True)
    if whole.returncode == 0:
        sys.stderr.write(whole.stderr)
        return 0
    print(f"{source.name} does not compile as one source: {len(sources)} are compiled alone\n"
          + "\n".join(whole.stderr.splitlines()[:12]))
    return 0 if compile_each(command, sources) else 1


if __name__ == "__main__":
    sys.exit(main())
