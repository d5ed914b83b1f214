#include <gtest/gtest.h>

#include <stdexcept>

#include "vmech/apps/html/markup.h"
#include "vmech/apps/html/page.h"

namespace vmech::html {
namespace {

TEST(Markup, HostileTextCannotBecomeMarkup) {
  EXPECT_EQ(Markup("<script>alert('x & \"y\"')</script>").html(),
            "&lt;script&gt;alert(&#39;x &amp; &quot;y&quot;&#39;)&lt;/script&gt;");
}

TEST(Markup, ControlCharactersThatXmlForbidsAreReplaced) {
  EXPECT_EQ(Markup(std::string("a\0b\x1b[31m", 8)).html(), "a\uFFFDb\uFFFD[31m");
  EXPECT_EQ(Markup("two\nlines\t").html(), "two\nlines\t");
}

TEST(Markup, TextIsEscapedOnceHoweverOftenItIsWrapped) {
  const Markup name = "a<b";
  EXPECT_EQ(Element("p", Element("strong", name) + " & more", "lead").html(),
            "<p class=\"lead\"><strong>a&lt;b</strong> &amp; more</p>");
}

TEST(Table, NumericColumnsAreMarkedInHeaderAndBody) {
  const Table table{"loads", {{"joint"}, {"peak [N]", true}}, {{"a&b", "12.5"}}};
  const std::string html = RenderTable(table).html();
  EXPECT_NE(html.find("<th>joint</th><th class=\"number\">peak [N]</th>"), std::string::npos);
  EXPECT_NE(html.find("<td>a&amp;b</td><td class=\"number\">12.5</td>"), std::string::npos);
}

TEST(Table, RowOfAnotherLengthIsRefused) {
  const Table table{"", {{"one"}, {"two"}}, {{"only one"}}};
  EXPECT_THROW(RenderTable(table), std::invalid_argument);
}

TEST(Page, NeedsNothingFromElsewhere) {
  const std::string page = RenderPage("loads of <x>", Paragraph("text"), ".own{}");
  EXPECT_NE(page.find("<title>loads of &lt;x&gt;</title>"), std::string::npos);
  EXPECT_NE(page.find(".own{}</style>"), std::string::npos);
  for (const char* outside : {"src=", "href=", "url(", "@import", "<script"}) {
    EXPECT_EQ(page.find(outside), std::string::npos) << outside;
  }
}

TEST(Page, ToneIsSaidInWordsAndInColour) {
  EXPECT_EQ(Badge("certain", Tone::kGood).html(), "<span class=\"badge good\">certain</span>");
}

}  // namespace
}  // namespace vmech::html
