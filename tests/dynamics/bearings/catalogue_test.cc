#include "vmech/dynamics/bearings/catalogue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace vmech {
namespace {

const Bearing& Find(const std::vector<Bearing>& catalogue, const std::string& designation) {
  return *std::find_if(catalogue.begin(), catalogue.end(),
                       [&](const Bearing& b) { return b.designation == designation; });
}

std::string MessageFor(const std::string& text) {
  try {
    ParseCatalogue(text, "own.csv");
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "accepted";
}

TEST(BuiltInCatalogue, HoldsTheLowestRatingsOfFiveMakers) {
  const std::vector<Bearing>& catalogue = BuiltInCatalogue();
  ASSERT_EQ(catalogue.size(), 52u);
  const Bearing& bearing = Find(catalogue, "6208");
  EXPECT_DOUBLE_EQ(bearing.bore, 0.040);
  EXPECT_DOUBLE_EQ(bearing.outer_diameter, 0.080);
  EXPECT_DOUBLE_EQ(bearing.width, 0.018);
  EXPECT_DOUBLE_EQ(bearing.dynamic_rating, 29100);  // Koyo and NSK; SKF prints 32 500
  EXPECT_DOUBLE_EQ(bearing.static_rating, 17800);   // Koyo
  EXPECT_DOUBLE_EQ(bearing.f0, 14.0);
  EXPECT_NEAR(bearing.speed_grease, 8300 * std::numbers::pi / 30, 1e-9);
  EXPECT_DOUBLE_EQ(bearing.axial_limit, 0.5);
  EXPECT_DOUBLE_EQ(Find(catalogue, "6008").axial_limit, 0.25);
}

TEST(BuiltInCatalogue, IsInOrderOfSizeAndPlausible) {
  const std::vector<Bearing>& catalogue = BuiltInCatalogue();
  EXPECT_TRUE(std::is_sorted(catalogue.begin(), catalogue.end(), IsSmaller));
  for (const Bearing& b : catalogue) {
    EXPECT_GT(b.dynamic_rating, b.static_rating) << b.designation;
    EXPECT_GT(b.speed_oil, b.speed_grease) << b.designation;
    EXPECT_GT(b.f0, 11) << b.designation;
    EXPECT_LT(b.f0, 18) << b.designation;
  }
}

TEST(BuiltInCatalogue, IsTheDataFile) {
  const std::vector<Bearing> file = ReadCatalogue(VMECH_CATALOGUE_FILE);
  ASSERT_EQ(file.size(), BuiltInCatalogue().size());
  for (size_t i = 0; i < file.size(); ++i) {
    EXPECT_EQ(file[i].designation, BuiltInCatalogue()[i].designation);
    EXPECT_EQ(file[i].dynamic_rating, BuiltInCatalogue()[i].dynamic_rating);
  }
}

TEST(ParseCatalogue, TakesColumnsInAnyOrderAndLeavesOutOptionalOnes) {
  const std::vector<Bearing> catalogue = ParseCatalogue(
      "# own\r\nkind, designation, C_kN, C0_kN, d_mm, D_mm, B_mm\r\n\r\n"
      "cylindrical_roller, NU 204, 28.5, 22, 20, 47, 14\r\n",
      "own.csv");
  ASSERT_EQ(catalogue.size(), 1u);
  EXPECT_EQ(catalogue[0].kind, BearingKind::kCylindricalRoller);
  EXPECT_EQ(catalogue[0].designation, "NU 204");
  EXPECT_TRUE(std::isinf(catalogue[0].speed_oil));
}

TEST(ParseCatalogue, SaysWhereAndWhatIsWrong) {
  const std::string header = "kind,designation,d_mm,D_mm,B_mm,C_kN,C0_kN,f0\n";
  const std::string ball = "deep_groove_ball,", good = ball + "6004,20,42,12,9.36,5,13.9\n";
  const struct {
    std::string text, message;
  } cases[] = {
      {"", "own.csv:1: the catalogue holds no bearings"},
      {header, "the catalogue holds no bearings"},
      {"designation,d_mm,D_mm,B_mm,C_kN,C0_kN,bore\n", "own.csv:1: unknown column 'bore'"},
      {"designation,knd,d_mm,D_mm,B_mm,C_kN,C0_kN\n", "'knd'; did you mean 'kind'?"},
      {"kind,designation,d_mm,D_mm,B_mm,C_kN\n", "own.csv:1: column 'C0_kN' is missing"},
      {"designation,d_mm,D_mm,B_mm,C_kN,C0_kN,f0\n", "own.csv:1: column 'kind' is missing"},
      {"d_mm," + header, "own.csv:1: column 'd_mm' appears twice"},
      {header + ball + "6004,20,42\n", "own.csv:2: 4 fields, but the header names 8 columns"},
      {header + ball + "6004,20,42,12,9.36,5,13.9,1\n", "own.csv:2: 9 fields"},
      {header + "# x\n" + ball + "6004,20 mm,42,12,9.36,5,13.9\n", "own.csv:3: d_mm is '20 mm'"},
      {header + ball + "6004,20,42,12,-9.36,5,13.9\n", "own.csv:2: C_kN is '-9.36'"},
      {header + ball + "6004,20,42,12,9.36,nan,13.9\n", "own.csv:2: C0_kN is 'nan'"},
      {header + ball + "6004,20,42,12,9.36,5,\n", "own.csv:2: f0 is ''"},
      {header + ball + "6004,20,42,12,1e999,5,14\n", "own.csv:2: C_kN is '1e999'"},
      {header + ball + ",20,42,12,9.36,5,13.9\n", "own.csv:2: designation is empty"},
      {header + ball + "6004,42,42,12,9.36,5,13.9\n", "own.csv:2: bore d_mm = 42 is not below"},
      {header + good + good, "own.csv:3: designation '6004' appears twice"},
      {header + ",6004,20,42,12,9.36,5,13.9\n", "own.csv:2: kind is '', but must be"},
      {header + "spherical,6004,20,42,12,9.36,5,13.9\n", "own.csv:2: kind is 'spherical', but"},
  };
  for (const auto& [text, message] : cases) {
    EXPECT_NE(MessageFor(text).find(message), std::string::npos) << MessageFor(text);
  }
}

TEST(ParseCatalogue, ReportsEveryErrorAtOnce) {
  const std::string message = MessageFor(
      "designation,kind,d_mm,D_mm,B_mm,C_kN,C0_kN,f0\n"
      "a,deep_groove_ball,x,42,12,9,5,14\nb,deep_groove_ball,20,42,12,9,y,14\n");
  EXPECT_NE(message.find("own.csv:2: d_mm is 'x'"), std::string::npos) << message;
  EXPECT_NE(message.find("own.csv:3: C0_kN is 'y'"), std::string::npos) << message;
}

TEST(ReadCatalogue, NamesAFileThatIsNotThere) {
  try {
    ReadCatalogue("/nowhere/bearings.csv");
    FAIL() << "a file that does not exist was read";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("/nowhere/bearings.csv"), std::string::npos);
  }
}

}  // namespace
}  // namespace vmech
