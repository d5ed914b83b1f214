#include "markdown.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "formula.h"

namespace vmech {
namespace {

std::string Inline(const char* tex) {
  return RenderFormula(tex, FormulaStyle::kInline).html();
}

std::string Math(const std::string& row) {
  return "<math><mrow>" + row + "</mrow></math>";
}

TEST(Markdown, BlocksAreToldApart) {
  EXPECT_EQ(RenderMarkdown("## Head\ntext that\ngoes on\n\n- one\n  more\n- two\n").html(),
            "<h2>Head</h2>\n<p>text that goes on</p>\n<ul><li>one more</li><li>two</li></ul>");
  EXPECT_EQ(RenderMarkdown("1. a\n2. b\n").html(), "<ol><li>a</li><li>b</li></ol>");
  EXPECT_EQ(RenderMarkdown("```\n# a < b\n```\n").html(), "<pre><code># a &lt; b\n</code></pre>");
}

TEST(Markdown, MarksWithinALine) {
  EXPECT_EQ(
      RenderMarkdown("**a *b*** `*c*` [d](e.html) 2 * 3 < 7").html(),
      "<p><strong>a *b</strong>* <code>*c*</code> <a href=\"e.html\">d</a> 2 * 3 &lt; 7</p>\n");
}

TEST(Markdown, TablesKnowColumnsOfNumbers) {
  EXPECT_NE(RenderMarkdown("| a | b |\n|---|--:|\n| x | 1 |\n")
                .html()
                .find("<tr><td>x</td><td class=\"number\">1</td></tr>"),
            std::string::npos);
}

TEST(Formula, ScriptsAndPrimes) {
  EXPECT_EQ(Inline("x_1^2"),
            Math("<msubsup><mi>x</mi><mn>1</mn><mrow><mn>2</mn></mrow></msubsup>"));
  EXPECT_EQ(Inline("q''"), Math("<msup><mi>q</mi><mrow><mo>″</mo></mrow></msup>"));
}

TEST(Formula, FractionsRootsAndAccents) {
  EXPECT_EQ(Inline("\\frac{1}{2}\\ddot q"),
            Math("<mfrac><mrow><mn>1</mn></mrow><mrow><mn>2</mn></mrow></mfrac>"
                 "<mover accent=\"true\"><mi>q</mi><mo stretchy=\"false\">¨</mo></mover>"));
  EXPECT_EQ(Inline("\\sqrt\\lambda"), Math("<msqrt><mi>λ</mi></msqrt>"));
}

TEST(Formula, MatricesHaveRowsAndColumns) {
  EXPECT_EQ(
      Inline("\\begin{bmatrix} a & 0 \\\\ 1 & b \\end{bmatrix}"),
      Math("<mrow><mo>[</mo><mtable><mtr><mtd><mi>a</mi></mtd><mtd><mn>0</mn></mtd></mtr>"
           "<mtr><mtd><mn>1</mn></mtd><mtd><mi>b</mi></mtd></mtr></mtable><mo>]</mo></mrow>"));
}

TEST(Formula, WhatCannotBeReadIsRefused) {
  for (const char* tex : {"\\unknown", "{x", "x}", "x_", "\\left( x", "\\begin{array}", "\\frac{1}",
                          "a # b", "\\begin{bmatrix} a", "\\", "\\left", "\\mathbf{x"}) {
    EXPECT_THROW(Inline(tex), std::invalid_argument) << tex;
  }
}

}  // namespace
}  // namespace vmech
