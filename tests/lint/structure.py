"""Rules about how the sources of the modules hang together. Prints what breaks them, fails if any.

- No component includes another that includes it back, directly or not. A component is a header, a
  source or both of one name.
- A folder of sources holds at most MAX_COMPONENTS components, and a README.md.
- Functions are short: MEDIAN_LINES at the median, and at most LONG_SHARE of them are longer than
  LONG_LINES, counted from the first line of the signature to the closing brace.
"""

import re
import statistics
import sys

from functions import functions_of
from sources import ROOT, cpp_files, relative

MODULES = ("base", "mechanisms", "solvers", "kinematics", "dynamics", "comparison", "hw_interface",
           "studies", "apps", "bindings")
MAX_COMPONENTS = 15
MEDIAN_LINES, LONG_LINES, LONG_SHARE = 7, 40, 0.01
INCLUDE = re.compile(r'^#include "vmech/([^"]+)\.h"', re.MULTILINE)


def component(path):
    return relative(path.with_suffix(""))


def includes_of(files):
    """For each component those that it includes, itself left out."""
    includes = {}
    for path in files:
        found = set(INCLUDE.findall(path.read_text())) - {component(path)}
        includes.setdefault(component(path), set()).update(found)
    return {name: found & includes.keys() for name, found in includes.items()}


def circle(includes):
    """Components, each including the next and the last the first; none if there is no circle."""
    left = dict(includes)
    while ends := [name for name, found in left.items() if not found & left.keys()]:
        for name in ends:
            del left[name]
    walk = sorted(left)[:1]
    while walk and (step := min(left[walk[-1]] & left.keys())) not in walk:
        walk.append(step)
    return walk[walk.index(step):] if walk else []


def folder_problems(components):
    folders = {}
    for name in components:
        folders.setdefault((ROOT / name).parent, []).append(name)
    for folder, inside in sorted(folders.items()):
        if len(inside) > MAX_COMPONENTS:
            yield f"{relative(folder)}: {len(inside)} components, at most {MAX_COMPONENTS}"
        if not (folder / "README.md").is_file():
            yield f"{relative(folder)}: a folder of sources without a README.md"


def length_problems(functions):
    lengths = [lines for _, _, lines in functions]
    too_long = [entry for entry in functions if entry[2] > LONG_LINES]
    median, share = statistics.median(lengths), len(too_long) / len(lengths)
    print(f"{len(lengths)} functions: {median} lines at the median, {max(lengths)} at most; "
          f"{len(too_long)} ({share:.1%}) above {LONG_LINES}")
    if median > MEDIAN_LINES:
        yield f"functions have {median} lines at the median, at most {MEDIAN_LINES}"
    if share > LONG_SHARE:
        yield f"{share:.1%} of functions are above {LONG_LINES} lines, at most {LONG_SHARE:.0%}:"
        yield from (f"  {relative(path)}:{line}: {lines} lines" for path, line, lines in too_long)


def main():
    files = [path for path in cpp_files() if relative(path).split("/")[0] in MODULES]
    includes = includes_of(files)
    problems = list(folder_problems(includes))
    if found := circle(includes):
        problems.append("components include each other in a circle:\n  " + "\n  ".join(found))
    problems += length_problems([(path, *entry) for path in files
                                 for entry in functions_of(path.read_text())])
    print("\n".join(problems) or f"{len(includes)} components obey the rules of structure")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
