"""Puts sources into batches that can be compiled as one source, which includes them all.

Usage: batches.py SIZE SOURCE...     prints a line `NUMBER SOURCE` for each source of a batch

Much of the time of a source goes into headers and into templates that its neighbours instantiate
as well; a batch pays for them once. A source that says a name which another defines for itself
alone, in its unnamed namespace, is not put into the batch of the other, where it could mean either;
nor is one that has a name for itself which a header of the other gives.
Sources in namespaces side by side (vmech::units_test, vmech::writer_test) do not see each other's
names. What stands alone is not printed.
"""

import dataclasses
import functools
import pathlib
import re
import sys

# What stands between `namespace {` and its end, and the names that are defined there at the left
# margin.
HIDDEN = re.compile(r"^namespace \{$(.*?)^\}  // namespace$", re.MULTILINE | re.DOTALL)
AT_MARGIN = re.compile(r"^(?!//|#|\}|template)\S.*$", re.MULTILINE)
DEFINED = re.compile(r"^(?:struct|class|enum class|using) (\w+)"
                     r"|[\w>&*] ([A-Za-z]\w*)(?:\[.*\])?(?:\(| = |\{|;)"
                     r"|, ([A-Za-z]\w*)(?: = |\{)", re.MULTILINE)
ONE_LINE = re.compile(r"^template <.*> (?=struct|class)", re.MULTILINE)
ALIAS = re.compile(r"namespace|using (?!\w+ = )")  # of the same in every source
SCOPE = re.compile(r"^namespace ([\w:]+) \{$", re.MULTILINE)
SAID = re.compile(r"(?<![.:>])\b(?:[A-Z]|k[A-Z])\w*")  # not members, nor variables
UNSAID = re.compile(r'//.*|"(?:\\.|[^"\\\n])*"')  # comments and strings
ENTRY = re.compile(r"^int (main)\(|^\S.* (vmech_\w+) = ", re.MULTILINE)  # of a program or library
INCLUDED = re.compile(r'^#include "([^"]+)"', re.MULTILINE)
ROOT = pathlib.Path(__file__).resolve().parents[1]


@functools.cache
def included_by(path):
    """The project's headers that a file includes itself: "vmech/base/x.h" is base/x.h."""
    names = [name.removeprefix("vmech/") for name in INCLUDED.findall(path.read_text())]
    places = (ROOT, ROOT / "tests", path.parent)
    found = (next(filter(pathlib.Path.is_file, (place / name for place in places)), None)
             for name in names)
    return {header for header in found if header}


def with_included_headers(source):
    """The source and the project's headers that it includes, directly or not."""
    found, waiting = set(), [source]
    while waiting:
        path = waiting.pop()
        if path not in found:
            found.add(path)
            waiting += included_by(path)
    return found


def defined_at_margin(text):
    """Names that are defined, or declared, at the left margin."""
    lines = [line for line in AT_MARGIN.findall(text) if not ALIAS.match(line)]
    return {name for names in DEFINED.findall("\n".join(lines)) for name in names if name}


def hidden_names(text):
    """Names of what only this source may define, by which it may clash with others."""
    entries = {name for names in ENTRY.findall(text) for name in names if name}
    return defined_at_margin("".join(HIDDEN.findall(text))) | entries


def encloses(outer, inner):
    """Whether a namespace is another or holds it; the one without a name holds all."""
    return not outer or f"{inner}::".startswith(f"{outer}::")


def scope_of(text):
    """The namespace of a file's definitions."""
    scope = SCOPE.search(text)
    return scope[1] if scope else ""


@functools.cache
def names_given(header):
    """The names that a header gives to whoever includes it, and their namespace."""
    text = header.read_text()
    return frozenset((scope_of(text), name)
                     for name in defined_at_margin(ONE_LINE.sub("", text)))


@dataclasses.dataclass
class Source:
    """A source as its neighbours in a batch meet it."""
    path: pathlib.Path
    scope: str  # the namespace of its definitions
    hidden: set  # names of its own
    said: set  # names of its own and what else it calls by a name
    given: set  # names that its headers give, with their namespaces

    def meets(self, other):
        """Whether the other says a name of this source's own, or has a header that gives it."""
        visible = encloses(self.scope, other.scope) or encloses(other.scope, self.scope)
        own = {(self.scope, name) for name in self.hidden}
        return visible and bool(self.hidden & other.said) or bool(own & (other.given - self.given))

    def clashes(self, other):
        """Whether a name of one's own means something in the other, where it is visible."""
        return self.meets(other) or other.meets(self)


def read_source(path):
    text = path.read_text()
    hidden = hidden_names(text)
    said = set(SAID.findall(UNSAID.sub("", text)))
    headers = with_included_headers(path) - {path}
    return Source(path, scope_of(text), hidden, hidden | said,
                  set().union(*map(names_given, headers)))


def batches_of(paths, size):
    """The paths in batches of at most `size`; those with the most clashes are placed first."""
    sources = [read_source(path) for path in paths]
    batches = []
    for source in sorted(sources, key=lambda one: -sum(map(one.clashes, sources))):
        for batch in batches:
            if len(batch) < size and not any(map(source.clashes, batch)):
                batch.append(source)
                break
        else:
            batches.append([source])
    return [[source.path for source in batch] for batch in batches]


def main():
    paths = [pathlib.Path(path).absolute() for path in sys.argv[2:]]
    batches = [batch for batch in batches_of(paths, int(sys.argv[1])) if len(batch) > 1]
    for number, batch in enumerate(batches):
        for path in batch:
            print(number, path)


if __name__ == "__main__":
    main()
