"""The programs in C++ and C, and what they say to CMake, that the guides show are those that are
compiled as tests: programs_test.py SOURCE

A program is a whole source, or an excerpt of one: its lines in their order, some left out, indented
as may be. The programs in Python are run by commands_test.py.
"""

import pathlib
import sys

import pages

# Folders of sources that are compiled as tests, and what is in them.
TESTED = ("tests/bindings/c", "tests/consumer")
SUFFIXES = {"cpp": (".cc",), "c": (".c",), "cmake": (".txt",)}
# tests/hw_interface compiles this page's program itself.
ELSEWHERE = ("device-plugin.md",)
MOST_LINES = 30


def written(text):
    return [line.strip() for line in text.splitlines() if line.strip()]


def is_excerpt(lines, source):
    """Are the lines in the source, one after the other?"""
    rest = iter(source)
    return all(any(line == other for other in rest) for line in lines)


def main():
    source = pathlib.Path(sys.argv[1])
    sources = [path for folder in TESTED for path in (source / folder).rglob("*")
               if path.is_file()]
    texts = {path: written(path.read_text(encoding="utf-8")) for path in sources}
    problems, shown = [], 0
    for page in pages.guides(source):
        for line, language, text, _ in pages.code_blocks(page):
            if language not in SUFFIXES or page.name in ELSEWHERE:
                continue
            shown += 1
            where = f"{page.relative_to(source)}:{line}"
            program = written(text)
            if not any(path.suffix in SUFFIXES[language] and is_excerpt(program, lines)
                       for path, lines in texts.items()):
                problems.append(f"{where}: this is no part of a source in {' or '.join(TESTED)}")
            if len(program) > MOST_LINES:
                problems.append(f"{where}: {len(program)} lines, at most {MOST_LINES}")
    print("\n".join(problems) or f"{shown} programs are compiled as they stand there")
    return 1 if problems or shown == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
