#include "vmech/mechanisms/cad/step/part_name.h"

#include <gtest/gtest.h>

namespace vmech::part_name_test {
namespace {

TEST(CleanName, KeepsLettersBeyondAsciiWhereverTheyStand) {
  for (const char* name : {"Fuß", "Menü", "à", "Größe ß", "日本", "A😀", "é"}) {
    EXPECT_EQ(CleanName(name, "part"), name);
  }
}

TEST(CleanName, ReplacesWhatFilesCannotHold) {
  EXPECT_EQ(CleanName("a/b,c\"d\\e", "part"), "a_b_c_d_e");
  EXPECT_EQ(CleanName("a\tb\x7f", "part"), "a_b_");
  EXPECT_EQ(CleanName("a\xC2\x85z", "part"), "a_z") << "U+0085, next line";
  EXPECT_EQ(CleanName("  a b ", "part"), "a b");
  EXPECT_EQ(CleanName("", "part"), "part");
  EXPECT_EQ(CleanName("   ", "part"), "part");
}

TEST(CleanName, ReplacesBytesThatAreNoUtf8OneByOne) {
  EXPECT_EQ(CleanName("Fu\xDF", "part"), "Fu_") << "Latin-1";
  EXPECT_EQ(CleanName("Fu\xC3", "part"), "Fu_") << "cut off";
  EXPECT_EQ(CleanName("\xC0\x80", "part"), "__") << "longer than need be";
  EXPECT_EQ(CleanName("\xED\xA0\x80", "part"), "___") << "a surrogate";
  EXPECT_EQ(CleanName("\xF4\x90\x80\x80", "part"), "____") << "beyond U+10FFFF";
}

TEST(IsUtf8, TellsItFromLatin1) {
  EXPECT_TRUE(IsUtf8(""));
  EXPECT_TRUE(IsUtf8("plain"));
  EXPECT_TRUE(IsUtf8("Größe 😀"));
  EXPECT_FALSE(IsUtf8("Gr\xF6\xDF\x65"));
  EXPECT_FALSE(IsUtf8("Fu\xC3"));
}

TEST(CleanName, CutsBetweenCharacters) {
  const std::string eighty(80, 'a');
  EXPECT_EQ(CleanName(eighty + "b", "part"), eighty);
  EXPECT_EQ(CleanName(eighty.substr(1) + "ß", "part"), eighty.substr(1));
  EXPECT_EQ(CleanName(eighty.substr(2) + "ß", "part"), eighty.substr(2) + "ß");
}

}  // namespace
}  // namespace vmech::part_name_test
