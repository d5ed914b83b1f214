#include "vmech/mechanisms/exchange/xml/xml_document.h"

#include <gtest/gtest.h>

namespace vmech::xml_document_test {
namespace {

TEST(Xml, GivesElementsWithTheirLines) {
  const XmlElement root = ParseXml(
      "\xEF\xBB\xBF<?xml version='1.0'?>\n<!-- <a> -->\n<a x = \"1\"\n  y='2'>one<b/>\n<c>two</c >"
      "<!-- -->three</a>\n<!-- end -->\n",
      "file");
  EXPECT_EQ(root.name, "a");
  EXPECT_EQ(root.line, 3);
  EXPECT_EQ(*root.Attribute("x"), "1");
  EXPECT_EQ(*root.Attribute("y"), "2");
  EXPECT_EQ(root.Attribute("z"), nullptr);
  EXPECT_EQ(root.text, "one\nthree");
  ASSERT_EQ(root.children.size(), 2u);
  EXPECT_EQ(root.children[0].line, 4);
  EXPECT_EQ(root.children[1].line, 5);
  EXPECT_EQ(root.children[1].text, "two");
}

TEST(Xml, KnowsItsOwnEntitiesAndCharactersByNumber) {
  const XmlElement root = ParseXml(
      "<a b='&quot;&apos;'>&lt;&amp;&gt; &#65;&#xe9;&#x20AC;&#x1F600;<![CDATA[<&>]]></a>", "file");
  EXPECT_EQ(*root.Attribute("b"), "\"'");
  EXPECT_EQ(root.text, "<&> A\xC3\xA9\xE2\x82\xAC\xF0\x9F\x98\x80<&>");
}

TEST(Xml, TellsWhereTheTextBetweenTheTagsIs) {
  const std::string text = "<a><world name='w'>in</world><b/></a>";
  const XmlElement world = ParseXml(text, "file").children[0];
  EXPECT_EQ(text.substr(world.tag_end, world.text_end - world.tag_end), "in");
}

TEST(XmlErrors, TakesNumbersAsOtherProgramsWriteThem) {
  XmlErrors errors("file");
  const std::vector<double> numbers = errors.Numbers(" +1. \n-.5\t007 1E-3 ", 4, 1, "x");
  EXPECT_EQ(numbers, (std::vector<double>{1, -0.5, 7, 1e-3}));
  EXPECT_NO_THROW(errors.Throw());
}

TEST(XmlErrors, RefusesWhatIsNoNumber) {
  for (const char* text : {"", "1 2", "nan", "-inf", "1e31", "1e-", "++1", "0x1", "1f", "1,2"}) {
    XmlErrors errors("file");
    EXPECT_EQ(errors.Numbers(text, 1, 7, "x"), std::vector<double>{0}) << text;
    EXPECT_THROW(errors.Throw(), FileErrors) << text;
  }
}

}  // namespace
}  // namespace vmech::xml_document_test
