// The sanitizers bring an allocator of theirs.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

#include <gtest/gtest.h>

#include "support/count_allocations.h"
#include "vmech/solvers/augmented_lagrangian.h"
#include "vmech/solvers/nullspace.h"
#include "vmech/solvers/penalty.h"

namespace vmech::allocation_test {
namespace {

/// n points in a row with unit distances, the first pulled to a target, the last tied to the
/// origin, x in [-20, 20]: written without allocation.
class Chain final : public ConstrainedLeastSquares {
 public:
  explicit Chain(int points) : ConstrainedLeastSquares(SizesOf(points), BoundsOf(points)) {}

  void Evaluate(const VectorXd& x, VectorXd* r, MatrixXd* J, VectorXd* c, MatrixXd* C) override {
    const int n = sizes().constraints;
    if (r) (*r) = x;
    if (r) (*r)[0] -= target;
    if (J) J->setIdentity();
    if (C) C->setZero();
    for (int i = 0; i < n; ++i) {
      const bool last = i + 1 == n;
      const double dx = x[2 * i] - (last ? 0 : x[2 * i + 2]);
      const double dy = x[2 * i + 1] - (last ? 0 : x[2 * i + 3]);
      if (c) (*c)[i] = 0.5 * (dx * dx + dy * dy - 1);
      if (!C) continue;
      (*C)(i, 2 * i) = dx, (*C)(i, 2 * i + 1) = dy;
      if (!last) (*C)(i, 2 * i + 2) = -dx, (*C)(i, 2 * i + 3) = -dy;
    }
  }
  bool has_second_derivatives() const override { return true; }
  void Curvature(const VectorXd&, const VectorXd& mu, MatrixXd* S) override {
    S->setZero();
    for (int i = 0; i < mu.size(); ++i) {
      for (int k = 2 * i; k < 2 * i + 2; ++k) {
        (*S)(k, k) += mu[i];
        if (i + 1 == mu.size()) continue;
        (*S)(k + 2, k + 2) += mu[i];
        (*S)(k, k + 2) -= mu[i], (*S)(k + 2, k) -= mu[i];
      }
    }
  }

  VectorXd Start() const {
    VectorXd x(sizes().coordinates);
    for (int i = 0; i < x.size(); ++i) x[i] = i % 2 == 0 ? sizes().constraints - 0.5 * i : 0.1 * i;
    return x;
  }

  double target = 1;

 private:
  static ProblemSizes SizesOf(int points) { return {2 * points, 2 * points, 2 * points, points}; }
  static std::vector<Bound> BoundsOf(int points) {
    std::vector<Bound> bounds;
    for (int i = 0; i < 2 * points; ++i) bounds.push_back({i, i, -20, i == 0 ? 0.5 : 20});
    return bounds;
  }
};

// Three sizes: kernels made for few unknowns, and those for any number.
class FastSolvers : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Points, FastSolvers, ::testing::Values(1, 3, 12));

template <typename Options, typename Workspace>
void ExpectNoAllocation(int points) {
  Chain problem(points);
  const Options options;
  Workspace workspace(problem);
  VectorXd x = problem.Start();
  const long before = allocations;
  for (int tick = 0; tick < 20; ++tick) {
    problem.target = 1 + 0.01 * tick;
    ASSERT_TRUE(Step(problem, options, &x, &workspace).ok);
  }
  problem.target = 0.3;
  const FastOutcome outcome = Solve(problem, options, &x, &workspace);
  EXPECT_EQ(allocations - before, 0);
  EXPECT_GT(outcome.iterations, 0);
  EXPECT_LT(outcome.constraint_norm, 1e-4);  // it has done something: the penalty's bias at most
}

TEST_P(FastSolvers, AllocateNothingInThePenalty) {
  ExpectNoAllocation<PenaltyOptions, PenaltyWorkspace>(GetParam());
}

TEST_P(FastSolvers, AllocateNothingInTheAugmentedLagrangian) {
  ExpectNoAllocation<AugmentedLagrangianOptions, AugmentedLagrangianWorkspace>(GetParam());
}

// What it takes for the working set of bounds depends on the way, so it has to have gone it. Some
// of these ways end short of the minimum, after many iterations.
TEST_P(FastSolvers, AllocateNothingInTheWarmNullspace) {
  Chain problem(GetParam());
  NullspaceOptions options;
  NullspaceWorkspace workspace(problem);
  const auto solve = [&](bool second_derivatives, double target) {
    options.use_second_derivatives = second_derivatives;
    problem.target = target;
    VectorXd x = problem.Start();
    x[0] = 0.5;
    const long before = allocations;
    const FastOutcome outcome = Solve(problem, options, &x, &workspace);
    const long taken = allocations - before;
    EXPECT_NE(outcome.claim, SolveStatus::kFailed);
    EXPECT_GT(outcome.iterations, 0);
    return taken;
  };
  EXPECT_GT(solve(false, 1) + solve(true, 0.3), 0);
  EXPECT_EQ(solve(false, 1) + solve(true, 0.3), 0);
}

}  // namespace
}  // namespace vmech::allocation_test
#endif
