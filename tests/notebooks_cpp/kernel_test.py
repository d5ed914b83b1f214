"""Cells as Jupyter runs them, through its own client: kernel_test.py NOTEBOOKS_CPP BUILD"""

import json
import os
import pathlib
import sys
import tempfile
import unittest

import nbclient
import nbformat.v4 as notebook_format

BUILD = pathlib.Path(sys.argv.pop())
NOTEBOOKS = pathlib.Path(sys.argv.pop())
sys.path.insert(0, str(NOTEBOOKS))
import chapter  # noqa: E402
import kernel  # noqa: E402


def execute(notebook, **options):
    """In place."""
    with tempfile.TemporaryDirectory() as folder:
        place = pathlib.Path(folder) / "kernels" / chapter.KERNEL["name"]
        place.mkdir(parents=True)
        (place / "kernel.json").write_text(json.dumps(kernel.spec(BUILD)))
        os.environ["JUPYTER_PATH"] = folder
        nbclient.NotebookClient(notebook, timeout=300, **options).execute()


def texts(cell):
    return "".join(output.get("text", "") for output in cell.outputs)


class KernelTest(unittest.TestCase):
    def test_a_chapter_writes_in_jupyter_what_it_writes_as_a_program(self):
        source = (NOTEBOOKS / "01-four-bar.cc").read_text()
        results = (BUILD / "notebooks_cpp" / "01-four-bar.results").read_bytes()
        notebook = chapter.as_notebook(chapter.read_chapter(source, results))
        notebook.cells = notebook.cells[:6]
        expected = [cell.get("outputs", []) for cell in notebook.cells]
        self.assertGreater(sum(map(len, expected)), 4)
        for cell in notebook.cells:
            if cell.cell_type == "code":
                cell.outputs = []
        execute(notebook)
        for cell, outputs in zip(notebook.cells, expected):
            if outputs and all(output.output_type == "stream" for output in outputs):
                self.assertEqual(texts(cell), "".join(output.text for output in outputs))
            else:
                self.assertEqual(cell.get("outputs", []), outputs)

    def test_a_cell_shows_its_own_and_one_that_fails_is_forgotten(self):
        codes = ['#include <stdexcept>\n#include <fmt/format.h>\nint half(int x) { return x / 2; }',
                 'int a = 7;\nfmt::print("a first\\n");',
                 "int b = 1;\nint c = nonsense;",
                 'throw std::runtime_error("thrown on purpose");',
                 'int b = half(a);\nfmt::print("b = {}\\n", b);\nnotebook.Check("three", b == 3);']
        notebook = notebook_format.new_notebook(
            metadata={"kernelspec": chapter.KERNEL},
            cells=[notebook_format.new_code_cell(code) for code in codes])
        execute(notebook, allow_errors=True)
        outputs = [cell.outputs for cell in notebook.cells]
        self.assertEqual(outputs[0], [])
        self.assertEqual(texts(notebook.cells[1]), "a first\n")
        self.assertIn("cell 3, line 2", outputs[2][0].evalue)
        self.assertIn("nonsense", outputs[2][0].evalue)
        self.assertIn("thrown on purpose", outputs[3][0].evalue)
        self.assertEqual(texts(notebook.cells[4]), "b = 3\nholds: three\n")


class ProgramTest(unittest.TestCase):
    def test_the_compiler_speaks_of_the_cells(self):
        cells = ["int a;", "#include <cmath>\nint g();", "g();\nh();"]
        source, begins = kernel.program_of(cells)
        line = source.splitlines().index("h();") + 1
        self.assertEqual(
            kernel.in_cells(f"[1/2] c++ all of it\n/x/{kernel.TARGET}.cc:{line}:1: error", cells,
                            begins),
            "cell 3, line 2:1: error")


if __name__ == "__main__":
    unittest.main()
