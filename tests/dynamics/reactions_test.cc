// The rules for what statics leaves open, against elastic joints and least norms on free bodies.

#include "vmech/dynamics/reactions/reactions.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <Eigen/QR>

#include "driven_examples.h"
#include "free_bodies.h"
#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/pose/pose_loads.h"
#include "vmech/dynamics/loads/pose/store_pose_loads.h"
#include "vmech/dynamics/loads/prepare_study.h"
#include "vmech/dynamics/loads/run_load_study.h"
#include "vmech/dynamics/loads/track_motion.h"

namespace vmech {
namespace {

constexpr double kRule = 1e-8;  // relative; stiffnesses differ by up to 1e6

/// Stiffness of the joint against motion of M in F, axes of F.
Matrix6d JointStiffness(const Joint& joint, const FreeJoint& free, double length) {
  Vector6d k;
  k << Vector3d::Constant(kDefaultStiffness),
      Vector3d::Constant(kDefaultStiffness * length * length);
  if (joint.stiffness) k = *joint.stiffness;
  // Revolute and prismatic joints only: their freedoms are along axes of F.
  const Vector6d freedom = free.freedoms.col(0);
  return (k.array() * (1 - freedom.array().abs())).matrix().asDiagonal();
}

/// Links on springs (displacement method): the wrench of a joint is -K_j d_j with d_j = A_j' u from
/// the links' displacements u, and its drive lets nothing move along itself:
///
///   [ -sum A_j K_j A_j'  A_d ] [ u      ]   [ b ]
///   [      A_d'           0  ] [ lambda ] = [ 0 ].
///
/// Linear, so that the answer is the same however stiff the joints are, and in the limit.
std::vector<Wrenchd> WrenchesOfElasticJoints(const LoadStudy& study, const PoseLoads& pose,
                                             double length) {
  using MatrixXl = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
  const EquilibriumProblem problem = FormEquilibrium(study, pose);
  const Eigen::Index n = problem.b.size(), drives = static_cast<Eigen::Index>(study.drives.size());
  MatrixXl K = MatrixXl::Zero(n + drives, n + drives);
  Eigen::Index drive = n;
  for (size_t j = 0; j < problem.joints.size(); ++j) {
    const Matrix6d K_j = JointStiffness(study.mechanism.joints[j], problem.joints[j], length);
    K.topLeftCorner(n, n) -=
        (problem.on_links[j] * K_j * problem.on_links[j].transpose()).cast<long double>();
    for (Eigen::Index k = 0; k < problem.driven[j].cols(); ++k, ++drive) {
      const VectorXd A_d = problem.on_links[j] * problem.driven[j].col(k);
      K.col(drive).head(n) = A_d.cast<long double>();
      K.row(drive).head(n) = A_d.transpose().cast<long double>();
    }
  }
  MatrixXl right = MatrixXl::Zero(n + drives, 1);
  right.topRows(n) = problem.b.cast<long double>();
  const VectorXd x = K.fullPivLu().solve(right).cast<double>();
  std::vector<Wrenchd> joints;
  drive = n;
  for (size_t j = 0; j < problem.joints.size(); ++j) {
    const Matrix6d K_j = JointStiffness(study.mechanism.joints[j], problem.joints[j], length);
    Vector6d W = -K_j * (problem.on_links[j].transpose() * x.head(n));
    for (Eigen::Index k = 0; k < problem.driven[j].cols(); ++k) {
      W += problem.driven[j].col(k) * x[drive++];
    }
    joints.push_back({W.head<3>(), W.tail<3>()});
  }
  return joints;
}

/// Of all solutions of A x = b the one with the least |force|^2 + |moment|^2 / length^2.
std::vector<Wrenchd> WrenchesOfLeastNorm(const LoadStudy& study, const PoseLoads& pose,
                                         double length) {
  const EquilibriumProblem problem = FormEquilibrium(study, pose);
  const VectorXd x0 = problem.A.completeOrthogonalDecomposition().solve(problem.b);
  Eigen::FullPivLU<MatrixXd> lu(problem.A);
  const MatrixXd kernel = lu.setThreshold(1e-9).kernel();
  MatrixXd weighted(6 * problem.wrenches.size(), problem.A.cols());
  weighted.setZero();
  Vector6d weight;
  weight << Vector3d::Ones(), Vector3d::Constant(1 / length);
  for (size_t j = 0; j < problem.wrenches.size(); ++j) {
    weighted.block(6 * static_cast<Eigen::Index>(j), problem.first_column[j], 6,
                   problem.wrenches[j].cols()) = weight.asDiagonal() * problem.wrenches[j];
  }
  const VectorXd y = (weighted * kernel).completeOrthogonalDecomposition().solve(-(weighted * x0));
  return JointWrenches(problem, x0 + kernel * y);
}

/// The pose of a structure, which no study can move.
PoseLoads LoadsOfStructure(const LoadStudy& study) {
  LoadModel model;
  model.tree = BuildKinematicTree(study.mechanism);
  model.partition = MakePartition(model.tree, {}, {});
  model.compliances = CompliancesForRule(model.tree, study.rule, model.tree.length);
  model.external = study.external;
  model.rule = study.rule;
  Motion motion;
  motion.times = {0};
  VectorXd q = StartCoordinates(model.tree);
  EXPECT_TRUE(Assemble(model.tree, {}, &q).closed);
  motion.coordinates.assign(q.begin(), q.end());
  motion.cut_positions.assign(model.tree.loops.size(), Vector3d::Zero());
  LoadWorkspace<double> ws(model);
  const auto loads = std::make_shared<LoadArrays>(MakeLoadArrays(model, motion, true));
  EXPECT_TRUE(EvaluatePoseLoads(model, motion, 0, &ws));
  StorePoseLoads(model, motion, 0, ws, loads.get());
  return {loads, 0};
}

double DifferenceFrom(const std::vector<Wrenchd>& expected, const Mechanism& mechanism,
                      const PoseLoads& pose) {
  return RelativeDifference(mechanism, pose, expected);
}

class RulesOf : public testing::TestWithParam<const char*> {};

TEST_P(RulesOf, StiffnessIsThatOfElasticJoints) {
  LoadStudy study = StudyOf(GetParam());
  study.rule = ReactionRule::kStiffness;
  const LoadStudyResult result = RunLoadStudy(study);
  for (const PoseLoads& pose : result.poses) {
    EXPECT_LE(DifferenceFrom(WrenchesOfElasticJoints(study, pose, result.norm_length),
                             study.mechanism, pose),
              kRule);
  }
}

TEST_P(RulesOf, StiffnessIsThatOfElasticJointsWithStatedStiffnesses) {
  LoadStudy study = StudyOf(GetParam());
  Random random(3);
  for (Joint& joint : study.mechanism.joints) {
    Vector6d k;
    for (int i = 0; i < 6; ++i) k[i] = random.Between(0.5, 2) * (i < 3 ? 1e7 : 1e4);
    joint.stiffness = k;
  }
  const LoadStudyResult result = RunLoadStudy(study);
  for (const PoseLoads& pose : result.poses) {
    EXPECT_LE(DifferenceFrom(WrenchesOfElasticJoints(study, pose, result.norm_length),
                             study.mechanism, pose),
              kRule);
  }
}

TEST_P(RulesOf, MinimumNormIsThatOfAllSolutions) {
  LoadStudy study = StudyOf(GetParam());
  study.rule = ReactionRule::kMinimumNorm;
  study.norm_length = 0.37;
  const LoadStudyResult result = RunLoadStudy(study);
  EXPECT_EQ(result.norm_length, study.norm_length);
  for (const PoseLoads& pose : result.poses) {
    EXPECT_LE(
        DifferenceFrom(WrenchesOfLeastNorm(study, pose, study.norm_length), study.mechanism, pose),
        kRule);
  }
}

INSTANTIATE_TEST_SUITE_P(Overconstrained, RulesOf,
                         testing::Values("four-bar", "slider-crank", "door-on-two-hinges",
                                         "bennett", "bricard", "square-four-bar",
                                         "n-window-four-bar", "spherical-four-bar"),
                         [](const auto& info) { return TestName(info.param); });

TEST(BeamOnThreeSupports, StiffnessIsThatOfElasticJoints) {
  LoadStudy study;
  study.mechanism = Example("beam-on-three-supports");
  const double length = CharacteristicLength(study.mechanism);
  const PoseLoads pose = LoadsOfStructure(study);
  EXPECT_LE(DifferenceFrom(WrenchesOfElasticJoints(study, pose, length), study.mechanism, pose),
            kRule);
}

TEST(BeamOnThreeSupports, MinimumNormIsThatOfAllSolutions) {
  LoadStudy study;
  study.mechanism = Example("beam-on-three-supports");
  study.rule = ReactionRule::kMinimumNorm;
  const double length = CharacteristicLength(study.mechanism);
  const PoseLoads pose = LoadsOfStructure(study);
  EXPECT_LE(DifferenceFrom(WrenchesOfLeastNorm(study, pose, length), study.mechanism, pose), kRule);
}

// Of three equal springs each carries a third. A roller of weight w lowers its own track by w / k
// first, so that the middle one gives less; twice that comes back on the outer two.
TEST(BeamOnThreeSupports, EqualSupportsCarryAThirdOfTheBeamEachButForTheRollers) {
  LoadStudy study;
  study.mechanism = Example("beam-on-three-supports");
  const PoseLoads pose = LoadsOfStructure(study);
  constexpr double kThird = 20 * 9.81, kRoller = 0.5 * 9.81;  // [N]
  constexpr double kRounding = 1e-9;                          // [N]
  auto carried = [&](const char* joint) {
    return pose.joints[FindJoint(study.mechanism, joint)].force.y();
  };
  EXPECT_NEAR(carried("left"), kThird + kRoller / 12, kRounding);
  EXPECT_NEAR(carried("middle"), kThird - kRoller / 6, kRounding);
  EXPECT_NEAR(carried("right"), kThird + kRoller / 12, kRounding);
}

}  // namespace
}  // namespace vmech
