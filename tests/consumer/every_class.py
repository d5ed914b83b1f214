"""Writes a program that makes every public class of an installed vmech.

    every_class.py INCLUDE_FOLDER > every_class.cc

The program includes every installed header in one file, makes each class that can be made without
arguments on the stack, on the heap and in a vector that grows, and prints the size and
alignment of all of them: they must be the same whatever the flags it is compiled with. For the same
reason a function that takes or returns a whole register by value is refused.
"""

import pathlib
import re
import sys

CLASS = re.compile(r"^(?:struct|class) (\w+)(?: final)?(?: : [^{;]*)? ?\{", re.MULTILINE)
TEMPLATE = re.compile(r"^template <[^;{]*?>\n(?=struct|class)", re.MULTILINE)
COMMENT = re.compile(r"//[^\n]*")

REGISTER = re.compile(r"using (\w+) = \w+ __attribute__\(\(vector_size")


def passed_in_registers(headers):
    """The functions of the headers that take or return a vector of the compiler's by value."""
    registers = "|".join(name for text in headers.values() for name in REGISTER.findall(text))
    if not registers:
        return []
    by_value = re.compile(rf"[(,]\s*(?:const )?(?:{registers})(?: \w+)?[,)]"
                          rf"|^[ \w]*\b(?:{registers}) \w+\(", re.MULTILINE)
    return [f"{path}: {found.strip()}" for path, text in headers.items()
            for found in by_value.findall(COMMENT.sub("", text))]


def classes_of(text):
    """Names of the classes at namespace scope; templates are none."""
    text = TEMPLATE.sub("template ", COMMENT.sub("", text))
    return CLASS.findall(text)


def main():
    include = pathlib.Path(sys.argv[1])
    headers = sorted(include.glob("vmech/**/*.h"))
    names = sorted({name for header in headers for name in classes_of(header.read_text())})
    if found := passed_in_registers({header: header.read_text() for header in headers}):
        sys.exit("every_class.py: passed in registers:\n" + "\n".join(found))
    if len(names) < 100:
        sys.exit(f"every_class.py: only {len(names)} classes found in {include}")
    for header in headers:
        print(f'#include "{header.relative_to(include)}"')
    print('\n#include "examine.h"\n\nint main() {')
    for name in names:
        print(f'  Examine<vmech::{name}>("{name}");')
    print("}")


main()
