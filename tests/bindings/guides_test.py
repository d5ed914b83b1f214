"""The programs of the guides to C and Python are those that are tested, in less than 30 lines:
guides_test.py SOURCE"""

import pathlib
import sys

source = pathlib.Path(sys.argv[1])
for guide, language, program in (
        ("docs/c.md", "c", "tests/bindings/c/four_bar_loads.c"),
        ("docs/python.md", "python", "bindings/python/examples/four_bar_loads.py"),
        ("docs/for-library-authors.md", "python", "bindings/python/examples/hold_crank.py")):
    text = (source / program).read_text()
    assert f"```{language}\n{text}```" in (source / guide).read_text(), f"{guide}: not {program}"
    assert text.count("\n") < 30, f"{program} has {text.count(chr(10))} lines"
