"""Every option of every command stands in a page of docs that is about the command, and every
option that a page shows with a command is one: options_test.py VMECH SOURCE"""

import pathlib
import re
import subprocess
import sys

import pages

OPTION = re.compile(r"(?<![\w-])--[a-z][a-z-]*")
SAID_IN_EVERY_HELP = {"--help", "--version"}


def help_of(vmech, *command):
    return subprocess.run([vmech, *command, "--help"], capture_output=True, text=True,
                          check=True).stdout


def commands_of(vmech):
    listed = help_of(vmech).split("Subcommands:")[1].split("Exit codes:")[0]
    return re.findall(r"^  ([a-z]+)\b", listed, re.M)


def options_of(vmech, command):
    """Those that begin a line of the help, long names."""
    lines = re.findall(r"^  (?:-\w,)?(--[a-z][a-z-]*)", help_of(vmech, command), re.M)
    return set(lines) - SAID_IN_EVERY_HELP


def calls_in(text):
    """(command, rest of the line) wherever `vmech command` is called; a line may be continued, by a
    backslash or by an indented bracket."""
    joined = re.sub(r"\\\n\s*|\n\s+(?=\[)", " ", text)
    return re.findall(r"\bvmech ([a-z]+)\b([^`\n]*)", joined)


def main():
    vmech, source = sys.argv[1], pathlib.Path(sys.argv[2])
    options = {command: options_of(vmech, command) for command in commands_of(vmech)}
    texts = {page: page.read_text(encoding="utf-8") for page in pages.guides(source)}
    problems = []
    for command, its_options in options.items():
        said = set()
        for text in texts.values():
            if re.search(rf"\bvmech {command}\b", text):
                said.update(OPTION.findall(text))
        problems += [f"vmech {command} {option} stands in no page that is about vmech {command}"
                     for option in sorted(its_options - said)]
    for page, text in texts.items():
        for command, rest in calls_in(text):
            unknown = set(OPTION.findall(rest)) - options.get(command, set()) - SAID_IN_EVERY_HELP
            problems += [f"{page.name}: vmech {command} has no option {option}"
                         for option in sorted(unknown) if command in options]
    count = sum(map(len, options.values()))
    print("\n".join(problems) or f"{count} options of {len(options)} commands stand in the docs")
    return 1 if problems or count < 50 else 0


if __name__ == "__main__":
    sys.exit(main())
