#pragma once

#include "vmech/solvers/summary.h"

namespace vmech {

/// What one step did; see PenaltyOptions and AugmentedLagrangianOptions.
struct StepReport {
  bool ok = false;             ///< false: the values were not finite, x is unchanged
  double constraint_norm = 0;  ///< |c|_2 before the step
  double step_norm = 0;        ///< max |dx_i|
  double bias_bound = 0;  ///< |multiplier estimate| / lambda^2: the |c|_2 that the penalty leaves
};

/// What the allocation-free solve did. Its claim is unjudged.
struct FastOutcome {
  SolveStatus claim = SolveStatus::kNotRun;  ///< of the method itself
  int iterations = 0;                        ///< steps
  double constraint_norm = 0;                ///< max |c_i|
  double bias_bound = 0;                     ///< |c|_2 is at most this
};

}  // namespace vmech
