// Mechanisms under a hand, solved by every back end: one answer, a true constrained minimum.

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>

#include "support/examples.h"
#include "vmech/base/linear_algebra/linear_algebra.h"
#include "vmech/kinematics/inverse/inverse_kinematics.h"
#include "vmech/kinematics/loops/loops.h"
#include "vmech/kinematics/tree/forward_kinematics.h"
#include "vmech/solvers/augmented_lagrangian.h"
#include "vmech/solvers/backend.h"
#include "vmech/solvers/nullspace.h"
#include "vmech/solvers/penalty.h"

namespace vmech {
namespace {

constexpr StoppingRule kTight{1e-12, 1e-11, 2000};
constexpr double kRank = 1e-8;

/// A mechanism whose grasp is pulled off its path, so that loops carry loads.
class Pulled : public testing::TestWithParam<std::string> {
 protected:
  Pulled()
      : tree_(BuildKinematicTree(Example(GetParam()))),
        q_(StartCoordinates(tree_)),
        problem_(tree_, GraspFrameOf(tree_, 0)) {
    EXPECT_TRUE(Assemble(tree_, {}, &q_).closed);
    const Posed X_WG = problem_.GraspPose(q_);
    const Matrix3d turn = Eigen::AngleAxisd(0.15, Vector3d(1, -2, 2) / 3).toRotationMatrix();
    problem_.SetTarget({turn * X_WG.R, X_WG.p + 0.06 * tree_.length * Vector3d(1, 0.5, -0.7)});
    exact_ = Solve(problem_, NullspaceOptions{.stopping = kTight}, q_);
  }

  Linearization At(const VectorXd& q) {
    Linearization at(problem_.sizes());
    at.Evaluate(problem_, q);
    return at;
  }

