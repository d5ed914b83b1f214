"""House rules that a look at the text can judge. Prints file:line: what is wrong, fails if any."""

import re
import sys

from sources import CPP_SUFFIXES, ROOT, project_files, relative

MAX_COLUMNS = 100
CODE_SUFFIXES = CPP_SUFFIXES | {".py", ".cmake", ".sh"}
TEXT_SUFFIXES = CODE_SUFFIXES | {".md", ".txt", ".json", ".yaml", ".in"}
TEXT_NAMES = {"setup.sh", "run", ".clang-tidy", ".clang-format"}

# Written so that this file obeys its own rules.
FORBIDDEN = [
    (re.compile(r"\b(TO" r"DO|FIX" r"ME|X" r"XX)\b"), "unfinished work"),
    (re.compile(r"\bfor " r"now\b", re.IGNORECASE), "unfinished work"),
    (re.compile(r"(?<![\w.$}])/(home|work|root|Users)/\w"), "a path of one machine"),
    (re.compile(r"^(<<<<<<<|>>>>>>>) "), "a merge conflict"),
]



def line_problems(path, number, line):
    if path.suffix in CODE_SUFFIXES and len(line) > MAX_COLUMNS:
        yield number, f"{len(line)} columns, at most {MAX_COLUMNS}"
    for pattern, meaning in FORBIDDEN:
        match = pattern.search(line)
        if match:
            yield number, f"'{match.group(0).strip()}': {meaning}"


def file_problems(path):
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".h" and not re.search(r"^#pragma once$", text, re.MULTILINE):
        yield 1, "a header without #pragma once"
    if text and not text.endswith("\n"):
        yield text.count("\n") + 1, "no newline at the end of the file"
    for number, line in enumerate(text.split("\n"), start=1):
        yield from line_problems(path, number, line)


def main():
    files = project_files()
    problems = []
    for path in files:
        if path.suffix in TEXT_SUFFIXES or path.name in TEXT_NAMES:
            problems += [f"{relative(path)}:{line}: {what}" for line, what in file_problems(path)]
    print("\n".join(problems) or f"{len(files)} files of {ROOT.name} obey the text rules")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
