#include <idas/idas.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <cstdlib>

#include "vmech/dynamics/simulation/integrator.h"
#include "vmech/dynamics/simulation/packages/vectors.h"

namespace vmech {
namespace {

int Residual(double t, N_Vector y, N_Vector slopes, N_Vector F, void* data) {
  const auto& problem = *static_cast<const InitialValueProblem*>(data);
  return problem.evaluate(t, N_VGetArrayPointer(y), N_VGetArrayPointer(slopes),
                          N_VGetArrayPointer(F))
             ? 0
             : 1;
}

void IgnoreMessage(int, const char*, const char*, char*, void*) {}

class Idas : public Integrator {
 public:
  explicit Idas(const InitialValueProblem& problem) : problem_(problem), vectors_(problem.size) {
    y_ = vectors_.New();
    slopes_ = vectors_.New();
    wanted_ = vectors_.New();
    tolerances_ = vectors_.New();
    differential_ = vectors_.New();
    vectors_.Copy(problem.absolute_tolerances.data(), tolerances_);
    for (int i = 0; i < problem.size; ++i) {
      N_VGetArrayPointer(differential_)[i] = problem.differential[static_cast<size_t>(i)];
    }
    memory_ = IDACreate(vectors_.context());
    RequireSundials(memory_ != nullptr);
    IDASetErrHandlerFn(memory_, IgnoreMessage, nullptr);
  }
  ~Idas() override {
    if (memory_) IDAFree(&memory_);
    if (linear_) SUNLinSolFree(linear_);
    if (matrix_) SUNMatDestroy(matrix_);
  }

  void Restart(double t, const double* y, const double* slopes, double step) override {
    vectors_.Copy(y, y_);
    vectors_.Copy(slopes, slopes_);
    time_ = t;
    if (started_) {
      before_ = counts();
      RequireSundials(IDAReInit(memory_, t, y_, slopes_) == 0);
    } else {
      started_ = true;
      RequireSundials(IDAInit(memory_, Residual, t, y_, slopes_) == 0);
      SetUp();
    }
    IDASetInitStep(memory_, step > 0 ? step : problem_.first_step);
  }

  bool Step(double end) override {
    IDASetStopTime(memory_, end);
    flag_ = IDASolve(memory_, end, &time_, y_, slopes_, IDA_ONE_STEP);
    return flag_ >= 0;
  }

  double time() const override { return time_; }
  const double* y() const override { return N_VGetArrayPointer(y_); }
  void At(double t, double* y) override {
    RequireSundials(IDAGetDky(memory_, t, 0, wanted_) == 0);
    const double* at = N_VGetArrayPointer(wanted_);
    std::copy(at, at + problem_.size, y);
  }

  IntegratorCounts counts() const override {
    IntegratorCounts now = before_;
    long steps = 0, residuals = 0, failures = 0, iterations = 0, not_converged = 0, jacobians = 0,
         for_jacobians = 0;
    IDAGetNumSteps(memory_, &steps);
    IDAGetNumResEvals(memory_, &residuals);
    IDAGetNumErrTestFails(memory_, &failures);
    IDAGetNumNonlinSolvIters(memory_, &iterations);
    IDAGetNumNonlinSolvConvFails(memory_, &not_converged);
    IDAGetNumJacEvals(memory_, &jacobians);
    IDAGetNumLinResEvals(memory_, &for_jacobians);
    now.steps += steps;
    now.evaluations += residuals + for_jacobians;
    now.error_test_failures += failures;
    now.nonlinear_iterations += iterations;
    now.nonlinear_failures += not_converged;
    now.jacobians += jacobians;
    return now;
  }

  std::string error() const override {
    char* name = IDAGetReturnFlagName(flag_);
    const std::string text = std::string("IDAS: ") + name;
    std::free(name);
    return text;
  }

 private:
  void SetUp() {
    IDASetUserData(memory_, const_cast<InitialValueProblem*>(&problem_));
    RequireSundials(IDASVtolerances(memory_, problem_.relative_tolerance, tolerances_) == 0);
    IDASetMaxNumSteps(memory_, -1);
    if (problem_.max_step > 0) IDASetMaxStep(memory_, problem_.max_step);
    // Multipliers have no slopes to be predicted by.
    RequireSundials(IDASetId(memory_, differential_) == 0 && IDASetSuppressAlg(memory_, 1) == 0);
    matrix_ = SUNDenseMatrix(problem_.size, problem_.size, vectors_.context());
    linear_ = SUNLinSol_Dense(y_, matrix_, vectors_.context());
    RequireSundials(linear_ && IDASetLinearSolver(memory_, linear_, matrix_) == 0);
  }

  const InitialValueProblem& problem_;
  bool started_ = false;
  SundialsVectors vectors_;
  N_Vector y_ = nullptr, slopes_ = nullptr, wanted_ = nullptr, tolerances_ = nullptr,
           differential_ = nullptr;
  void* memory_ = nullptr;
  SUNMatrix matrix_ = nullptr;
  SUNLinearSolver linear_ = nullptr;
  double time_ = 0;
  int flag_ = 0;
  IntegratorCounts before_;  ///< the last restart
};

std::unique_ptr<Integrator> MakeIdas(const InitialValueProblem& problem, SimulationMethod) {
  return std::make_unique<Idas>(problem);
}

}  // namespace
}  // namespace vmech

extern "C" {
vmech::IntegratorMaker vmech_make_integrator = vmech::MakeIdas;
}
