"""Every class, function, enumeration, type and constant of the installed headers is documented, and
of the members of classes no fewer than before: symbols_test.py DOXYGEN_LOG"""

import collections
import pathlib
import re
import sys

# Members without a comment of their own: those of a declaration that Doxygen does not take apart,
# as that of the three columns of an inertia. What is new is documented.
MOST_MEMBERS = 6
UNDOCUMENTED = re.compile(
    r"^(\S+:\d+): warning: (?:Member .* \(([a-z ]+)\) of (\w+) .*|(Compound) .*) is not documented",
    re.MULTILINE)


def main():
    log = pathlib.Path(sys.argv[1]).read_text(encoding="utf-8")
    problems, members = [], collections.Counter()
    for place, kind, owner, compound in UNDOCUMENTED.findall(log):
        if compound or owner in ("namespace", "file"):
            problems.append(f"{place}: this {kind or 'class'} is not documented")
        else:
            members[kind] += 1
    count = sum(members.values())
    print("\n".join(problems) or "every class, function, enumeration and constant is documented")
    print(f"members without a comment: {count}, " +
          ", ".join(f"{number} {kind}s" for kind, number in members.items()))
    if count > MOST_MEMBERS:
        print(f"at most {MOST_MEMBERS} are allowed; document what is new")
    if count == 0:
        print("the log says nothing of members: it is not that of a whole run")
    return 1 if problems or not 0 < count <= MOST_MEMBERS else 0


if __name__ == "__main__":
    sys.exit(main())
