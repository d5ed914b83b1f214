"""Cells and results of a chapter, as Markdown and as a notebook: chapter_test.py NOTEBOOKS_CPP"""

import sys
import unittest

sys.path.insert(0, sys.argv.pop())
import chapter  # noqa: E402

SOURCE = """// before the first cell
//%% [markdown]
// # Title
//
// Text.
//%%
int a = 1;

  //%% tags=["remove-cell"]
  Secret();
  //%%
  if (a) {
    b();
  }
"""


def records(*outputs):
    return b"".join(b"%d %s %d\n%s\n" % (line, kind, len(text), text)
                    for line, kind, text in outputs)


class ChapterTest(unittest.TestCase):
    def test_cells_are_text_or_code_without_common_indentation(self):
        cells = chapter.split_into_cells(SOURCE)
        self.assertEqual([cell.text for cell in cells],
                         ["# Title\n\nText.", "int a = 1;", "Secret();", "if (a) {\n  b();\n}"])
        self.assertEqual([cell.markdown for cell in cells], [True, False, False, False])
        self.assertEqual(cells[3].first_line, 11)

    def test_results_stand_below_the_cell_that_made_them(self):
        cells = chapter.read_chapter(SOURCE, records((12, b"holds", b"late <"),
                                                     (7, b"text", b"two\nlines 9 text 4")))
        page = chapter.as_markdown(cells, "name")
        places = [page.index(part) for part in
                  ("Text.", "int a", "lines 9 text 4", "b()", "holds</span> late &lt;")]
        self.assertEqual(places, sorted(places))

    def test_removed_cells_leave_their_results(self):
        cells = chapter.read_chapter(SOURCE, records((10, b"text", b"shown")))
        notebook = chapter.as_notebook(cells)
        chapter.nbformat.validate(notebook)
        for page in chapter.as_markdown(cells, "name"), str(notebook):
            self.assertNotIn("Secret", page)
            self.assertIn("shown", page)

    def test_a_text_with_fences_stays_in_its_own(self):
        cells = chapter.read_chapter(SOURCE, records((7, b"text", b"a\n```\n# b")))
        self.assertIn("````{code-block} text\n:class: output\na\n```\n# b\n````",
                      chapter.as_markdown(cells, "name"))

    def test_damaged_results_are_refused(self):
        for damaged in (b"nonsense", b"3 text 100\nshort\n", b"-1 text 1\nx\n", b"3 text x\nx\n",
                        b"1 text 1\nx\n"):
            with self.assertRaises(ValueError, msg=damaged):
                chapter.read_chapter(SOURCE, damaged)

    def test_a_chapter_begins_with_its_title(self):
        with self.assertRaises(ValueError):
            chapter.read_chapter(SOURCE.replace("# Title", "Title"), b"")


if __name__ == "__main__":
    unittest.main()
