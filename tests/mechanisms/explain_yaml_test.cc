#include "vmech/mechanisms/files/yaml/explain_yaml.h"

#include <gtest/gtest.h>

#include "vmech/mechanisms/files/document.h"

namespace vmech::explain_yaml_test {
namespace {

/// What a document says that is read as a number at its key `b`.
std::string Refusal(const std::string& text) {
  try {
    Document document(text, "f");
    document.root()["b"].Number();
    document.ThrowErrors();
  } catch (const FileErrors& errors) {
    return errors.what();
  }
  return "";
}

struct Slip {
  const char *text, *message;
};

TEST(ExplainYaml, TellsTheSlipWithItsLineAndWhatToDo) {
  const char* tab = "indented with a tab, which YAML does not take; replace the tabs";
  const char* slashes = "a comment begins with #, not with //";
  const Slip slips[] = {
      {"a:\n\tb: 1\n", "f:2:1: this line is indented with a tab"},
      {"a:\n  b: 1\n\tc: 2\n", tab},
      {"a:\n  b:\n  \tc: 2\n", "f:3:3: this line"},
      {"a:\n\t- 1\n", tab},
      {"// hello\na: 1\n", "f:1:1: a comment begins with #, not with //"},
      {"a: 1\n// hello\nb: 2\n", "f:2:1: a comment"},
      {"a:\n  // hello\n  b: 2\n", "f:2:3: a comment"},
      {"a: [1, 2] // hello\nb: 2\n", "f:1:11: a comment"},
      {"{ // hello\n \"a\": 1}\n", "f:1:3: a comment"},
      {"/* hello */\na: 1\n", "f:1:1: a comment"},
      {"b: 1 // hello\n", slashes},  // text to YAML, found where a number is wanted
      {"a: 1\nb: 1 // hello\n", "f:2:4: b: expected a number, not '1 // hello'; a comment"},
      {"a:\n    b: 1\n   c: 2\n",
       "f:3:4: this line is indented by 3 blanks, which fits no line above; indent it by 0 as line "
       "1 or 4 as line 2"},
      {"a:\n  b: 1\n    c: 2\n",
       "f:3:5: this line is indented by 4 blanks, deeper than line 2 (2), which has its value "
       "already"},
      {"a:\n  - 1\n - 2\n", "f:3:2: this line is indented by 1 blank,"},
      {"a:1\nb: 2\n", "f:1:3: a blank is missing after ':'"},
      {"a: {b: 1\nc: 2\n", "a bracket is not closed, or a comma is missing"},
      {"a:\n  b: {x: 1\n  y: 2}\n", "a bracket is not closed, or a comma is missing"},
  };
  for (const Slip& slip : slips) {
    EXPECT_NE(Refusal(slip.text).find(slip.message), std::string::npos) << slip.text << "\n"
                                                                        << Refusal(slip.text);
  }
}

TEST(ExplainYaml, TakesNoAddressAndNoQuotedTextForAComment) {
  for (const char* text : {"b: 1 # // no", "a: \"x // y\"\nb: none", "a: http://x\nb: none",
                           "a: 'x // y' # z\nb: none"}) {
    EXPECT_EQ(Refusal(text).find("//, "), std::string::npos) << text;
    EXPECT_EQ(Refusal(text).find(kSlashComment), std::string::npos) << text;
  }
  EXPECT_EQ(SlashComment("a: 1\nb: 2 // c\n", 2), 6);
  EXPECT_EQ(SlashComment("a: 1\nb: 2 // c\n", 1), 0);
  EXPECT_EQ(SlashComment("a: 1", 7), 0);
}

TEST(ExplainYaml, IsSilentWhereNothingIsKnown) {
  EXPECT_FALSE(ExplainYaml("a: b: 2\n", 1));
  EXPECT_FALSE(ExplainYaml("", 1));
}

}  // namespace
}  // namespace vmech::explain_yaml_test
