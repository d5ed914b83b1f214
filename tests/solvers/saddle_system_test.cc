#include "vmech/base/linear_algebra/saddle_system.h"

#include <gtest/gtest.h>

#include <Eigen/QR>

namespace vmech::saddle_system_test {
namespace {

// What three solves at a weight of 1e5 leave along the weakest direction of a random C.
constexpr double kRounding = 1e-8;

/// A random system whose A lacks one direction that C fixes; the last equation repeats the first.
struct System {
  System(int unknowns, int equations) : saddle(unknowns, (equations + 3) / 4 * 4) {
    std::srand(static_cast<unsigned>(7 + unknowns));
    const MatrixXd root = MatrixXd::Random(unknowns, unknowns - 1);
    A = root * root.transpose();
    C = MatrixXd::Zero((equations + 3) / 4 * 4, unknowns);
    C.topRows(equations).setRandom();
    C.row(equations - 1) = 2 * C.row(0);
    b = VectorXd::Random(unknowns);
    d = VectorXd::Zero(C.rows());
    d.head(equations) = C.topRows(equations) * VectorXd::Random(unknowns);
    saddle.SetWeight(1e5 * A.trace() / C.squaredNorm());
  }

  SaddleSystem saddle;
  MatrixXd A, C;
  VectorXd b, d;
};

class EverySize : public testing::TestWithParam<int> {
 protected:
  EverySize() : s_(GetParam(), GetParam() / 2 + 1), x_(VectorXd::Zero(GetParam())) {}

  System s_;
  VectorXd x_;
};

TEST_P(EverySize, SolutionFulfilsBothEquationsWithRedundantRows) {
  s_.saddle.SetConstraints(s_.C);
  ASSERT_TRUE(s_.saddle.Factor(s_.A));
  s_.saddle.Solve(s_.A, s_.C, s_.b, s_.d, &x_);
  VectorXd mu(s_.C.rows());
  s_.saddle.ComputeMultipliers(s_.C, s_.d, &mu);
  EXPECT_LT((s_.A * x_ + s_.C.transpose() * mu - s_.b).norm(), kRounding * s_.b.norm());
  EXPECT_LT((s_.C * x_ - s_.d).norm(), kRounding * s_.d.norm());
}

TEST_P(EverySize, MultipliersAreTheSmallest) {
  s_.saddle.SetConstraints(s_.C);
  ASSERT_TRUE(s_.saddle.Factor(s_.A));
  s_.saddle.Solve(s_.A, s_.C, s_.b, s_.d, &x_);
  VectorXd mu(s_.C.rows());
  s_.saddle.ComputeMultipliers(s_.C, s_.d, &mu);
  const VectorXd smallest =
      s_.C.transpose().completeOrthogonalDecomposition().solve(s_.b - s_.A * x_);
  EXPECT_LT((mu - smallest).norm(), kRounding * smallest.norm());
}

TEST_P(EverySize, ApproachMakesUpForWhatTheConstraintsAsk) {
  s_.saddle.SetConstraints(s_.C);
  ASSERT_TRUE(s_.saddle.Factor(s_.A));
  s_.saddle.SolveOnce(s_.C, VectorXd::Zero(GetParam()), s_.d, &x_);
  constexpr double kOneSolve = 1e-3;  // A over w C'C where C moves least
  EXPECT_LT((s_.C * x_ - s_.d).norm(), kOneSolve * s_.d.norm());
}

INSTANTIATE_TEST_SUITE_P(Unknowns, EverySize, testing::Values(2, 3, 4, 5, 8, 9, 21));

TEST(SaddleSystem, WithoutEquationsIsThatOfA) {
  SaddleSystem saddle(2, 0);
  const MatrixXd A = (MatrixXd(2, 2) << 4, 1, 1, 3).finished(), none(0, 2);
  const VectorXd b = Eigen::Vector2d(1, 2);
  VectorXd x(2);
  ASSERT_TRUE(saddle.Factor(A));
  saddle.Solve(A, none, b, VectorXd(0), &x);
  EXPECT_LT((A * x - b).norm(), kRounding);
}

TEST(SaddleSystem, AFreedomThatNothingHoldsIsRefused) {
  SaddleSystem saddle(2, 4);
  MatrixXd A = MatrixXd::Zero(2, 2), C = MatrixXd::Zero(4, 2);
  A(0, 0) = C(0, 0) = 1;
  saddle.SetConstraints(C);
  EXPECT_FALSE(saddle.Factor(A));
}

}  // namespace
}  // namespace vmech::saddle_system_test
