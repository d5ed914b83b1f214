// The mechanism as a problem: derivatives against central differences, signs and units.

#include "vmech/kinematics/inverse/inverse_kinematics.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "support/examples.h"
#include "vmech/kinematics/loops/loops.h"
#include "vmech/kinematics/tree/forward_kinematics.h"

namespace vmech {
namespace {

constexpr double kStep = 1e-5;
constexpr double kDifference = 5e-8;  // of a central difference with this step, motions of order 1

Posed RandomPose(Random* random) {
  const Vector3d axis = random->Vector(3).normalized();
  const Eigen::AngleAxisd turn(random->Between(0.5, 2.5), axis);
  return {turn.toRotationMatrix(), random->Vector(3)};
}

/// A loop of joints of many types that is closed by a cut joint of the given type.
Mechanism LoopClosedBy(JointType type, Random* random) {
  Mechanism mechanism;
  mechanism.name = "loop";
  for (const char* name : {"ground", "a", "b", "c"}) {
    Link link;
    link.name = name;
    for (int i = 0; i < 2; ++i)
      link.anchors.push_back({"A" + std::to_string(i), RandomPose(random)});
    mechanism.links.push_back(link);
  }
  // 'second' is traversed against its direction, so that reversed joints are met too.
  mechanism.joints = {MakeJoint("first", JointType::kSpherical, {0, 0}, {1, 0}),
                      MakeJoint("second", JointType::kScrew, {2, 0}, {1, 1}),
                      MakeJoint("third", JointType::kSpherical, {3, 0}, {0, 1}),
                      MakeJoint("closing", type, {2, 1}, {3, 1})};
  mechanism.joints[1].pitch = 0.2;
  mechanism.joints[3].pitch = 0.3;
  mechanism.preferred_cuts = {3};
  return mechanism;
}

/// J and C of a problem along a direction, and S along it, against central differences.
void ExpectDerivatives(InverseKinematics& problem, const VectorXd& q, Random* random) {
  const ProblemSizes& n = problem.sizes();
  VectorXd r(n.residuals), c(n.constraints), moved(n.coordinates);
  MatrixXd J(n.residuals, n.tangents), C(n.constraints, n.tangents), S(n.tangents, n.tangents);
  const VectorXd u = random->Vector(n.tangents), mu = random->Vector(n.constraints);
  problem.Evaluate(q, &r, &J, &c, &C);
  problem.Curvature(q, mu, &S);
  struct Sample {
    VectorXd r, c;
    double slope;
  };
  auto at = [&](double t) -> Sample {
    Sample sample{r, c, 0};
    MatrixXd J_t = J, C_t = C;
    problem.Plus(q, t * u, &moved);
    problem.Evaluate(moved, &sample.r, &J_t, &sample.c, &C_t);
    sample.slope = (J_t.transpose() * r + C_t.transpose() * mu).dot(u);
    return sample;
  };
  const Sample ahead = at(kStep), behind = at(-kStep);
  const VectorXd dr = (ahead.r - behind.r) / (2 * kStep), dc = (ahead.c - behind.c) / (2 * kStep);
  EXPECT_LT((J * u - dr).norm(), kDifference * (1 + dr.norm()));
  EXPECT_LT((C * u - dc).norm(), kDifference * (1 + dc.norm()));
  const double curvature = (ahead.slope - behind.slope) / (2 * kStep);
  EXPECT_NEAR(u.dot(S * u), curvature, kDifference * (1 + std::abs(curvature)));
  EXPECT_LT((S - S.transpose()).norm(), 1e-12 * (1 + S.norm()));
}

TEST(InverseKinematics, DerivativesAreThoseOfTheErrorsForEveryCutJointWhereTheLoopIsOpen) {
  Random random(3);
  for (JointType type :
       {JointType::kRevolute, JointType::kPrismatic, JointType::kCylindrical, JointType::kScrew,
        JointType::kUniversal, JointType::kSpherical, JointType::kPlanar, JointType::kWeld}) {
    SCOPED_TRACE(NameOf(type));
    const KinematicTree tree = BuildKinematicTree(LoopClosedBy(type, &random));
    ASSERT_EQ(tree.loops.at(0).type, type);
    const GraspFrame grasp{tree.NodeOfLink(2), RandomPose(&random)};
    InverseKinematics problem(tree, grasp);
    for (int i = 0; i < 10; ++i) {
      VectorXd q = StartCoordinates(tree);
      MoveCoordinates(tree, random.Vector(tree.nv, 1.5), &q);
      problem.SetTarget(RandomPose(&random));
      ExpectDerivatives(problem, q, &random);
    }
  }
}

class EveryProblem : public testing::TestWithParam<std::string> {};

TEST_P(EveryProblem, DerivativesAreThoseOfTheErrors) {
  const KinematicTree tree = BuildKinematicTree(Example(GetParam()));
  Random random(5);
  for (GraspKind kind : {GraspKind::kRigid, GraspKind::kPoint}) {
    for (RotationError error : {RotationError::kLogarithm, RotationError::kPaper}) {
      InverseKinematicsOptions options;
      options.rotation_error = error;
      options.stiffness << 1, 2, 3, 0.4, 0.5, 0.7;  // unequal: no shortcut holds
      const int last = static_cast<int>(tree.nodes.size()) - 1;
      InverseKinematics problem(tree, {last, RandomPose(&random), kind}, options);
      problem.SetTarget(RandomPose(&random));
      ExpectDerivatives(problem, RandomCoordinates(tree, &random), &random);
    }
  }
}

TEST_P(EveryProblem, ConstraintsAreTheLoopErrorsAndTheirJacobianIsThatOfTheLoops) {
  const KinematicTree tree = BuildKinematicTree(Example(GetParam()));
  InverseKinematics problem(tree, {static_cast<int>(tree.nodes.size()) - 1, {}});
  VectorXd q = StartCoordinates(tree);
  ASSERT_TRUE(Assemble(tree, {}, &q).closed);
  MatrixXd C(tree.rows, tree.nv);
  problem.Evaluate(q, nullptr, nullptr, nullptr, &C);
  TreeWorkspace<double> ws(tree);
  ForwardKinematics(tree, q.data(), &ws);
  LoopErrors(tree, &ws);
  LoopJacobian(tree, &ws);
  const MatrixXd W = LoopRowScale(tree).asDiagonal();
  EXPECT_LT((C + W * DenseLoopJacobian(tree, ws)).norm(), 1e-12 * (1 + C.norm()));
}

INSTANTIATE_TEST_SUITE_P(Examples, EveryProblem, testing::ValuesIn(ExampleNames()),
                         [](const auto& info) { return TestName(info.param); });

TEST(InverseKinematics, GraspErrorLeadsFromTheMechanismToTheHand) {
  const KinematicTree tree = BuildKinematicTree(Example("crank"));
  InverseKinematics problem(tree, GraspFrameOf(tree, 0));
  const VectorXd q = StartCoordinates(tree);
  const Posed X_WG = problem.GraspPose(q);
  const Vector3d turn(0.1, -0.2, 0.3), shift(0.4, 0.5, -0.6);
  const Matrix3d R = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
  problem.SetTarget({R * X_WG.R, X_WG.p + shift});
  const Vector6d e1 = problem.HandError(q);
  EXPECT_LT((e1.head<3>() - shift).norm(), 1e-14);
  EXPECT_LT((e1.tail<3>() - turn).norm(), 1e-14);
}

TEST(InverseKinematics, ObjectiveIsTheEnergyOfTheHandsSpring) {
  const KinematicTree tree = BuildKinematicTree(Example("two-link-arm"));
  InverseKinematicsOptions options;
  options.stiffness << 800, 900, 1000, 3, 4, 5;
  GraspFrame grasp = GraspFrameOf(tree, 0);
  grasp.kind = GraspKind::kRigid;
  InverseKinematics problem(tree, grasp, options);
  Random random(2);
  problem.SetTarget(RandomPose(&random));
  const VectorXd q = RandomCoordinates(tree, &random);
  VectorXd r(6);
  problem.Evaluate(q, &r, nullptr, nullptr, nullptr);
  const double energy = 0.5 * problem.HandError(q).dot(problem.HandWrench(q));
  EXPECT_NEAR(problem.energy() * 0.5 * r.squaredNorm(), energy, 1e-12 * energy);
}

TEST(InverseKinematics, JointLimitsBecomeBoundsUnlessTheyAreSwitchedOff) {
  Mechanism mechanism = Example("two-link-arm");
  mechanism.joints[1].lower[0] = -0.5;
  const KinematicTree tree = BuildKinematicTree(mechanism);
  const InverseKinematics problem(tree, GraspFrameOf(tree, 0));
  ASSERT_EQ(problem.bounds().size(), 1U);
  EXPECT_EQ(problem.bounds()[0].coordinate, CoordinateIndex(tree, 1, 0));
  EXPECT_EQ(problem.bounds()[0].lower, -0.5);
  InverseKinematicsOptions options;
  options.joint_limits = false;
  EXPECT_TRUE(InverseKinematics(tree, GraspFrameOf(tree, 0), options).bounds().empty());
}

TEST(InverseKinematics, RefusesStiffnessesThatMeanNothing) {
  const KinematicTree tree = BuildKinematicTree(Example("crank"));
  GraspFrame grasp = GraspFrameOf(tree, 0);
  InverseKinematicsOptions options;
  options.stiffness[2] = -1;
  EXPECT_THROW(InverseKinematics(tree, grasp, options), std::invalid_argument);
  options.stiffness << 0, 0, 0, 1, 1, 1;
  grasp.kind = GraspKind::kPoint;
  EXPECT_THROW(InverseKinematics(tree, grasp, options), std::invalid_argument);
}

}  // namespace
}  // namespace vmech
