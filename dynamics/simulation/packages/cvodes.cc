#include <cvodes/cvodes.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <algorithm>
#include <cstdlib>

#include "vmech/dynamics/simulation/integrator.h"
#include "vmech/dynamics/simulation/packages/vectors.h"

namespace vmech {
namespace {

int Rates(double t, N_Vector y, N_Vector rates, void* data) {
  const auto& problem = *static_cast<const InitialValueProblem*>(data);
  const double* at = N_VGetArrayPointer(y);
  return problem.evaluate(t, at, nullptr, N_VGetArrayPointer(rates)) ? 0 : 1;
}

void IgnoreMessage(int, const char*, const char*, char*, void*) {}

class Cvodes : public Integrator {
 public:
  Cvodes(const InitialValueProblem& problem, SimulationMethod method)
      : problem_(problem), bdf_(method == SimulationMethod::kBdf), vectors_(problem.size) {
    y_ = vectors_.New();
    wanted_ = vectors_.New();
    tolerances_ = vectors_.New();
    vectors_.Copy(problem.absolute_tolerances.data(), tolerances_);
    memory_ = CVodeCreate(bdf_ ? CV_BDF : CV_ADAMS, vectors_.context());
    RequireSundials(memory_ != nullptr);
    CVodeSetErrHandlerFn(memory_, IgnoreMessage, nullptr);
  }
  ~Cvodes() override {
    if (memory_) CVodeFree(&memory_);
    if (nonlinear_) SUNNonlinSolFree(nonlinear_);
    if (linear_) SUNLinSolFree(linear_);
    if (matrix_) SUNMatDestroy(matrix_);
  }

  void Restart(double t, const double* y, const double*, double step) override {
    vectors_.Copy(y, y_);
    time_ = t;
    if (started_) {
      before_ = counts();
      RequireSundials(CVodeReInit(memory_, t, y_) == 0);
    } else {
      started_ = true;
      RequireSundials(CVodeInit(memory_, Rates, t, y_) == 0);
      SetUp();
    }
    CVodeSetInitStep(memory_, step);
  }

  bool Step(double end) override {
    CVodeSetStopTime(memory_, end);
    flag_ = CVode(memory_, end, y_, &time_, CV_ONE_STEP);
    return flag_ >= 0;
  }

  double time() const override { return time_; }
  const double* y() const override { return N_VGetArrayPointer(y_); }
  void At(double t, double* y) override {
    if (t == time_) {
      std::copy(this->y(), this->y() + problem_.size, y);
      return;
    }
    RequireSundials(CVodeGetDky(memory_, t, 0, wanted_) == 0);
    const double* at = N_VGetArrayPointer(wanted_);
    std::copy(at, at + problem_.size, y);
  }

  IntegratorCounts counts() const override {
    IntegratorCounts now = before_;
    long steps = 0, rates = 0, failures = 0, iterations = 0, not_converged = 0, jacobians = 0,
         for_jacobians = 0;
    CVodeGetNumSteps(memory_, &steps);
    CVodeGetNumRhsEvals(memory_, &rates);
    CVodeGetNumErrTestFails(memory_, &failures);
    CVodeGetNumNonlinSolvIters(memory_, &iterations);
    CVodeGetNumNonlinSolvConvFails(memory_, &not_converged);
    if (bdf_) CVodeGetNumJacEvals(memory_, &jacobians);
    if (bdf_) CVodeGetNumLinRhsEvals(memory_, &for_jacobians);
    now.steps += steps;
    now.evaluations += rates + for_jacobians;
    now.error_test_failures += failures;
    now.nonlinear_iterations += iterations;
    now.nonlinear_failures += not_converged;
    now.jacobians += jacobians;
    return now;
  }

  std::string error() const override {
    char* name = CVodeGetReturnFlagName(flag_);
    const std::string text = std::string("CVODES: ") + name;
    std::free(name);
    return text;
  }

 private:
  void SetUp() {
    CVodeSetUserData(memory_, const_cast<InitialValueProblem*>(&problem_));
    RequireSundials(CVodeSVtolerances(memory_, problem_.relative_tolerance, tolerances_) == 0);
    CVodeSetMaxNumSteps(memory_, -1);
    CVodeSetMaxHnilWarns(memory_, -1);
    if (problem_.max_step > 0) CVodeSetMaxStep(memory_, problem_.max_step);
    if (!bdf_) {
      nonlinear_ = SUNNonlinSol_FixedPoint(y_, 0, vectors_.context());
      RequireSundials(nonlinear_ && CVodeSetNonlinearSolver(memory_, nonlinear_) == 0);
      return;
    }
    matrix_ = SUNDenseMatrix(problem_.size, problem_.size, vectors_.context());
    linear_ = SUNLinSol_Dense(y_, matrix_, vectors_.context());
    RequireSundials(linear_ && CVodeSetLinearSolver(memory_, linear_, matrix_) == 0);
  }

  const InitialValueProblem& problem_;
  bool bdf_, started_ = false;
  SundialsVectors vectors_;
  N_Vector y_ = nullptr, wanted_ = nullptr, tolerances_ = nullptr;
  void* memory_ = nullptr;
  SUNNonlinearSolver nonlinear_ = nullptr;
  SUNMatrix matrix_ = nullptr;
  SUNLinearSolver linear_ = nullptr;
  double time_ = 0;
  int flag_ = 0;
  IntegratorCounts before_;  ///< the last restart
};

std::unique_ptr<Integrator> MakeCvodes(const InitialValueProblem& problem,
                                       SimulationMethod method) {
  return std::make_unique<Cvodes>(problem, method);
}

}  // namespace
}  // namespace vmech

extern "C" {
vmech::IntegratorMaker vmech_make_integrator = vmech::MakeCvodes;
}
