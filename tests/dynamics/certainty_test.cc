#include "vmech/dynamics/reactions/certainty.h"

#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <numbers>

#include "driven_examples.h"
#include "free_bodies.h"
#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/prepare_study.h"
#include "vmech/dynamics/loads/run_load_study.h"
#include "vmech/dynamics/loads/track_motion.h"
#include "vmech/kinematics/loops/mobility.h"

namespace vmech {
namespace {

/// One letter for each of fx fy fz mx my mz: certain, not determined, singular.
std::string Letters(const JointCertainty& joint) {
  std::string letters;
  for (Certainty certainty : joint) {
    letters += certainty == Certainty::kCertain         ? 'c'
               : certainty == Certainty::kNotDetermined ? 'n'
                                                        : 's';
  }
  return letters;
}

/// The verdict of linear algebra on free bodies: a component is certain exactly if no solution of
/// A x = 0 loads it.
std::vector<std::string> LettersOfFreeBodies(const LoadStudy& study, const PoseLoads& pose) {
  constexpr double kZero = 1e-9;    // of the largest singular value; the least others are 1e-3
  constexpr double kLoaded = 1e-6;  // share of a unit self-stress
  const EquilibriumProblem problem = FormEquilibrium(study, pose);
  const Eigen::JacobiSVD<MatrixXd> svd(problem.A, Eigen::ComputeFullV);
  const VectorXd& sigma = svd.singularValues();
  const Eigen::Index rank = (sigma.array() > kZero * sigma[0]).count();
  const MatrixXd N = svd.matrixV().rightCols(problem.A.cols() - rank);
  std::vector<std::string> letters;
  for (size_t j = 0; j < problem.wrenches.size(); ++j) {
    const MatrixXd loads =
        problem.wrenches[j] * N.middleRows(problem.first_column[j], problem.wrenches[j].cols());
    letters.emplace_back();
    for (int k = 0; k < 6; ++k) letters.back() += loads.row(k).norm() > kLoaded ? 'n' : 'c';
  }
  return letters;
}

class EveryVerdict : public testing::TestWithParam<DrivenExample> {};

TEST_P(EveryVerdict, IsThatOfTheNullSpaceOfAllFreeBodies) {
  const LoadStudy study = StudyOf(GetParam().name);
  const PreparedStudy prepared = PrepareStudy(study);
  const Motion motion = TrackMotion(study, prepared, 1e-13);
  const LoadStudyResult result = RunLoadStudy(study);
  for (const size_t i : {size_t{5}, size_t{12}, size_t{21}}) {
    const auto verdict = JudgeCertainty(prepared.model.tree, prepared.model.partition, motion.q(i));
    const auto expected = LettersOfFreeBodies(study, result.poses[i]);
    for (size_t j = 0; j < verdict.size(); ++j) {
      EXPECT_EQ(Letters(verdict[j]), expected[j]) << study.mechanism.joints[j].name << ", " << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Examples, EveryVerdict, testing::ValuesIn(DrivenExamples()),
                         [](const auto& info) { return TestName(info.param.name); });

void ExpectLetters(const std::string& example,
                   const std::vector<std::pair<std::string, std::string>>& expected) {
  const LoadStudy study = StudyOf(example);
  const LoadStudyResult result = RunLoadStudy(study);
  ASSERT_EQ(result.certainty.size(), expected.size());
  for (const auto& [joint, letters] : expected) {
    EXPECT_EQ(Letters(result.certainty.at(FindJoint(study.mechanism, joint))), letters) << joint;
  }
}

// Parallel pins let the links shift along the pins and tilt out of the plane only against each
// other's resistance: fz, mx and my are up to the bearings' play. Forces in the plane are certain.
TEST(Certainty, OfAPlanarFourBarIsThatOfThePlane) {
  ExpectLetters("four-bar", {{"main", "ccnnnc"},
                             {"crank_pin", "ccnnnc"},
                             {"rocker_pin", "ccnnnc"},
                             {"rocker_pivot", "ccnnnc"}});
}

TEST(Certainty, OfTheSquareFourBarIsThatOfThePlane) {
  ExpectLetters("square-four-bar",
                {{"a", "ccnnnc"}, {"b", "ccnnnc"}, {"c", "ccnnnc"}, {"d", "ccnnnc"}});
}

// The guide's axes are z along the slide, x up and y out of the plane: certain are the side force
// fx, the free fz and the moment my that keeps the slider from turning in the plane.
TEST(Certainty, OfASliderCrankIsThatOfThePlane) {
  ExpectLetters("slider-crank",
                {{"main", "ccnnnc"}, {"pin", "ccnnnc"}, {"wrist", "ccnnnc"}, {"guide", "cncncn"}});
}

// 1 + 3 + 3 + 1 freedoms less 6: mobility 2 as counted, no equation is left over.
TEST(Certainty, OfAnRssrIsComplete) {
  ExpectLetters(
      "rssr",
      {{"input", "cccccc"}, {"ball_a", "cccccc"}, {"ball_b", "cccccc"}, {"output", "cccccc"}});
}

// 1 + 3 + 2 + 1 freedoms less 6: mobility 1 as counted.
TEST(Certainty, OfAnRsupIsComplete) {
  ExpectLetters("rsup",
                {{"main", "cccccc"}, {"ball", "cccccc"}, {"cross", "cccccc"}, {"slide", "cccccc"}});
}

// Three wrenches that do no work about any of the four axes go around the loop unnoticed; together
// they load every component but the one that each hinge leaves free.
TEST(Certainty, OfABennettLinkageIsInTheFreeDirectionsOnly) {
  ExpectLetters("bennett", {{"input", "nnnnnc"},
                            {"crank_pin", "nnnnnc"},
                            {"rocker_pin", "nnnnnc"},
                            {"output", "nnnnnc"}});
}

// A single screw does no work about any of the six axes. It is oblique to all of them.
TEST(Certainty, OfABricardLinkageIsInTheFreeDirectionsOnly) {
  ExpectLetters("bricard", {{"p0", "nnnnnc"},
                            {"p1", "nnnnnc"},
                            {"p2", "nnnnnc"},
                            {"p3", "nnnnnc"},
                            {"p4", "nnnnnc"},
                            {"p5", "nnnnnc"}});
}

// Two hinges on one axis can press against each other in every way that each of them holds.
TEST(Certainty, OfADoorOnTwoHingesIsAboutTheirAxisOnly) {
  ExpectLetters("door-on-two-hinges", {{"lower", "nnnnnc"}, {"upper", "nnnnnc"}});
}

// The same door, its axis out of every plane of the drawing: rounding makes the hinges' axes two,
// by 1e-17 or so, and must not make a rigid structure of the door.
TEST(Certainty, OfADoorDoesNotDependOnRoundingInItsAxis) {
  LoadStudy study = StudyOf("door-on-two-hinges");
  const Matrix3d R = AxesFromZX(Vector3d(0.3, -0.5, 0.7), Vector3d(1, 2, 3));
  for (Anchor& anchor : study.mechanism.links[study.mechanism.ground].anchors) {
    anchor.X_LA = Posed{R, Vector3d(0.1, 0.2, -0.3)} * anchor.X_LA;
  }
  const LoadStudyResult result = RunLoadStudy(study);
  EXPECT_EQ(result.mobility, 1);
  EXPECT_EQ(result.redundant_equations, 5);
  EXPECT_EQ(Letters(result.certainty[0]), "nnnnnc");
}

// Three upward forces for force and moment; the rollers pass no force along the track and their
// pins no moment about z. Out of the plane every support holds all that it can. The tracks' axes
// are z along the beam, x up and y out of the plane.
TEST(Certainty, OfABeamOnThreeSupportsIsAlongItselfOnly) {
  const Mechanism beam = Example("beam-on-three-supports");
  const KinematicTree tree = BuildKinematicTree(beam);
  VectorXd q = StartCoordinates(tree);
  ASSERT_TRUE(Assemble(tree, {}, &q).closed);
  ASSERT_EQ(AnalyseMobility(tree, q).mobility, 0);
  const auto verdict = JudgeCertainty(tree, MakePartition(tree, {}, {}), q);
  auto letters = [&](const char* joint) { return Letters(verdict.at(FindJoint(beam, joint))); };
  EXPECT_EQ(letters("left"), "cnnnnc");
  EXPECT_EQ(letters("middle"), "cnnnnc");
  EXPECT_EQ(letters("right"), "cnnnnc");
  EXPECT_EQ(letters("middle_track"), "nncncn");
  EXPECT_EQ(letters("right_track"), "nncncn");
}

// Crank and rod in line, pushed at the slider: no force along them turns the crank, so the force
// that holds a moment on the crank grows without bound as this pose is approached; its small
// component across stays bounded.
TEST(Certainty, IsSingularAlongTheRodWhereTheSliderDrivesThroughItsDeadCentre) {
  const Mechanism mechanism = Example("slider-crank");
  const int guide = FindJoint(mechanism, "guide");
  const KinematicTree tree = BuildKinematicTree(mechanism, {.keep = {guide}, .cut = {}});
  VectorXd q = StartCoordinates(tree);
  const CoordinatePartition partition =
      PartitionForDrives(tree, AnalyseMobility(tree, q).q_general, {VelocityIndex(tree, guide, 0)});
  q.setZero();
  q[CoordinateIndex(tree, guide, 0)] = 0.2;  // [m], crank and rod in line
  EXPECT_LT(DistanceFromDeadCentre(tree, partition, q), kSingularTolerance);
  const auto verdict = JudgeCertainty(tree, partition, q);
  auto letters = [&](const char* joint) {
    return Letters(verdict.at(FindJoint(mechanism, joint)));
  };
  EXPECT_EQ(letters("main"), "scnnnc");
  EXPECT_EQ(letters("pin"), "scnnnc");
  EXPECT_EQ(letters("wrist"), "scnnnc");
  EXPECT_EQ(letters("guide"), "cnsncn");
}

}  // namespace
}  // namespace vmech
