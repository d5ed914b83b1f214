#include "vmech/mechanisms/files/read_dh.h"

#include <gtest/gtest.h>

#include <numbers>
#include <ostream>
#include <string>

#include "support/examples.h"
#include "vmech/mechanisms/dh/denavit_hartenberg.h"
#include "vmech/mechanisms/dh/dh_parameters.h"
#include "vmech/mechanisms/files/reader.h"

namespace vmech::read_dh_test {
namespace {

constexpr double kRounding = 1e-14;
constexpr double kDegree = std::numbers::pi / 180;

/// Two links on rows, and a third on a branch of the first, closed by a pin.
const std::string kRows = R"(vmech: "1.0"
units: {length: mm, angle: deg}
gravity: [0, 0, 0]
ground: base
links:
  base: {anchors: {foot: {dh: [{theta: 90, d: 10}, {a: 20, alpha: 30, beta: 5}]}}}
  arm:  {anchors: {second: {origin: [5, 0, 0]}}}
  hand: {anchors: {tip: {dh: {a: 7}}}}
joints:
  waist: {type: revolute, connects: [base/foot, arm], dh: {theta: 15, d: 40, a: 100, alpha: -90}}
  slide: {type: prismatic, connects: [arm, hand], dh: {theta: 90, d: 3}}
  pin:   {type: revolute, connects: [arm/second, hand/tip]}
grasps:
  tip: {link: hand, dh: [{theta: 1, d: 2, a: 3, alpha: 4}, {theta: 5, d: 6}]}
)";

void ExpectPose(const Posed& X, const Posed& expected) {
  EXPECT_LT((X.R - expected.R).cwiseAbs().maxCoeff(), kRounding);
  EXPECT_LT((X.p - expected.p).cwiseAbs().maxCoeff(), kRounding);
}

TEST(ReadDh, PutsTheJointOnTheAxisOfItsFirstLinkAndTheRowBehindIt) {
  const Mechanism mechanism = ParseMechanism(kRows, "rows.yaml");
  const Joint& slide = mechanism.joints[1];
  EXPECT_EQ(mechanism.anchor(slide.first).name, "slide");
  ExpectPose(mechanism.anchor(slide.first).X_LA, Posed());
  ExpectPose(mechanism.anchor(slide.second).X_LA.inverse(), PoseOf({90 * kDegree, 3e-3, 0, 0, 0}));
}

TEST(ReadDh, TakesAnAnchorForTheFirstEnd) {
  const Mechanism mechanism = ParseMechanism(kRows, "rows.yaml");
  const Joint& waist = mechanism.joints[0];
  EXPECT_EQ(mechanism.anchor(waist.first).name, "foot");
  ExpectPose(
      mechanism.anchor(waist.first).X_LA,
      PoseOf({90 * kDegree, 10e-3, 0, 0, 0}) * PoseOf({0, 0, 20e-3, 30 * kDegree, 5 * kDegree}));
  ExpectPose(mechanism.anchor(waist.second).X_LA.inverse(),
             PoseOf({15 * kDegree, 40e-3, 100e-3, -90 * kDegree, 0}));
}

TEST(ReadDh, TakesRowsForAnchorsAndGrasps) {
  const Mechanism mechanism = ParseMechanism(kRows, "rows.yaml");
  ExpectPose(mechanism.anchor(mechanism.joints[2].second).X_LA, PoseOf({0, 0, 7e-3, 0, 0}));
  ExpectPose(mechanism.grasps[0].X_LG, PoseOf({1 * kDegree, 2e-3, 3e-3, 4 * kDegree, 0}) *
                                           PoseOf({5 * kDegree, 6e-3, 0, 0, 0}));
}

TEST(ReadDh, OfThePuma560GivesItsTableBack) {
  const Mechanism puma = Example("puma-560");
  const DhTable table = DeduceDhTable(puma, FindSpanningTree(puma));
  const DhParameters expected[] = {
      {0, 0.672, 0, 90, 0},  {0, 0, 0.4318, 0, 0}, {0, 0.15005, 0.0203, -90, 0},
      {0, 0.4318, 0, 90, 0}, {0, 0, 0, -90, 0},    {0, 0, 0, 0, 0}};
  for (int i = 0; i < 6; ++i) {
    const DhParameters& row = table.rows[table.row_of_link[i + 1]].parameters;
    EXPECT_NEAR(row.theta, expected[i].theta, kRounding);
    EXPECT_NEAR(row.d, expected[i].d, kRounding);
    EXPECT_NEAR(row.a, expected[i].a, kRounding);
    EXPECT_NEAR(row.alpha, expected[i].alpha * kDegree, kRounding);
  }
}

struct Malformed {
  std::string subject, passage, replacement;
  int line;
  std::string message;
};

void PrintTo(const Malformed& malformed, std::ostream* out) {
  *out << malformed.subject;
}

class MalformedDh : public testing::TestWithParam<Malformed> {};

TEST_P(MalformedDh, IsRefusedWithPlaceAndRemedy) {
  const Malformed& m = GetParam();
  std::string text = kRows;
  ASSERT_NE(text.find(m.passage), text.npos);
  text.replace(text.find(m.passage), m.passage.size(), m.replacement);
  try {
    ParseMechanism(text, "rows.yaml");
    FAIL() << "accepted";
  } catch (const FileErrors& errors) {
    EXPECT_EQ(errors.errors()[0].line, m.line) << errors.what();
    EXPECT_NE(std::string(errors.what()).find(m.message), std::string::npos) << errors.what();
    EXPECT_EQ(errors.errors().size(), 1u) << errors.what();
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, MalformedDh,
    testing::Values(Malformed{"UnknownParameter", "d: 3}", "r: 3}", 11, "r"},
                    Malformed{"NotANumber", "d: 3}", "d: three}", 11, "joints.slide.dh.d"},
                    Malformed{"NotARow", "dh: {theta: 90, d: 3}", "dh: [90]", 11, "slide.dh[0]"},
                    Malformed{"UnknownLink", "[arm, hand], dh", "[arm, hend], dh", 11,
                              "link 'hend' not found; did you mean 'hand'?"},
                    Malformed{"SecondEndAnAnchor", "[arm, hand], dh", "[arm, hand/tip], dh", 11,
                              "write the link's name alone"},
                    Malformed{"LinkWithoutRow", "[arm, hand], dh: {theta: 90, d: 3}",
                              "[arm/second, hand]", 11, "'hand' not found"},
                    Malformed{"NameTaken", "{second:", "{slide: {}, second:", 11, "another name"},
                    Malformed{"FrameBesideRow", "tip: {dh:", "tip: {origin: [0, 0, 1], dh:", 8,
                              "not used beside 'dh'"},
                    Malformed{"ItsOwnLink", "[arm, hand], dh", "[hand, hand], dh", 11,
                              "with itself"}),
    [](const auto& info) { return info.param.subject; });

}  // namespace
}  // namespace vmech::read_dh_test
