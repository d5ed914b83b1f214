// Mechanisms whose overconstrained loops close only for exact figures, drawn with few digits.

#include <gtest/gtest.h>

#include <cmath>
#include <ostream>

#include "driven_examples.h"
#include "support/rounded.h"
#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/run_load_study.h"
#include "vmech/kinematics/loops/mobility.h"

namespace vmech {
namespace {

struct Drawn {
  const char* name;
  const char* drive;
};
void PrintTo(const Drawn& drawn, std::ostream* out) {
  *out << TestName(drawn.name);
}

Mechanism MechanismOf(const std::string& name) {
  return name == "watt" || name == "stephenson" ? SixBar(name == "watt") : Example(name);
}

LoadStudy StudyOfDrawn(const Mechanism& mechanism, const Drawn& drawn) {
  LoadStudy study;
  study.mechanism = mechanism;
  const int joint = FindJoint(mechanism, drawn.drive);
  study.drives = {{joint, 0, MotionLaw::Uniform(mechanism.joints[joint].start[0], 2, 3)}};
  for (int i = 0; i < 12; ++i) study.times.push_back(0.04 * i);
  return study;
}

/// Largest difference of certain components, over the largest load.
double DifferenceOfCertain(const LoadStudyResult& a, const LoadStudyResult& b,
                           const Mechanism& mechanism) {
  double largest = 0;
  LoadScale scale{0, 0};
  for (const PoseLoads& pose : a.poses) {
    const LoadScale here = ScaleOf(mechanism, pose);
    scale.force = std::max(scale.force, here.force);
    scale.moment = std::max(scale.moment, here.moment);
  }
  for (size_t i = 0; i < a.poses.size(); ++i) {
    for (size_t j = 0; j < a.certainty.size(); ++j) {
      const Vector6d difference = (a.poses[i].joints[j] - b.poses[i].joints[j]).Stacked();
      for (int k = 0; k < 6; ++k) {
        if (a.certainty[j][k] != Certainty::kCertain) continue;
        largest = std::max(largest, std::abs(difference[k]) / (k < 3 ? scale.force : scale.moment));
      }
    }
  }
  return largest;
}

class RoundedFigures : public testing::TestWithParam<Drawn> {};

TEST_P(RoundedFigures, GiveTheMechanismThatIsMeant) {
  const Mechanism drawn = MechanismOf(GetParam().name);
  for (const unsigned seed : {1U, 2U, 3U}) {
    const Mechanism exact = DrawnWithDigits(drawn, 17, seed);
    const LoadStudyResult expected = RunLoadStudy(StudyOfDrawn(exact, GetParam()));
    for (const int digits : {15, 12, 9, 6, 5, 4}) {
      const Mechanism rounded = DrawnWithDigits(drawn, digits, seed);
      const LoadStudyResult result = RunLoadStudy(StudyOfDrawn(rounded, GetParam()));
      EXPECT_EQ(result.mobility, expected.mobility) << digits << " digits";
      EXPECT_EQ(result.redundant_equations, expected.redundant_equations);
      EXPECT_EQ(result.certainty, expected.certainty) << digits << " digits";
      EXPECT_LE(DifferenceOfCertain(expected, result, exact), 10 * std::pow(10, 1 - digits) + 1e-11)
          << digits << " digits";
      EXPECT_LE(result.max_power_error, 1e-9) << digits << " digits";
    }
  }
}

// Drawn where it stands, in world axes: anchors coincide to the last digit, axes do not lie as they
// have to. Closed as it is, such a mechanism would be a structure.
TEST_P(RoundedFigures, MoveAlsoIfTheyAreDrawnAssembled) {
  const Mechanism assembled = RequireAssembled(MechanismOf(GetParam().name)).mechanism;
  const KinematicTree exact = BuildKinematicTree(assembled);
  const Mobility expected = AnalyseMobility(exact, StartCoordinates(exact));
  for (const int digits : {12, 9, 6, 5, 4}) {
    const AssembledMechanism rounded = AssembleMechanism(DrawnWithDigits(assembled, digits, 7));
    ASSERT_TRUE(rounded.summary.closed) << digits << " digits: " << rounded.summary.message;
    const KinematicTree tree = BuildKinematicTree(rounded.mechanism);
    const Mobility mobility = AnalyseMobility(tree, StartCoordinates(tree));
    EXPECT_EQ(mobility.mobility, expected.mobility) << digits << " digits";
    EXPECT_EQ(mobility.rank, expected.rank) << digits << " digits";
  }
}

INSTANTIATE_TEST_SUITE_P(, RoundedFigures,
                         testing::Values(Drawn{"four-bar", "main"}, Drawn{"slider-crank", "main"},
                                         Drawn{"stephenson", "a"}, Drawn{"watt", "a"},
                                         Drawn{"bennett", "input"}, Drawn{"bricard", "p0"}),
                         testing::PrintToStringParamName());

}  // namespace
}  // namespace vmech
