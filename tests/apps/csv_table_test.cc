#include "vmech/studies/csv_table.h"

#include <gtest/gtest.h>

namespace vmech {
namespace {

/// The first thing that is said of a table; empty if it is accepted.
std::string Refusal(const std::string& text) {
  try {
    ParseCsvTable(text, "t.csv");
  } catch (const FileErrors& errors) {
    return ToString(errors.errors()[0]);
  }
  return "";
}

TEST(CsvTable, HasColumnsByNameAndTheLinesOfItsRows) {
  const CsvTable table =
      ParseCsvTable("# made by hand\nt, value\r\n0,1e-3\n\n 0.5 ,\t-2\n", "t.csv");
  EXPECT_EQ(table.names, (std::vector<std::string>{"t", "value"}));
  EXPECT_EQ(*table.Find("t"), (std::vector<double>{0, 0.5}));
  EXPECT_EQ(*table.Find("value"), (std::vector<double>{1e-3, -2}));
  EXPECT_EQ(table.lines, (std::vector<int>{3, 5}));
  EXPECT_EQ(table.Find("v"), nullptr);
}

TEST(CsvTable, PassesOverAByteOrderMark) {
  EXPECT_EQ(ParseCsvTable("\xEF\xBB\xBFt\n1\n", "t.csv").names[0], "t");
}

TEST(CsvTable, IsRefusedWithTheLineOfWhatIsWrong) {
  EXPECT_EQ(Refusal(""), "t.csv: the table has no rows");
  EXPECT_EQ(Refusal("t,v\n"), "t.csv: the table has no rows");
  EXPECT_EQ(Refusal("t,v\n0,1\n1\n"), "t.csv:3:1: expected 2 values, as in line 1, not 1");
  EXPECT_EQ(Refusal("t,v\n0,1\n1,x\n"), "t.csv:3:3: v: expected a finite number, not 'x'");
  EXPECT_EQ(Refusal("t,v\n0,\n"), "t.csv:2:3: v: expected a finite number, not ''");
  EXPECT_EQ(Refusal("t,v\n0,nan\n"), "t.csv:2:3: v: expected a finite number, not 'nan'");
  EXPECT_EQ(Refusal("t\n1\n1\n"), "t.csv:3:1: t must increase from row to row, but 1 follows 1");
  EXPECT_EQ(Refusal("0,1\n1,2\n"),
            "t.csv:1:1: the first line must name the columns, not give numbers");
  EXPECT_EQ(Refusal("t;v\n0;1\n"), "t.csv:1:1: expected names of columns, kept apart by commas");
  EXPECT_EQ(Refusal("t\tv\n0\t1\n"), "t.csv:1:1: expected names of columns, kept apart by commas");
  EXPECT_EQ(Refusal("t,t\n0,1\n"), "t.csv:1:3: the column 't' is given twice");
}

TEST(CsvTable, StopsWhenThereIsTooMuchToReport) {
  std::string text = "t\n";
  for (int i = 0; i < 1000; ++i) text += "x\n";
  try {
    ParseCsvTable(text, "t.csv");
    FAIL();
  } catch (const FileErrors& errors) {
    EXPECT_EQ(errors.errors().size(), 20u);
  }
}

TEST(CsvCell, IsQuotedWhereItMustBe) {
  EXPECT_EQ(CsvCell("crank"), "crank");
  EXPECT_EQ(CsvCell("a, b"), "\"a, b\"");
  EXPECT_EQ(CsvCell("a \"b\""), "\"a \"\"b\"\"\"");
  EXPECT_EQ(CsvCell("one\ntwo"), "one two");
  EXPECT_EQ(CsvCell(""), "");
}

TEST(CsvCell, IsNoFormula) {
  EXPECT_EQ(CsvCell("=1+1"), "'=1+1");
  EXPECT_EQ(CsvCell("@SUM(A1)"), "'@SUM(A1)");
  EXPECT_EQ(CsvCell("+cmd|' /C calc'!A0"), "'+cmd|' /C calc'!A0");
  EXPECT_EQ(CsvCell("-pin.fx"), "'-pin.fx");
  EXPECT_EQ(CsvCell("=HYPERLINK(\"http://x\",1)"), "\"'=HYPERLINK(\"\"http://x\"\",1)\"");
  EXPECT_EQ(CsvCell("\t=1"), "' =1");
  EXPECT_EQ(CsvCell("\r=1"), "'\uFFFD=1");
}

TEST(CsvCell, LeavesNumbersNumbers) {
  EXPECT_EQ(CsvCell("-1.5e-3"), "-1.5e-3");
  EXPECT_EQ(CsvCell("+2"), "+2");
}

TEST(CsvCell, ShowsNoControlCharacters) {
  EXPECT_EQ(CsvCell("a\x1b[31m"), "a\uFFFD[31m");
}

}  // namespace
}  // namespace vmech
