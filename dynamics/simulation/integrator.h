#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "vmech/dynamics/simulation/simulation.h"

namespace vmech {

/// An initial value problem, y' = f(t, y), or F(t, y, y') = 0.
struct InitialValueProblem {
  int size = 0;  ///< numbers in y
  /// Writes f, or F of y and y' (which is null for f). False if there is none.
  std::function<bool(double t, const double* y, const double* slopes, double* out)> evaluate;
  double relative_tolerance = 1e-9;         ///< of each y, on a step
  std::vector<double> absolute_tolerances;  ///< [size]
  double max_step = 0;                      ///< longest step [s]; 0: no bound
  // Of F.
  std::vector<bool> differential;  ///< [size] the others have no slopes, and count in no error test
  double first_step = 0;           ///< of a restart that does not say [s]
};

/// What an integrator has done since it began.
struct IntegratorCounts {
  long steps = 0, evaluations = 0, error_test_failures = 0;              ///< since it began
  long nonlinear_iterations = 0, nonlinear_failures = 0, jacobians = 0;  ///< of BDF and IDAS
};

/// One step after another through a problem, as large as its tolerances allow.
class Integrator {
 public:
  virtual ~Integrator() = default;

  /// Goes on from (t, y), with slopes y' of F, and first by `step` [s], if it is not 0. The counts
  /// go on.
  virtual void Restart(double t, const double* y, const double* slopes, double step) = 0;
  /// One step, not beyond `end`. False if it fails; error() says why.
  virtual bool Step(double end) = 0;
  virtual double time() const = 0;      ///< at the end of the last step
  virtual const double* y() const = 0;  ///< there
  /// y [size] at a time within the last step.
  virtual void At(double t, double* y) = 0;
  virtual IntegratorCounts counts() const = 0;  ///< zero before the first step
  virtual std::string error() const = 0;        ///< a sentence; empty while all goes well
};

/// By SUNDIALS: CVODES for kAdams and kBdf, IDAS for kIdas. The problem must outlive it.
/// @throws std::runtime_error if SUNDIALS is not there, naming the package to install.
std::unique_ptr<Integrator> MakeIntegrator(const InitialValueProblem& problem,
                                           SimulationMethod method);

/// What libvmech_cvodes.so and libvmech_idas.so hold as their variable vmech_make_integrator.
using IntegratorMaker = std::unique_ptr<Integrator> (*)(const InitialValueProblem& problem,
                                                        SimulationMethod method);

}  // namespace vmech
