#include "vmech/base/text/printable_text.h"

#include <gtest/gtest.h>

#include <string>

namespace vmech {
namespace {

TEST(PrintableText, KeepsWhatCanBeRead) {
  const std::string text = "crank (ß, ü, à, 曲柄, 🤖)\n\tindented";
  EXPECT_EQ(PrintableText(text), text);
  EXPECT_EQ(PrintableText(""), "");
}

TEST(PrintableText, ReplacesWhatActsOnATerminal) {
  EXPECT_EQ(PrintableText("a\x1b[31mb"), "a\uFFFD[31mb");
  EXPECT_EQ(PrintableText("good\rbad"), "good\uFFFDbad");
  EXPECT_EQ(PrintableText("\x7f\b\a"), "\uFFFD\uFFFD\uFFFD");
  EXPECT_EQ(PrintableText(std::string("a\0b", 3)), "a\uFFFDb");
  EXPECT_EQ(PrintableText("\u009b31m"), "\uFFFD31m");          // CSI in one character
  EXPECT_EQ(PrintableText("\u202egpj.exe"), "\uFFFDgpj.exe");  // turns the direction
  EXPECT_EQ(PrintableText("\u2066"), "\uFFFD");
}

TEST(PrintableText, ReplacesWhatIsNoUtf8) {
  EXPECT_EQ(PrintableText("M\xfcller"), "M\uFFFDller");
  EXPECT_EQ(PrintableText("\xc0\x9b"), "\uFFFD\uFFFD");                      // overlong
  EXPECT_EQ(PrintableText("\xed\xa0\x80"), "\uFFFD\uFFFD\uFFFD");            // half of a pair
  EXPECT_EQ(PrintableText("\xf4\x90\x80\x80"), "\uFFFD\uFFFD\uFFFD\uFFFD");  // beyond Unicode
  EXPECT_EQ(PrintableText("end\xe6\x9b"), "end\uFFFD");
}

TEST(PrintableText, WaitsForTheRestOfACharacter) {
  const std::string text = "曲\x1b柄";
  for (size_t cut = 0; cut <= text.size(); ++cut) {
    std::string shown, rest = text.substr(0, cut);
    rest.erase(0, AppendPrintable(rest, &shown));
    rest += text.substr(cut);
    EXPECT_EQ(AppendPrintable(rest, &shown), rest.size());
    EXPECT_EQ(shown, "曲\uFFFD柄");
  }
}

}  // namespace
}  // namespace vmech
