#include "vmech/base/linear_algebra/envelope_ldlt.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>

namespace vmech {
namespace {

constexpr double kRoundoff = 1e-12;

/// A positive definite matrix of the given bandwidth and the solver filled with it.
Eigen::MatrixXd Banded(int n, int band, EnvelopeLdlt<double>* ldlt) {
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
  std::vector<int> first;
  for (int i = 0; i < n; ++i) first.push_back(std::max(0, i - band));
  *ldlt = EnvelopeLdlt<double>(first);
  for (int i = 0; i < n; ++i) {
    for (int j = first[i]; j <= i; ++j) {
      A(i, j) = A(j, i) = i == j ? 2.0 * band + 1 : 1.0 / (1 + i + 2 * j);
      ldlt->Add(j, i, A(i, j));
    }
  }
  return A;
}

TEST(EnvelopeLdlt, SolvesABandedMatrixAsTheDenseMethodDoes) {
  EnvelopeLdlt<double> ldlt;
  const Eigen::MatrixXd A = Banded(30, 4, &ldlt);
  Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(30, -1, 2);
  const Eigen::VectorXd expected = A.llt().solve(x);
  ldlt.Factor();
  ldlt.Solve(x.data());
  EXPECT_LT((x - expected).norm(), kRoundoff * expected.norm());
  EXPECT_GT(ldlt.smallest_pivot(), 0);
}

TEST(EnvelopeLdlt, SolvesASaddlePoint) {
  // minimise x^2 + 2 y^2 subject to x + y = 3: x = 2, y = 1, multiplier 4 x = ... 2x = 4.
  EnvelopeLdlt<double> ldlt(std::vector<int>{0, 0, 0});
  ldlt(0, 0) = 2;
  ldlt(1, 1) = 4;
  ldlt(2, 0) = 1;
  ldlt(2, 1) = 1;
  ldlt.Factor();
  double x[3] = {0, 0, 3};
  ldlt.Solve(x);
  EXPECT_NEAR(x[0], 2, kRoundoff);
  EXPECT_NEAR(x[1], 1, kRoundoff);
  EXPECT_NEAR(x[2], -4, kRoundoff);
}

TEST(EnvelopeLdlt, HoldsAnUndeterminedUnknownAtZero) {
  // Columns (1, 2) and (2, 4): rank one.
  EnvelopeLdlt<double> ldlt(std::vector<int>{0, 0});
  ldlt(0, 0) = 5;
  ldlt(1, 0) = 10;
  ldlt(1, 1) = 20;
  ldlt.Factor();
  EXPECT_EQ(ldlt.smallest_pivot(), 0);
  double x[2] = {5, 10};
  ldlt.Solve(x);
  EXPECT_NEAR(x[0], 1, kRoundoff);
  EXPECT_EQ(x[1], 0);
}

}  // namespace
}  // namespace vmech
