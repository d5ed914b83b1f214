"""A chapter as a page of the site and as a Jupyter notebook.

A chapter is a C++ program in the percent format, its results are what it wrote when it ran
(notebook.h). Both files are named as the source: NN-name.md, Markdown with formulas, and
NN-name.ipynb, with its output. No cell is run here.
"""

import dataclasses
import html
import re
import textwrap

import nbformat
import nbformat.v4 as notebook_format


# That runs the cells: kernel.py.
KERNEL = {"name": "vmech", "display_name": "C++ with vmech", "language": "C++"}


@dataclasses.dataclass
class Output:
    line: int  # of the source, from which it was written
    kind: str  # text, html, svg, holds, fails
    content: str


@dataclasses.dataclass
class Cell:
    markdown: bool
    hidden: bool  # tagged `remove-cell`: runs, and is not shown
    first_line: int  # of the marker, counted from 1
    text: str = ""  # without marker, common indentation and comment slashes
    outputs: list[Output] = dataclasses.field(default_factory=list)


def split_into_cells(source):
    """What is in front of the first marker `//%%` is not part of any cell."""
    cells, lines = [], []
    for number, line in enumerate(source.splitlines(), start=1):
        if line.lstrip().startswith("//%%"):
            cells.append(Cell("[markdown]" in line, '"remove-cell"' in line, number))
            lines.append([])
        elif cells:
            lines[-1].append(line)
    for cell, its_lines in zip(cells, lines):
        if cell.markdown:
            its_lines = [re.sub(r"^ *// ?", "", line) for line in its_lines]
        cell.text = textwrap.dedent("\n".join(its_lines)).strip("\n")
    return cells


def parse_outputs(records):
    """The records of notebook.cc: `line kind size`, a line's end, size bytes, a line's end."""
    outputs = []
    while records:
        header, _, rest = records.partition(b"\n")
        match = re.fullmatch(rb"([1-9]\d*) ([a-z]+) (\d+)", header)
        if not match or len(rest) < int(match[3]) + 1:
            raise ValueError(f"damaged result record {header!r}")
        size = int(match[3])
        outputs.append(Output(int(match[1]), match[2].decode(), rest[:size].decode()))
        records = rest[size + 1:]
    return outputs


def read_chapter(source, results):
    """The cells, each with what was written from its lines, in order."""
    cells = split_into_cells(source)
    for output in parse_outputs(results):
        before = [cell for cell in cells if cell.first_line <= output.line]
        if not before:
            raise ValueError(f"a result of line {output.line}, in front of the first cell")
        before[-1].outputs.append(output)
    if not cells or not cells[0].text.startswith("# "):
        raise ValueError("the first cell has no heading '# ...'")
    return cells


def fenced(kind, text):
    fence = "`" * max(3, 1 + max(map(len, re.findall("`+", text)), default=0))
    return f"{fence}{kind}\n{text.rstrip()}\n{fence}\n"


def output_as_markdown(output):
    if output.kind == "text":
        return fenced("{code-block} text\n:class: output", output.content)
    if output.kind == "svg":
        return fenced("{raw} html", f"<figure>{output.content}</figure>")
    if output.kind == "html":
        return fenced("{raw} html", output.content)
    tone = {"holds": "good", "fails": "bad"}[output.kind]
    return fenced("{raw} html", f'<p class="check"><span class="badge {tone}">{output.kind}</span> '
                                f"{html.escape(output.content)}</p>")


def as_markdown(cells, name):
    parts = []
    for cell in cells:
        if not cell.hidden:
            parts.append(cell.text + "\n" if cell.markdown else fenced("cpp", cell.text))
        parts += map(output_as_markdown, cell.outputs)
    parts.append(f"This chapter is a program, [{name}.cc]({name}.cc), whose every number it wrote "
                 f"when this page was made. As a [notebook]({name}.ipynb).\n")
    return "\n".join(parts)


def output_as_json(output):
    if output.kind in ("svg", "html"):
        mime = {"svg": "image/svg+xml", "html": "text/html"}[output.kind]
        return notebook_format.new_output("display_data", data={mime: output.content})
    mark = "" if output.kind == "text" else output.kind + ": "
    return notebook_format.new_output("stream", name="stdout",
                                      text=mark + output.content.rstrip() + "\n")


def as_notebook(cells):
    """The same cells for Jupyter. Those tagged `remove-cell`, main's first line and its last, are
    left out: what they wrote stands below the cell before."""
    notebook = notebook_format.new_notebook(metadata={
        "kernelspec": KERNEL,
        "language_info": {"name": "C++", "file_extension": ".cc", "mimetype": "text/x-c++src"}})
    for number, cell in enumerate(cells):
        outputs = list(map(output_as_json, cell.outputs))
        if cell.hidden:
            code = [shown for shown in notebook.cells if shown.cell_type == "code"]
            code[-1].outputs += outputs
        elif cell.markdown:
            notebook.cells.append(notebook_format.new_markdown_cell(cell.text))
        else:
            notebook.cells.append(notebook_format.new_code_cell(cell.text, outputs=outputs))
        if not cell.hidden:
            notebook.cells[-1].id = f"cell-{number}"
    return notebook


def write_pages(source, results, folder):
    """@raises ValueError naming the source where source and results do not fit each other."""
    try:
        cells = read_chapter(source.read_text(encoding="utf-8"), results.read_bytes())
    except ValueError as error:
        raise ValueError(f"{source}: {error}") from None
    notebook = as_notebook(cells)
    nbformat.validate(notebook)
    (folder / f"{source.stem}.md").write_text(as_markdown(cells, source.stem), encoding="utf-8")
    nbformat.write(notebook, str(folder / f"{source.stem}.ipynb"))