  KinematicTree tree_;
  VectorXd q_;
  InverseKinematics problem_;
  Summary exact_;
};

TEST_P(Pulled, EndsAtATrueConstrainedMinimum) {
  EXPECT_TRUE(exact_.converged()) << exact_.BriefReport();
  EXPECT_LE(exact_.kkt_error, 1e-8);
  EXPECT_LE(exact_.constraint_norm, 1e-10);
  // On the free motions N the Hessian of the Lagrangian has no negative eigenvalue.
  const Linearization at = At(exact_.x);
  MatrixXd S(tree_.nv, tree_.nv);
  problem_.Curvature(exact_.x, exact_.multipliers, &S);
  const MatrixXd N = FindNullSpace(at.C, kRank).basis;
  if (N.cols() == 0) return;
  const MatrixXd reduced = N.transpose() * (at.J.transpose() * at.J + S) * N;
  const double least = Eigen::SelfAdjointEigenSolver<MatrixXd>(reduced).eigenvalues()[0];
  EXPECT_GE(least, -1e-9 * (1 + reduced.norm()));
}

// Design of the constraint wrench: K e1 does no work on any motion that the mechanism allows, with
// the plain geometric Jacobian, since the rotational weights are equal.
TEST_P(Pulled, HandWrenchDoesNoWorkOnFreeMotions) {
  TreeWorkspace<double> ws(tree_);
  ForwardKinematics(tree_, exact_.x.data(), &ws);
  Matrix6Xd J(6, tree_.nv);
  GraspJacobian(tree_, ws, problem_.grasp().node, problem_.grasp().X_BG, &J);
  const VectorXd force = J.transpose() * problem_.HandWrench(exact_.x);
  const MatrixXd N = FindNullSpace(At(exact_.x).C, kRank).basis;
  const double error = problem_.HandError(exact_.x).norm();
  if (error < 1e-9) return;  // six freedoms: the hand is in reach and does not pull
  const double size = (J.transpose() * problem_.stiffness().asDiagonal() * J).norm() * error;
  EXPECT_LE((N.transpose() * force).norm(), 1e-9 * size);
}

// The spring's pull is balanced by the wrenches at the cut joints: J_grasp' K e1 + C' mu = 0.
TEST_P(Pulled, MultipliersInNewtonsBalanceTheHandWrench) {
  TreeWorkspace<double> ws(tree_);
  ForwardKinematics(tree_, exact_.x.data(), &ws);
  Matrix6Xd J(6, tree_.nv);
  GraspJacobian(tree_, ws, problem_.grasp().node, problem_.grasp().X_BG, &J);
  const VectorXd force = J.transpose() * problem_.HandWrench(exact_.x);
  LoopErrors(tree_, &ws);
  LoopJacobian(tree_, &ws);
  const VectorXd mu = problem_.LoopMultipliers(exact_.multipliers);
  const VectorXd balance = force + DenseLoopJacobian(tree_, ws).transpose() * mu;
  EXPECT_LE(balance.norm(), 1e-8 * (force.norm() + problem_.energy()));
}

TEST_P(Pulled, EveryExactBackEndFindsTheSamePoseAndTheSameLoads) {
  const Linearization at = At(exact_.x);
  MatrixXd stacked(at.J.rows() + at.C.rows(), tree_.nv);
  stacked << at.J, at.C;
  const bool determined = FindNullSpace(stacked, kRank).rank == tree_.nv;
  for (Backend backend : {Backend::kAugmentedLagrangian, Backend::kNullspace, Backend::kCeresExact,
                          Backend::kIpopt, Backend::kNloptSlsqp, Backend::kKinsol}) {
    SCOPED_TRACE(NameOf(backend));
    // SLSQP stops where the objective no longer changes: half the digits in q.
    const bool coarse = backend == Backend::kNloptSlsqp;
    const Summary summary = Solve(backend, problem_, {1e-10, coarse ? 1e-6 : 1e-10, 2000}, q_);
    if (summary.status == SolveStatus::kUnavailable) continue;
    EXPECT_TRUE(summary.converged()) << summary.BriefReport();
    const double tolerance = coarse ? 1e-5 : 1e-8;
    const Posed a = problem_.GraspPose(summary.x), b = problem_.GraspPose(exact_.x);
    EXPECT_LT((a.p - b.p).norm() / tree_.length + (a.R - b.R).norm(), tolerance);
    EXPECT_LT((summary.x - exact_.x).norm(), determined ? tolerance : 10);
    // Of redundant rows only the common part of multipliers is determined.
    EXPECT_LT((at.C.transpose() * (summary.multipliers - exact_.multipliers)).norm(), tolerance);
  }
}

TEST_P(Pulled, EveryOtherBackEndComesNearToIt) {
  if (tree_.nv > 3) return;  // COBYLA, without derivatives, takes its time
  for (Backend backend : kAllBackends) {
    SCOPED_TRACE(NameOf(backend));
    const Summary summary = Solve(backend, problem_, {1e-7, 1e-6, 20000}, q_);
    if (summary.status == SolveStatus::kUnavailable) continue;
    EXPECT_LE(summary.constraint_norm, 1e-4) << summary.BriefReport();
    EXPECT_NEAR(summary.objective, exact_.objective, 1e-2 * (1e-3 + exact_.objective))
        << summary.BriefReport();
  }
}

TEST_P(Pulled, PenaltyLeavesLoopsOpenByItsBoundWhichFallsWithLambdaSquared) {
  if (exact_.multipliers.norm() < 1e-9) return;  // nothing pulls at the loops
  double last = 0;
  for (double lambda : {30.0, 300.0}) {
    PenaltyOptions options;
    options.weight = lambda;
    const Summary summary = Solve(problem_, options, q_);
    const double open = At(summary.x).c.norm();
    EXPECT_EQ(summary.status, SolveStatus::kBiased) << summary.BriefReport();
    EXPECT_LE(open, summary.bias_bound * (1 + 1e-6)) << "lambda " << lambda;
    EXPECT_NEAR(last > 0 ? last / open : 100, 100, 3);  // the next order is 1 / lambda^4
    last = open;
  }
}

TEST_P(Pulled, MultiplierUpdateClosesLoopsWithinATenthOfANanometre) {
  const Summary summary = Solve(problem_, AugmentedLagrangianOptions{}, q_);
  EXPECT_TRUE(summary.converged()) << summary.BriefReport();
  EXPECT_LE(problem_.LoopError(summary.x).lpNorm<Eigen::Infinity>(), 1e-10);
}

// Planar linkages modelled in space, Bennett's, Bricard's: loops with redundant equations.
INSTANTIATE_TEST_SUITE_P(Redundant, Pulled,
                         testing::Values("four-bar", "slider-crank", "square-four-bar",
                                         "spherical-four-bar", "bennett", "bricard",
                                         "n-window-four-bar", "door-on-two-hinges",
                                         "marghitu-slider-crank", "modelica-four-bar"),
                         [](const auto& info) { return TestName(info.param); });
INSTANTIATE_TEST_SUITE_P(Regular, Pulled,
                         testing::Values("crank", "rssr", "rsup", "stewart-gough", "delta-robot",
                                         "dietmaier-platform", "manseur-doty", "stewart-gough-sps",
                                         "redundant-arm"),
                         [](const auto& info) { return TestName(info.param); });

TEST(InverseKinematics, StopsAtAJointLimitWithAMultiplierThatPushesBack) {
  Mechanism mechanism = Example("two-link-arm");
  mechanism.joints[1].lower[0] = 0.6;
  const KinematicTree tree = BuildKinematicTree(mechanism);
  InverseKinematics problem(tree, GraspFrameOf(tree, 0));
  Posed X_WH;
  X_WH.p << 2, 0, 0;  // out of reach: the arm would stretch
  problem.SetTarget(X_WH);
  for (Backend backend : {Backend::kNullspace, Backend::kAugmentedLagrangian, Backend::kIpopt}) {
    const Summary summary = Solve(backend, problem, {}, StartCoordinates(tree));
    if (summary.status == SolveStatus::kUnavailable) continue;
    EXPECT_TRUE(summary.converged()) << summary.BriefReport();
    EXPECT_NEAR(summary.x[1], 0.6, 1e-7);
    EXPECT_LT(summary.bound_multipliers[0], -0.1);
  }
}

// At the dead centre of a rocker the hand does not see the crank for a moment, but its pull holds
// it; the spin of the rod it never sees.
TEST(InverseKinematics, EndsAtTheDeadCentreOfARockerWhoseRodSpins) {
  const KinematicTree tree = BuildKinematicTree(Example("rssr"));
  VectorXd q = StartCoordinates(tree);
  ASSERT_TRUE(Assemble(tree, {}, &q).closed);
  InverseKinematics problem(tree, GraspFrameOf(tree, 1));
  const Posed start = problem.GraspPose(q);
  const Posed X_WP = tree.placements[FindJoint(tree.mechanism, "output")].X_AF;
  const int crank = CoordinateIndex(tree, FindJoint(tree.mechanism, "input"), 0);
  for (const double angle : {-0.2, -0.7}) {
    const Matrix3d turn = Eigen::AngleAxisd(angle, Vector3d::UnitZ()).toRotationMatrix();
    const Matrix3d R = X_WP.R * turn * X_WP.R.transpose();
    problem.SetTarget(Posed{R, X_WP.p - R * X_WP.p} * start);
    const Summary exact = Solve(problem, NullspaceOptions{.stopping = kTight}, q);
    ASSERT_TRUE(exact.converged()) << exact.BriefReport();
    EXPECT_GT(exact.objective, 1e-5);  // beyond the dead centre
    for (Backend backend : {Backend::kNullspace, Backend::kAugmentedLagrangian,
                            Backend::kCeresExact, Backend::kIpopt, Backend::kKinsol}) {
      const Summary summary = Solve(backend, problem, {1e-10, 1e-9, 200}, q);
      if (summary.status == SolveStatus::kUnavailable) continue;
      EXPECT_TRUE(summary.converged()) << angle << " " << summary.BriefReport();
      EXPECT_NEAR(summary.x[crank], exact.x[crank], 1e-6) << summary.solver;
    }
  }
}

TEST(InverseKinematics, UnequalRotationalWeightsNeedTheExactDerivative) {
  const KinematicTree tree = BuildKinematicTree(Example("bennett"));
  VectorXd q = StartCoordinates(tree);
  ASSERT_TRUE(Assemble(tree, {}, &q).closed);
  InverseKinematicsOptions options;
  options.stiffness << 1, 1, 1, 0.2, 1, 3;
  InverseKinematics problem(tree, GraspFrameOf(tree, 0), options);
  const Posed X_WG = problem.GraspPose(q);
  const Matrix3d turn = Eigen::AngleAxisd(1.2, Vector3d(2, 1, -2) / 3).toRotationMatrix();
  problem.SetTarget({turn * X_WG.R, X_WG.p});
  const Summary summary = Solve(problem, NullspaceOptions{.stopping = kTight}, q);
  ASSERT_TRUE(summary.converged()) << summary.BriefReport();
  // Along the free motion the energy is stationary, whatever the weights.
  Linearization at(problem.sizes());
  at.Evaluate(problem, summary.x);
  const VectorXd n = FindNullSpace(at.C, kRank).basis.col(0);
  constexpr double kStep = 1e-4;
  auto energy = [&](double t) {
    VectorXd moved(tree.nq);
    problem.Plus(summary.x, t * n, &moved);
    AssemblyOptions nearest;
    EXPECT_TRUE(Assemble(tree, nearest, &moved).closed);
    return problem.HandError(moved).dot(problem.HandWrench(moved));
  };
  const double here = energy(0);
  EXPECT_GT(energy(kStep), here);
  EXPECT_GT(energy(-kStep), here);
}

// Drawn askew, the rows of the second hinge are rounding instead of zeros: no equation either.
TEST(Door, TurnsOnItsTwoHingesHoweverTheyLie) {
  for (const double angle : {0.0, 0.4, 1.1, 1.9, 2.6}) {
    Mechanism door = Example("door-on-two-hinges");
    const Posed askew(Eigen::AngleAxisd(angle, Vector3d(2, -1, 2) / 3).toRotationMatrix(),
                      Vector3d(0.3, -angle, 0.7));
    for (Link& link : door.links) {
      for (Anchor& anchor : link.anchors) anchor.X_LA = askew * anchor.X_LA;
    }
    door.grasps[0].X_LG = askew * door.grasps[0].X_LG;
    const KinematicTree tree = BuildKinematicTree(door);
    InverseKinematics problem(tree, GraspFrameOf(tree, 0));
    const VectorXd start = StartCoordinates(tree), open = start.array() + 0.5;
    problem.SetTarget(problem.GraspPose(open));
    for (const Backend backend : {Backend::kNullspace, Backend::kAugmentedLagrangian}) {
      const Summary summary = Solve(backend, problem, kTight, start);
      EXPECT_TRUE(summary.converged()) << summary.BriefReport();
      EXPECT_NEAR(summary.x[0], open[0], 1e-9) << angle << ' ' << NameOf(backend);
    }
  }
}

}  // namespace
}  // namespace vmech
