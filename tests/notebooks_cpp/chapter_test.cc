#include "chapter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "highlight.h"
#include "notebook.h"
#include "support/temp_folder.h"

namespace vmech {
namespace {

constexpr char kSource[] =
    "// before the first cell\n"
    "//%% [markdown]\n"
    "// # Title\n"
    "//\n"
    "// Text.\n"
    "//%%\n"
    "int a = 1;\n"
    "\n"
    "  //%% tags=[\"remove-cell\"]\n"
    "  Secret();\n"
    "  //%%\n"
    "  if (a) {\n"
    "    b();\n"
    "  }\n";

TEST(Chapter, CellsAreTextOrCodeWithoutCommonIndentation) {
  const std::vector<Cell> cells = SplitIntoCells(kSource);
  ASSERT_EQ(cells.size(), 4u);
  EXPECT_TRUE(cells[0].markdown);
  EXPECT_EQ(cells[0].text, "# Title\n\nText.\n");
  EXPECT_EQ(cells[1].text, "int a = 1;\n");
  EXPECT_EQ(cells[3].text, "if (a) {\n  b();\n}\n");
  EXPECT_EQ(cells[3].first_line, 11);
  EXPECT_EQ(TitleOf(cells), "Title");
}

TEST(Chapter, ResultsStandBelowTheCellThatMadeThem) {
  const std::vector<Output> outputs = {{12, "text", "late <"}, {7, "text", "early"}};
  const std::string page = RenderChapter(SplitIntoCells(kSource), outputs).html();
  const auto early = page.find("early"), late = page.find("late &lt;");
  const auto second_cell = page.find("b()");
  EXPECT_LT(page.find("Text."), early);
  EXPECT_LT(early, second_cell);
  EXPECT_LT(second_cell, late);
  EXPECT_NE(late, std::string::npos);
}

TEST(Chapter, RemovedCellsLeaveTheirResults) {
  const std::string page = RenderChapter(SplitIntoCells(kSource), {{10, "text", "shown"}}).html();
  EXPECT_EQ(page.find("Secret"), std::string::npos);
  EXPECT_NE(page.find("shown"), std::string::npos);
}

std::string FileText(const std::string& name) {
  std::ifstream file(name, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(Notebook, WhatAChapterWritesIsReadBackWithItsLine) {
  const TempFolder folder;
  std::string file = folder / "chapter.results";
  std::string program = "chapter";
  char* arguments[] = {program.data(), file.data()};
  int line = 0;
  {
    Notebook notebook(2, arguments);
    notebook.Print("two\nlines 9 text 4\n");
    line = __LINE__ - 1;
    notebook.CheckNear("one", 1.0, 1.0 + 1e-9, 1e-8);
    EXPECT_EQ(notebook.ExitCode(), 0);
    notebook.Check("false claim", false);
    EXPECT_EQ(notebook.ExitCode(), 1);
  }
  const std::vector<Output> outputs = ParseOutputs(FileText(file));
  ASSERT_EQ(outputs.size(), 3u);
  EXPECT_EQ(outputs[0].content, "two\nlines 9 text 4\n");
  EXPECT_EQ(outputs[0].line, line);
  EXPECT_EQ(outputs[1].kind, "holds");
  EXPECT_EQ(outputs[2].kind, "fails");
}

TEST(Notebook, AValueThatIsNotANumberIsNotNear) {
  std::string program = "chapter";
  char* arguments[] = {program.data()};
  Notebook notebook(1, arguments);
  notebook.CheckNear("nothing", std::nan(""), 0, 1e300);
  EXPECT_EQ(notebook.ExitCode(), 1);
}

TEST(Chapter, DamagedResultsAreRefused) {
  for (const char* records :
       {"nonsense", "3 text 100\nshort\n", "-1 text 1\nx\n", "3 text x\nx\n"}) {
    EXPECT_THROW(ParseOutputs(records), std::runtime_error) << records;
  }
}

TEST(HighlightCpp, MarksWordsByWhatTheyAre) {
  const std::string html =
      HighlightCpp("#include <a>\nconst Pose X_WG = f(\"a\\\"b\", 1.5e3);  // x<y\n").html();
  for (const char* part :
       {"<span class=\"p\">#include &lt;a&gt;</span>", "<span class=\"k\">const</span>",
        "<span class=\"t\">Pose</span> X_WG", "<span class=\"s\">&quot;a\\&quot;b&quot;</span>",
        "<span class=\"n\">1.5e3</span>", "<span class=\"c\">// x&lt;y</span>"}) {
    EXPECT_NE(html.find(part), std::string::npos) << part << "\nin " << html;
  }
}

}  // namespace
}  // namespace vmech
