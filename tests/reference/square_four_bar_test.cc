#include <gtest/gtest.h>

#include "reference_case.h"

#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/run_load_study.h"

namespace vmech::reference::square_four_bar_test {
namespace {

/// Square four-bar in space, at rest and let go: geometry of fourBarMechanism3D.py of EXUDYN. Which
/// reactions are unique: M. Wojtyra, Multibody System Dynamics 14 (2005) 23-46; figures by singular
/// values of the constraint Jacobian in absolute coordinates.
struct Row {
  const char* joint;
  double force[2];  // on the second link, world x and y [N]
};
constexpr Row kRows[] = {
    {"a", {-1.505994005994, 735.75}},
    {"b", {0.497002997003, 245.25}},
    {"c", {-0.497002997003, -245.25}},
    {"d", {-1.505994005994, 735.75}},
};
constexpr double kTolerance = 1e-9 * 735.75;  // [N] of the largest force

class SquareFourBar : public testing::Test {
 protected:
  const Mechanism square_ = Example("square-four-bar");
  // The bars' moment about their pivots is 10 N m, their inertia 1001/12 kg m^2.
  const LoadStudyResult result_ = RunLoadStudy(StudyAt(square_, {{"a", {0, 0, -120.0 / 1001}}}));
};

TEST_F(SquareFourBar, UniqueReactionsAreThoseOfTheSingularValues) {
  for (const Row& row : kRows) {
    const Vector3d force = OnSecond_W(square_, result_.poses.front(), row.joint).force;
    EXPECT_NEAR(force.x(), row.force[0], kTolerance) << row.joint;
    EXPECT_NEAR(force.y(), row.force[1], kTolerance) << row.joint;
  }
  EXPECT_NEAR(result_.poses.front().drives[0].force, 0, kTolerance);
}

TEST_F(SquareFourBar, ForceInThePlaneAndMomentAboutThePinAreCertainOnly) {
  EXPECT_EQ(result_.mobility, 1);
  EXPECT_EQ(result_.redundant_equations, 3);
  for (const JointCertainty& joint : result_.certainty) {
    for (const int component : {0, 1, 5}) {
      EXPECT_EQ(joint[component], Certainty::kCertain) << component;
    }
    for (const int component : {2, 3, 4}) {
      EXPECT_EQ(joint[component], Certainty::kNotDetermined) << component;
    }
  }
}

}  // namespace
}  // namespace vmech::reference::square_four_bar_test
