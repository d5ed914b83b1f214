#include "vmech/solvers/backends/kinsol.h"

#include <kinsol/kinsol.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <Eigen/QR>
#include <algorithm>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "vmech/solvers/backends/package.h"
#include "vmech/solvers/null_motions.h"
#include "vmech/solvers/packages/tangent_chart.h"

namespace vmech {
namespace {

Eigen::Map<VectorXd> Map(N_Vector v) {
  return {N_VGetArrayPointer(v), N_VGetLength_Serial(v)};
}

// The square system F(u) = 0 in one chart, u = (free y; mu), or u = free y for c = 0 alone.
class SquareSystem {
 public:
  SquareSystem(TangentChart& chart, std::vector<int> held) : chart_(chart) {
    const bool driven = !held.empty();
    for (const int i : UnseenVariables(held)) held.push_back(i);
    for (int i = 0; i < chart.num_variables(); ++i) {
      if (std::find(held.begin(), held.end(), i) == held.end()) free_.push_back(i);
    }
    closure_only_ = driven && static_cast<int>(free_.size()) == chart.num_constraints();
  }

  int size() const {
    const int free = static_cast<int>(free_.size());
    return closure_only_ ? free : free + chart_.num_constraints();
  }

  VectorXd Variables(const VectorXd& u) const {
    VectorXd y = VectorXd::Zero(chart_.num_variables());
    y(free_) = u.head(static_cast<int>(free_.size()));
    return y;
  }

  // F = [J'r + C'mu; c], free rows of the first
  VectorXd Residual(const VectorXd& u) {
    const Linearization& at_y = chart_.At(Variables(u));
    if (closure_only_) return at_y.c;
    const VectorXd slope = chart_.Gradient() + at_y.C.transpose() * u.tail(at_y.c.size());
    VectorXd F(size());
    F << slope(free_), at_y.c;
    return F;
  }

  // dF/du = [H C'; C 0]
  MatrixXd Jacobian(const VectorXd& u) {
    const Linearization& at_y = chart_.At(Variables(u));
    const MatrixXd C = at_y.C(Eigen::all, free_);
    if (closure_only_) return C;
    const Eigen::Index n = C.cols(), m = C.rows();
    MatrixXd K = MatrixXd::Zero(n + m, n + m);
    K.topLeftCorner(n, n) = chart_.Hessian(1, u.tail(m))(free_, free_);
    K.topRightCorner(n, m) = C.transpose();
    K.bottomLeftCorner(m, n) = C;
    // Flat directions leave K singular; this much curvature does not change where F = 0.
    constexpr double kLeastCurvature = 1e-10;
    K.diagonal().head(n).array() += kLeastCurvature;
    return K;
  }

 private:
  // Of each null motion at the base the variable that it moves most: where that is held the others
  // reach the same minima, and K is regular.
  std::vector<int> UnseenVariables(const std::vector<int>& held) {
    const int n = chart_.num_variables();
    NullMotions::Held fixed = NullMotions::Held::Constant(n, false);
    for (const int i : held) fixed[i] = true;
    NullMotions null(n);
    null.Find(chart_.At(VectorXd::Zero(n)), fixed);
    MatrixXd motions(null.count(), n);
    for (int k = 0; k < null.count(); ++k) motions.row(k) = null.motion(k);
    if (null.count() == 0) return {};
    const auto order = Eigen::ColPivHouseholderQR<MatrixXd>(motions).colsPermutation().indices();
    return {order.begin(), order.begin() + null.count()};
  }

