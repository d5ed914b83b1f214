#include "vmech/solvers/null_motions.h"

#include <gtest/gtest.h>

#include <cmath>

#include "vmech/solvers/augmented_lagrangian.h"
#include "vmech/solvers/backend.h"

namespace vmech::null_motions_test {
namespace {

constexpr double kRounding = 1e-12;

NullMotions::Held NoneOf(int n) {
  return NullMotions::Held::Constant(n, false);
}

/// J and C of five unknowns that see three combinations of them only.
Linearization ThreeOfFive() {
  Linearization at_x({.coordinates = 5, .tangents = 5, .residuals = 2, .constraints = 2});
  at_x.J << 1, 2, 0, -1, 0.5, 0.3, -1, 0, 2, 1;
  at_x.C.row(0) << 0.7, 0.1, 0, 1, -2;
  at_x.C.row(1) = at_x.C.row(0) - 3 * at_x.J.row(0);
  return at_x;
}

TEST(NullMotions, AreTheOrthonormalNullSpaceOfResidualsAndConstraints) {
  const Linearization at_x = ThreeOfFive();
  NullMotions null(5);
  null.Find(at_x, NoneOf(5));
  ASSERT_EQ(null.count(), 2);
  for (int k = 0; k < 2; ++k) {
    EXPECT_LT((at_x.J * null.motion(k)).norm() + (at_x.C * null.motion(k)).norm(), kRounding);
    EXPECT_NEAR(null.motion(k).norm(), 1, kRounding);
  }
  EXPECT_NEAR(null.motion(0).dot(null.motion(1)), 0, kRounding);
}

TEST(NullMotions, LeaveHeldUnknownsWhereTheyAre) {
  NullMotions null(5);
  NullMotions::Held held = NoneOf(5);
  held[2] = held[4] = true;
  null.Find(ThreeOfFive(), held);
  EXPECT_EQ(null.count(), 0);
  held[4] = false;
  null.Find(ThreeOfFive(), held);
  ASSERT_EQ(null.count(), 1);
  EXPECT_EQ(null.motion(0)[2], 0);
}

TEST(NullMotions, AreNoneWhereAMotionIsSeenALittle) {
  Linearization at_x = ThreeOfFive();
  at_x.C.row(1) << 0, 0, 1e-4, 0, 0;
  NullMotions null(5);
  null.Find(at_x, NoneOf(5));
  ASSERT_EQ(null.count(), 1);
  EXPECT_LT((at_x.C * null.motion(0)).norm(), 1e-10);
}

TEST(NullMotions, StiffenAMatrixAlongThemAndTakeOutItsCoupling) {
  NullMotions null(5);
  null.Find(ThreeOfFive(), NoneOf(5));
  MatrixXd S(5, 5);
  for (int i = 0; i < 25; ++i) S(i / 5, i % 5) = std::sin(1.0 + i / 5 + i % 5);
  MatrixXd N(5, 2);
  N << null.motion(0), null.motion(1);
  const MatrixXd P = MatrixXd::Identity(5, 5) - N * N.transpose();
  const MatrixXd expected = P * S * P + 7 * N * N.transpose();
  null.Stiffen(7, &S);
  EXPECT_LT((S - expected).norm(), kRounding);
}

TEST(NullMotions, AreLessThoseThatOnlyADeadCentreHidesAndThatCurve) {
  Linearization at_x = ThreeOfFive();
  NullMotions null(5);
  at_x.C.row(1) << 0, 0, 1, 1, 0;
  null.Find(at_x, NoneOf(5));
  ASSERT_EQ(null.count(), 1);
  const VectorXd spin = null.motion(0);
  // At a dead centre the last row is hidden, and a force makes the motion that it told stiff.
  const VectorXd row = at_x.C.row(1);
  at_x.C.row(1).setZero();
  null.Find(at_x, NoneOf(5));
  ASSERT_EQ(null.count(), 2);
  MatrixXd S = 0.3 * row * row.transpose();
  null.Stiffen(7, &S);
  ASSERT_EQ(null.count(), 1);
  EXPECT_NEAR(std::abs(null.motion(0).dot(spin)), 1, kRounding);
  EXPECT_LT((S - 0.3 * row * row.transpose() - 7 * spin * spin.transpose()).norm(), 1e-11);
}

/// The point of a plane arm of three links of unit length, one more than a target needs: its links
/// turn in a way that the point does not see.
class SurplusArm final : public ConstrainedLeastSquares {
 public:
  SurplusArm()
      : ConstrainedLeastSquares(
            {.coordinates = 3, .tangents = 3, .residuals = 1, .constraints = 1}) {}
  // x to be met, y to be kept.
  void Evaluate(const VectorXd& q, VectorXd* r, MatrixXd* J, VectorXd* c, MatrixXd* C) override {
    if (r) *r << -1.9;
    if (c) *c << -0.8;
    if (J) J->setZero();
    if (C) C->setZero();
    double angle = 0;
    for (int i = 0; i < 3; ++i) {
      angle += q[i];
      if (r) (*r)[0] += std::cos(angle);
      if (c) (*c)[0] += std::sin(angle);
      if (J) J->leftCols(i + 1).array() -= std::sin(angle);
      if (C) C->leftCols(i + 1).array() += std::cos(angle);
    }
  }
  bool has_second_derivatives() const override { return true; }
  void Curvature(const VectorXd& q, const VectorXd& mu, MatrixXd* S) override {
    VectorXd r(1);
    Evaluate(q, &r, nullptr, nullptr, nullptr);
    S->setZero();
    double angle = 0;
    for (int i = 0; i < 3; ++i) {
      angle += q[i];
      S->topLeftCorner(i + 1, i + 1).array() -= r[0] * std::cos(angle) + mu[0] * std::sin(angle);
    }
  }
};

TEST(NullMotions, AreNoWayThatASolverWandersOn) {
  SurplusArm problem;
  const VectorXd start = Eigen::Vector3d(0.9, -0.6, -0.7);
  for (Backend backend : {Backend::kPenalty, Backend::kAugmentedLagrangian, Backend::kNullspace,
                          Backend::kCeresWeighted, Backend::kCeresExact, Backend::kIpopt,
                          Backend::kNloptSlsqp, Backend::kKinsol}) {
    SCOPED_TRACE(NameOf(backend));
    const Summary summary = Solve(backend, problem, {1e-10, 1e-7, 100}, start);
    if (summary.status == SolveStatus::kUnavailable) continue;
    EXPECT_LT(summary.objective, 1e-14) << summary.BriefReport();
    EXPECT_LT(summary.constraint_norm, 1e-9) << summary.BriefReport();
    EXPECT_LE(summary.iterations, 40);
    EXPECT_LT((summary.x - start).norm(), 0.75);  // the nearest solution is 0.68 away
  }
}

TEST(NullMotions, StandStillInEveryStepOfTheFastPath) {
  SurplusArm problem;
  AugmentedLagrangianWorkspace workspace(problem);
  VectorXd q = Eigen::Vector3d(0.9, -0.6, -0.7);
  NullMotions null(3);
  Linearization at_q(problem.sizes());
  for (int i = 0; i < 6; ++i) {
    at_q.Evaluate(problem, q);
    null.Find(at_q, NoneOf(3));
    ASSERT_EQ(null.count(), 1);
    ASSERT_TRUE(Step(problem, {}, &q, &workspace).ok);
    EXPECT_LT(std::abs(null.motion(0).dot(workspace.step.dx)), 1e-9);
  }
}

}  // namespace
}  // namespace vmech::null_motions_test
