#include "vmech/mechanisms/files/document.h"

#include <gtest/gtest.h>

namespace vmech::document_test {
namespace {

/// The message with which a text is refused; empty if it is accepted.
std::string Refusal(const std::string& text) {
  try {
    Document document(text, "f");
    document.ThrowErrors();
  } catch (const FileErrors& errors) {
    return errors.what();
  }
  return "";
}

TEST(Document, KnowsWhereEveryValueStands) {
  Document document("a:\n  b: [1, 2,\n      3]\n", "f");
  const Node third = document.root()["a"]["b"].List()[2];
  EXPECT_EQ(third.path(), "a.b[2]");
  EXPECT_EQ(third.line(), 3);
  EXPECT_EQ(third.column(), 7);
  EXPECT_EQ(third.Number(), 3);
}

TEST(Document, KeepsKeysInTheOrderOfTheFile) {
  Document document("{z: 1, a: 2, m: 3}", "f");
  std::string keys;
  for (const Node& entry : document.root().Map()) keys += entry.key();
  EXPECT_EQ(keys, "zam");
}

TEST(Document, ReadsNumbersToTheLastBit) {
  Document document("[0.1, -1e-3, +5, .5, 5., 6.02214076E+23, 1.7976931348623157e-30, 0]", "f");
  const double expected[] = {0.1, -1e-3, 5, .5, 5., 6.02214076E+23, 1.7976931348623157e-30, 0};
  const std::vector<Node> entries = document.root().List();
  for (size_t i = 0; i < entries.size(); ++i) EXPECT_EQ(entries[i].Number(), expected[i]);
  EXPECT_TRUE(document.ok());
}

TEST(Document, TakesNothingElseForANumber) {
  for (const char* word : {"0x10", "010", "1_000", "1e", "--1", "1.2.3", "true", "1 2", "1e999",
                           ".inf", "-.NaN", "nan", "\"1\"", "~", "[1]", "{}", "1e31", "-", "."}) {
    Document document(word, "f");
    EXPECT_EQ(document.root().Number(42), 42) << word;
    EXPECT_FALSE(document.ok()) << word;
  }
}

TEST(Document, AbsentValuesGiveTheFallbackInSilence) {
  Document document("{}", "f");
  const Node absent = document.root()["a"]["b"];
  EXPECT_FALSE(absent);
  EXPECT_EQ(absent.Number(7), 7);
  EXPECT_EQ(absent.Text("none"), "none");
  EXPECT_EQ(absent.Vector3(Vector3d(1, 2, 3)), Vector3d(1, 2, 3));
  EXPECT_TRUE(absent.List().empty());
  EXPECT_TRUE(document.ok());
}

TEST(Document, TellsTextFromWhatLooksLikeANumber) {
  Document document("[word, \"1.0\", 1.0, true, 'yes', a b]", "f");
  const std::vector<Node> entries = document.root().List();
  EXPECT_EQ(entries[0].Text(), "word");
  EXPECT_EQ(entries[1].Text(), "1.0");
  EXPECT_EQ(entries[4].Text(), "yes");
  EXPECT_EQ(entries[5].Text(), "a b");
  EXPECT_TRUE(document.ok());
  entries[2].Text();
  entries[3].Text();
  EXPECT_THROW(document.ThrowErrors(), FileErrors);
}

TEST(Document, ReadsJsonAsWritten) {
  Document document(
      "{\"a\":{\"b\":[1.5,-2e-3]},\t\"c\\u00e9\":\"x\\/\\n\\\"y\\\"\",\"d\":null}\r\n", "f");
  EXPECT_EQ(document.root()["a"]["b"].List()[1].Number(), -2e-3);
  EXPECT_EQ(document.root()["c\u00e9"].Text(), "x/\n\"y\"");
  EXPECT_EQ(document.root()["d"].kind(), Node::Kind::kNull);
  EXPECT_TRUE(document.ok());
}

TEST(Document, RangesOfNumbersAreStatedInTheMessage) {
  Document document("[-1, 0, 2.5, 7]", "f");
  const std::vector<Node> entries = document.root().List();
  EXPECT_EQ(entries[0].NonNegative(3), 3);
  EXPECT_EQ(entries[1].Positive(3), 3);
  EXPECT_EQ(entries[2].Integer(3, 0, 5), 3);
  EXPECT_EQ(entries[3].Integer(3, 0, 5), 3);
  try {
    document.ThrowErrors();
    FAIL();
  } catch (const FileErrors& errors) {
    ASSERT_EQ(errors.errors().size(), 4u);
    EXPECT_EQ(errors.errors()[3].message, "must be a whole number from 0 to 5, not 7");
  }
}

TEST(Document, KeysOfTheUserBeginWithX) {
  Document document("{length: 1, x-colour: red, x-: []}", "f");
  EXPECT_TRUE(document.root().CheckKeys({"length"}));
  EXPECT_TRUE(document.ok());
}

TEST(Document, RefusesDeepNestingBeforeTheStackEnds) {
  const size_t depth = 200000;
  const std::string lists = std::string(depth, '[') + std::string(depth, ']');
  EXPECT_NE(Refusal(lists).find("nested more than 64 deep"), std::string::npos);
  EXPECT_NE(Refusal(std::string(depth, '[')), "");
  EXPECT_NE(Refusal(std::string(depth, '{')), "");
  std::string dashes;
  for (size_t i = 0; i < depth; ++i) dashes += "- ";
  EXPECT_NE(Refusal(dashes + "1").find("nested more than 64 deep"), std::string::npos);
  EXPECT_EQ(Refusal(std::string(kMaxNesting, '[') + std::string(kMaxNesting, ']')), "");
}

TEST(Document, RefusesTheBillionLaughs) {
  EXPECT_NE(Refusal("a: &a [1, 1]\nb: &b [*a, *a]\nc: [*b, *b]").find("write the value out"),
            std::string::npos);
}

TEST(Document, RefusesEmptyAndHugeFiles) {
  EXPECT_EQ(Refusal(""), "f: the file is empty");
  EXPECT_EQ(Refusal("# only a comment\n"), "f: the file is empty");
  EXPECT_EQ(Refusal(std::string(kMaxFileBytes + 1, ' ')), "f: larger than 8 MB");
}

TEST(Document, StopsWhenThereIsTooMuchToReport) {
  Document document("[]", "f");
  EXPECT_THROW(while (true) document.root().Error("again"), FileErrors);
}

TEST(Document, FilesThatCannotBeReadAreErrorsOfTheFile) {
  EXPECT_THROW(ReadTextFile("no/such/file.yaml"), FileErrors);
  EXPECT_THROW(ReadTextFile("."), FileErrors);
}

TEST(DidYouMean, FindsTheNearestAndLeavesTheFarAlone) {
  const std::vector<std::string> names{"crank/pin", "crank/main", "coupler/pin"};
  EXPECT_EQ(DidYouMean("cranc/pin", names), "; did you mean 'crank/pin'?");
  EXPECT_EQ(DidYouMean("crank/mian", names), "; did you mean 'crank/main'?");  // a swap is one edit
  EXPECT_EQ(DidYouMean("piston", names), "");
  EXPECT_EQ(DidYouMean("", names), "");
}

TEST(Quoted, IsFitForATerminal) {
  EXPECT_EQ(Quoted("a\x1b[31m"), "'a\uFFFD[31m'");
  EXPECT_EQ(Quoted(std::string(100, 'a')).size(), 60 + 5u);
}

}  // namespace
}  // namespace vmech::document_test