  TangentChart& chart_;
  std::vector<int> free_;
  bool closure_only_ = false;
};

int EvaluateResidual(N_Vector u, N_Vector F, void* data) {
  Map(F) = static_cast<SquareSystem*>(data)->Residual(Map(u));
  return Map(F).allFinite() ? 0 : 1;
}

int EvaluateJacobian(N_Vector u, N_Vector, SUNMatrix K, void* data, N_Vector, N_Vector) {
  const MatrixXd jacobian = static_cast<SquareSystem*>(data)->Jacobian(Map(u));
  Eigen::Map<MatrixXd>(SUNDenseMatrix_Data(K), jacobian.rows(), jacobian.cols()) = jacobian;
  return jacobian.allFinite() ? 0 : 1;
}

void IgnoreMessage(int, const char*, const char*, char*, void*) {}

// KINSOL's objects for a system of one size, with a context of their own.
class Kinsol {
 public:
  Kinsol(SquareSystem* system, double tolerance, int max_iterations) {
    Require(SUNContext_Create(nullptr, &context_) == 0);
    u_ = N_VNew_Serial(system->size(), context_);
    ones_ = N_VNew_Serial(system->size(), context_);
    K_ = SUNDenseMatrix(system->size(), system->size(), context_);
    linear_ = SUNLinSol_Dense(u_, K_, context_);
    memory_ = KINCreate(context_);
    Require(u_ && ones_ && K_ && linear_ && memory_);
    Map(u_).setZero();
    Map(ones_).setOnes();
    KINSetErrHandlerFn(memory_, IgnoreMessage, nullptr);
    KINSetInfoHandlerFn(
        memory_, [](const char*, const char*, char*, void*) {}, nullptr);
    KINSetUserData(memory_, system);
    Require(KINInit(memory_, EvaluateResidual, u_) == 0);
    KINSetFuncNormTol(memory_, tolerance);
    KINSetScaledStepTol(memory_, 1e-15);
    KINSetNumMaxIters(memory_, max_iterations);
    KINSetMaxSetupCalls(memory_, 1);  // a new Jacobian in every iteration
    Require(KINSetLinearSolver(memory_, linear_, K_) == 0);
    Require(KINSetJacFn(memory_, EvaluateJacobian) == 0);
  }
  ~Kinsol() {
    if (memory_) KINFree(&memory_);
    if (linear_) SUNLinSolFree(linear_);
    if (K_) SUNMatDestroy(K_);
    if (ones_) N_VDestroy(ones_);
    if (u_) N_VDestroy(u_);
    if (context_) SUNContext_Free(&context_);
  }
  Kinsol(const Kinsol&) = delete;
  Kinsol& operator=(const Kinsol&) = delete;

  int Solve() { return KINSol(memory_, u_, KIN_LINESEARCH, ones_, ones_); }
  VectorXd solution() const { return Map(u_); }
  int iterations() const {
    long count = 0;
    KINGetNumNonlinSolvIters(memory_, &count);
    return static_cast<int>(count);
  }

 private:
  static void Require(bool ok) {
    if (!ok) throw std::runtime_error("SUNDIALS could not set up its objects");
  }

  SUNContext context_ = nullptr;
  N_Vector u_ = nullptr, ones_ = nullptr;
  SUNMatrix K_ = nullptr;
  SUNLinearSolver linear_ = nullptr;
  void* memory_ = nullptr;
};

Outcome OutcomeOf(int flag) {
  if (flag >= 0) return {SolveStatus::kConverged, "KINSOL: solved"};
  char* name = KINGetReturnFlagName(flag);
  const std::string message = std::string("KINSOL: ") + name;
  std::free(name);
  const bool spent = flag == KIN_MAXITER_REACHED;
  return {spent ? SolveStatus::kIterationLimit : SolveStatus::kStalled, message};
}

Outcome SolveByKinsol(CountedProblem& problem, const KinsolOptions& options, VectorXd* x) {
  const auto in_chart = [&](TangentChart& chart, int max_iterations, VectorXd* y) {
    SquareSystem system(chart, options.held);
    Kinsol kinsol(&system, options.tolerance, max_iterations);
    Outcome outcome = OutcomeOf(kinsol.Solve());
    *y = system.Variables(kinsol.solution());
    outcome.iterations = kinsol.iterations();
    return outcome;
  };
  return SolveInCharts(problem, options.stopping, x, in_chart);
}

}  // namespace
}  // namespace vmech

extern "C" {
vmech::PackageFunction<vmech::KinsolOptions> vmech_solve = vmech::SolveByKinsol;
}
