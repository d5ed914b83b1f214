#include "vmech/solvers/programs/minimise.h"

#include <gtest/gtest.h>

#include <functional>
#include <stdexcept>
#include <string>

#include "support/needs.h"
#include "vmech/base/late_library.h"

namespace vmech::minimise_test {
namespace {

/// Problem 43 of Hock and Schittkowski, "Test Examples for Nonlinear Programming Codes" (1981), by
/// Rosen and Suzuki: f = -44 at (0, 1, 2, -1), multipliers (1, 0, 2).
class RosenSuzuki final : public NonlinearProgram {
 public:
  RosenSuzuki() : NonlinearProgram(VectorXd::Constant(4, -5), VectorXd::Constant(4, 5), 3) {}

  bool Evaluate(const VectorXd& x, double* f, VectorXd* df, VectorXd* g, MatrixXd* dg) override {
    if (undefined && undefined(x)) return false;
    const VectorXd s = x.cwiseAbs2();
    *f = s[0] + s[1] + 2 * s[2] + s[3] - 5 * x[0] - 5 * x[1] - 21 * x[2] + 7 * x[3];
    *df << 2 * x[0] - 5, 2 * x[1] - 5, 4 * x[2] - 21, 2 * x[3] + 7;
    *g << s.sum() + x[0] - x[1] + x[2] - x[3] - 8,
        s[0] + 2 * s[1] + s[2] + 2 * s[3] - x[0] - x[3] - 10,
        2 * s[0] + s[1] + s[2] + 2 * x[0] - x[1] - x[3] - 5;
    *dg << 2 * x[0] + 1, 2 * x[1] - 1, 2 * x[2] + 1, 2 * x[3] - 1,  //
        2 * x[0] - 1, 4 * x[1], 2 * x[2], 4 * x[3] - 1,             //
        4 * x[0] + 2, 2 * x[1] - 1, 2 * x[2], -1;
    return true;
  }

  std::function<bool(const VectorXd& x)> undefined;
};

class EveryMethod : public testing::TestWithParam<ProgramMethod> {
 protected:
  void SetUp() override {
    const LateLibrary package(GetParam() == ProgramMethod::kIpopt ? "ipopt" : "nlopt");
    VMECH_NEEDS(package.loaded(), package.error());
  }
  ProgramResult Solve() {
    ProgramOptions options;
    options.method = GetParam();
    options.tolerance = 1e-10;
    return Minimise(program_, options, VectorXd::Zero(4));
  }
  RosenSuzuki program_;
};

TEST_P(EveryMethod, ReachesThePublishedOptimumAndItsMultipliers) {
  const ProgramResult result = Solve();
  ASSERT_TRUE(result.feasible) << result.message;
  EXPECT_NEAR(result.f, -44, 2e-6) << result.message << ", " << result.evaluations;
  EXPECT_LT((result.x - Eigen::Vector4d(0, 1, 2, -1)).norm(), 1e-3);
  EXPECT_LT((result.lambda - Eigen::Vector3d(1, 0, 2)).norm(), 1e-2);
  EXPECT_LT(result.optimality, 1e-3);
}

TEST_P(EveryMethod, IsDrawnBackFromWhereTheProgramIsNotDefined) {
  program_.undefined = [](const VectorXd& x) { return x.norm() > 2.6; };  // the optimum: 2.45
  const ProgramResult result = Solve();
  ASSERT_TRUE(result.feasible) << result.message;
  EXPECT_NEAR(result.f, -44, 1e-3);
}

TEST_P(EveryMethod, SaysThatItIsDefinedNowhere) {
  program_.undefined = [](const VectorXd& /*x*/) { return true; };
  const ProgramResult result = Solve();
  EXPECT_FALSE(result.defined);
  EXPECT_FALSE(result.feasible);
}

std::string NameOfMethod(const testing::TestParamInfo<ProgramMethod>& info) {
  constexpr const char* kNames[] = {"Slsqp", "Mma", "Ipopt"};
  return kNames[static_cast<int>(info.param)];
}

INSTANTIATE_TEST_SUITE_P(Programs, EveryMethod,
                         testing::Values(ProgramMethod::kSlsqp, ProgramMethod::kMma,
                                         ProgramMethod::kIpopt),
                         NameOfMethod);

TEST(Minimise, RefusesAStartOutsideOfTheBounds) {
  RosenSuzuki program;
  EXPECT_THROW(Minimise(program, {}, VectorXd::Constant(4, 9)), std::invalid_argument);
  EXPECT_THROW(Minimise(program, {}, VectorXd::Zero(3)), std::invalid_argument);
}

}  // namespace
}  // namespace vmech::minimise_test
