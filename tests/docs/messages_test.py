"""Every message of the readers and of vmech loads, ik and haptic has an entry in
docs/troubleshooting.md: messages_test.py SOURCE

Messages are the texts in what is thrown and in what is handed to functions named ..Error or Fail.
An entry is there if the page has the longest run of a message's words that are always the same.
"""

import pathlib
import re
import sys

FOLDERS = ("mechanisms", "studies", "dynamics/loads", "dynamics/bearings", "kinematics/inverse",
           "kinematics/loops", "hw_interface", "apps/files", "apps/loads", "apps/ik", "apps/haptic")
LITERAL = r'"(?:[^"\\\n]|\\.)*"'
TOLD = re.compile(r"\b(?:throw\b[^(;]*|\w*Error|Fail)\(")
COMMENT_OR_LITERAL = re.compile(rf"//[^\n]*|({LITERAL})|'(?:[^'\\\n]|\\.)'")


def without_comments(source):
    return COMMENT_OR_LITERAL.sub(lambda match: match[1] or " ", source)


def arguments(source, begin):
    """From behind a bracket up to the one that closes it."""
    depth = 1
    for match in re.finditer(rf"{LITERAL}|[()]", source[begin:]):
        depth += {"(": 1, ")": -1}.get(match[0], 0)
        if depth == 0:
            return source[begin:begin + match.start()]
    return source[begin:]


def messages(source):
    """(offset, text) of each literal, neighbours joined, in what is told."""
    for call in TOLD.finditer(source):
        told = arguments(source, call.end())
        for literals in re.finditer(rf"{LITERAL}(?:\s*{LITERAL})*", told):
            parts = re.findall(LITERAL, literals[0])
            yield call.start(), "".join(part[1:-1] for part in parts)


def words(text):
    return " ".join(re.findall(r"\w+", text))


def fixed_words(message):
    """The longest run of a message's words between what changes from case to case."""
    pieces = re.split(r"\{[^}]*\}", re.sub(r"\\.", " ", message.replace('\\"', '"')))
    return max((words(piece) for piece in pieces), key=len)


def main():
    source = pathlib.Path(sys.argv[1])
    page = f' {words((source / "docs/troubleshooting.md").read_text(encoding="utf-8"))} '
    checked, problems = set(), []
    for file in sorted(file for folder in FOLDERS for file in (source / folder).rglob("*.cc")):
        text = without_comments(file.read_text(encoding="utf-8"))
        for offset, message in messages(text):
            fixed = fixed_words(message)
            if fixed.count(" ") < 2 or fixed in checked:  # a part of a message
                continue
            checked.add(fixed)
            if f" {fixed} " not in page:
                line = text.count("\n", 0, offset) + 1
                problems.append(f"{file.relative_to(source)}:{line}: '{message}' has no entry in "
                                "docs/troubleshooting.md")
    print("\n".join(problems) or f"{len(checked)} messages have their entry")
    return 1 if problems or len(checked) < 200 else 0


if __name__ == "__main__":
    sys.exit(main())
