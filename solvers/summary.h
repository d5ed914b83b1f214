#pragma once

#include <limits>
#include <string>
#include <string_view>

#include "vmech/base/eigen.h"

namespace vmech {

/// How a solve ended, judged at the returned point.
enum class SolveStatus {
  kNotRun,          ///< nothing has been solved yet
  kConverged,       ///< a constrained minimum: feasible, and the KKT error is within tolerance
  kBiased,          ///< the minimum of a penalty function: feasible within Summary::bias_bound only
  kInfeasible,      ///< |c| is at a minimum that is not zero: the constraints cannot be met nearby
  kIterationLimit,  ///< given up after StoppingRule::max_iterations
  kStalled,         ///< no further progress, short of the tolerances
  kFailed,          ///< the back end broke down (values not finite, or its own error)
  kUnsuitable,      ///< this back end cannot pose this problem; the message says why
  kUnavailable,     ///< the package was absent when vmech was built
};

/// The status in words.
std::string_view NameOf(SolveStatus status);

/// What came out of a solve. Residuals, KKT error and verdict are ours, not the back end's.
/// Multipliers obey  J' r + C' multipliers + z = 0,  where z holds the bound multipliers at their
/// tangents: z >= 0 at an upper bound, z <= 0 at a lower one. Of redundant rows the multipliers of
/// least norm are given.
struct Summary {
  std::string solver;                         ///< as on the command line
  SolveStatus status = SolveStatus::kNotRun;  ///< how the solve ended, as judged here
  std::string message = "not run";            ///< why, a sentence
  Eigen::VectorXd x;                          ///< the best point found, always finite
  Eigen::VectorXd multipliers;                ///< one per row of c
  Eigen::VectorXd bound_multipliers;          ///< one per bound of the problem
  double objective = kUnknown;                ///< 1/2 |r|^2
  double constraint_norm = kUnknown;          ///< max |c_i|
  double bound_violation = kUnknown;          ///< max of lower - x, x - upper and 0
  double kkt_error = kUnknown;                ///< max |J'r + C'mu + z| / max(1, max |J'r|)
  double bias_bound = 0;                      ///< penalty only: |c|_2 is at most this
  int iterations = 0;                         ///< of the solver's own count
  int evaluations = 0;                        ///< of r or c
  int jacobian_evaluations = 0;               ///< of J or C
  double seconds = 0;                         ///< wall time of the solve, our judgement left out

  /// True if x is a solution within the stopping rule.
  bool converged() const { return status == SolveStatus::kConverged; }
  std::string BriefReport() const;  ///< one line
  std::string FullReport() const;   ///< one page

  /// The value of figures that a solve has not come to: NaN.
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace vmech
