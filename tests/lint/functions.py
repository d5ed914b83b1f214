"""Finds the functions of a C++ file that clang-format has formatted."""

import re

# What is not code, with as many lines as before; a character or string keeps its quotes.
NOT_CODE = re.compile(r'//[^\n]*|/\*.*?\*/|R"\(.*?\)"|"(?:\\.|[^"\\\n])*"'
                      r"|'(?:\\.|[^'\\\n])'|"
                      r"^[ \t]*#(?:[^\n]*\\\n)*[^\n]*", re.MULTILINE | re.DOTALL)
SCOPE = re.compile(r"\b(namespace|struct|class|union|extern)\b[^()=]*$")
# Parentheses and whatever may stand between them and a body.
SIGNATURE = re.compile(r"\)[\w\s:<>,&*()\[\]{}.+\-/!|=~?]*$", re.DOTALL)
BEFORE = re.compile(r"(?:\s|(?:public|private|protected):)*")
NO_FUNCTION = re.compile(r"^\s*(enum|using)\b|(?<![=!<>])= ?$|= \[|\breturn\b")


def code_of(text):
    return NOT_CODE.sub(lambda match: re.sub(r"[^\n]", " ", match.group(0)), text)


def kind_of(head, brace_stands_apart):
    """What a `{` opens at the scope of a namespace or class: by the text before it."""
    if NO_FUNCTION.search(head):
        return "value"
    if SIGNATURE.search(head) and brace_stands_apart:
        return "function"
    if SCOPE.search(head):
        return "scope"
    return "value"


def functions_of(text):
    """The line and the number of lines of every function; a lambda is a part of its function."""
    code = code_of(text)
    functions, opened, start = [], [], 0  # of the head of what comes next
    for match in re.finditer(r"[{};]", code):
        at, token = match.start(), match.group(0)
        in_scope = all(kind == "scope" for kind, _ in opened)
        if token == "{":
            kind = kind_of(code[start:at], code[at - 1].isspace()) if in_scope else "inner"
            opened.append((kind, start))
        elif token == "}" and opened:
            kind, begin = opened.pop()
            if kind == "function":
                begin = BEFORE.match(code, begin).end()
                line = code.count("\n", 0, begin) + 1
                functions.append((line, code.count("\n", begin, at) + 1))
            if kind == "value":
                continue
        elif not in_scope:
            continue
        if all(kind == "scope" for kind, _ in opened):
            start = at + 1
    return functions
