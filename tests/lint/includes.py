"""Every source includes the header of what it names, itself or by the project's own headers.

Builds with precompiled headers do not notice a header that is missing; others stop at it. Prints
each source with the header and the name, and fails if there is any.
"""

import functools
import re
import sys

from sources import ROOT, cpp_files, relative

HEADERS = [(header, re.compile(names)) for header, names in (
    ("fmt/", r"\bfmt::\w"),
    ("Eigen/Cholesky", r"Eigen::(LLT|LDLT)\b|\.ldlt\(\)|\.llt\(\)"),
    ("Eigen/QR", r"HouseholderQR|\.householderQr\("),
    ("Eigen/SVD", r"JacobiSVD|BDCSVD"),
    ("Eigen/Eigenvalues", r"EigenSolver"),
    ("Eigen/Geometry", r"Eigen::(Quaternion|AngleAxis|Translation|Isometry)"),
    ("algorithm", r"std::(sort|stable_sort|find|find_if|any_of|all_of|none_of|count|count_if|"
                  r"max_element|min_element|clamp|lower_bound|upper_bound|reverse|unique)\("),
    ("array", r"std::array<"),
    ("filesystem", r"std::filesystem"),
    ("fstream", r"std::[io]?fstream"),
    ("functional", r"std::function<"),
    ("limits", r"std::numeric_limits"),
    ("map", r"std::map<"),
    ("memory", r"std::(unique_ptr|make_unique|shared_ptr|make_shared)<"),
    ("numbers", r"std::numbers::"),
    ("numeric", r"std::(iota|accumulate|inner_product)\("),
    ("optional", r"std::optional<"),
    ("set", r"std::(multi)?set<"),
    ("span", r"std::span<"),
    ("sstream", r"std::[io]?stringstream"),
    ("stdexcept", r"std::(invalid_argument|runtime_error|logic_error|out_of_range)\b"))]
INCLUDE = re.compile(r'^#include\s+[<"]([^>"]+)[>"]', re.MULTILINE)
COMMENT = re.compile(r"//.*")
APART = ("tests/consumer/", "tests/package/")  # projects of their own


TEXTS = {relative(path): path.read_text() for path in cpp_files()}


def own_header(name, source):
    """The project's header that an include stands for; None for one of others."""
    folder = source.rpartition("/")[0]
    places = (name.removeprefix("vmech/"), f"tests/{name}", f"{folder}/{name}")
    return next((place for place in places if place in TEXTS), None)


@functools.cache
def included_by(source):
    """All headers that a source includes, directly or by headers of the project."""
    found, left, seen = set(), [source], set()
    while left:
        here = left.pop()
        if here in seen:
            continue
        seen.add(here)
        for name in INCLUDE.findall(TEXTS[here]):
            header = own_header(name, here)
            if header:
                left.append(header)
            else:
                found.add(name)
    return found


def missing(source):
    code = COMMENT.sub("", TEXTS[source])
    headers = included_by(source)
    for header, names in HEADERS:
        named = names.search(code)
        if header.startswith("Eigen/") and "Eigen/Dense" in headers:
            continue
        if named and not any(name.startswith(header) for name in headers):
            yield header, named[0]


def main():
    faults = [f"{source}: includes no <{header}>, but names {name}"
              for source in sorted(TEXTS) if not source.startswith(APART)
              for header, name in missing(source)]
    print("\n".join(faults))
    return bool(faults)


if __name__ == "__main__":
    sys.exit(main())
