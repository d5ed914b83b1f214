#include "vmech/base/linear_algebra/complete_orthogonal.h"

#include <gtest/gtest.h>

namespace vmech::complete_orthogonal_test {
namespace {

constexpr double kRankTolerance = 1e-9;
constexpr double kRounding = 1e-13;

// Rank 2: the third row is the sum of the first two.
Eigen::MatrixXd RankTwo() {
  Eigen::MatrixXd C(3, 4);
  C << 1, 2, 0, -1, 0, 1, 3, 1, 1, 3, 3, 0;
  return C;
}

TEST(CompleteOrthogonal, RebuildsTheMatrix) {
  CompleteOrthogonal factors(RankTwo(), kRankTolerance);
  EXPECT_EQ(factors.rank(), 2);
  EXPECT_LT((factors.V() * factors.L() * factors.Y().transpose() - RankTwo()).norm(), kRounding);
  EXPECT_LT((RankTwo() * factors.Z()).norm(), kRounding);
}

TEST(CompleteOrthogonal, GivesTheShortestLeastSquaresSolutions) {
  CompleteOrthogonal factors(RankTwo(), kRankTolerance);
  const Eigen::Vector3d b(1, -2, 5);
  const Eigen::VectorXd x = factors.Solve(b);
  EXPECT_LT((RankTwo().transpose() * (RankTwo() * x - b)).norm(), 1e-12);
  EXPECT_LT((factors.Z().transpose() * x).norm(), kRounding);

  const Eigen::VectorXd g = RankTwo().transpose() * b;
  const Eigen::VectorXd mu = factors.SolveTransposed(g);
  EXPECT_LT((RankTwo().transpose() * mu - g).norm(), 1e-12);
  EXPECT_NEAR(mu.dot(Eigen::Vector3d(1, 1, -1)), 0, kRounding);  // spans the null space of C'
}

TEST(CompleteOrthogonal, TakesAMatrixWithoutRows) {
  CompleteOrthogonal factors(Eigen::MatrixXd(0, 3), kRankTolerance);
  EXPECT_EQ(factors.rank(), 0);
  EXPECT_EQ(factors.Z().cols(), 3);
  EXPECT_EQ(factors.Solve(Eigen::VectorXd(0)), Eigen::VectorXd::Zero(3));
}

// Blocked products of this size take their workspace from the heap, which Eigen must find aligned.
TEST(CompleteOrthogonal, TakesMatricesLargerThanTheStackHolds) {
  const int n = 300;
  const Eigen::MatrixXd C =
      Eigen::MatrixXd::NullaryExpr(n, n, [](int i, int j) { return std::sin(i * i + 3.0 * j); });
  CompleteOrthogonal factors(C, kRankTolerance);
  EXPECT_LT((factors.V() * factors.L() * factors.Y().transpose() - C).norm(), 1e-11 * n);
}

}  // namespace
}  // namespace vmech::complete_orthogonal_test
