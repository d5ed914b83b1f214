#include "vmech/solvers/backends/kinsol.h"

#include <algorithm>

#include "vmech/base/check_range.h"
#include "vmech/solvers/backends/package.h"
#include "vmech/solvers/held_coordinates.h"

namespace vmech {
namespace {

bool BoundsHold(const ConstrainedLeastSquares& problem, const VectorXd& x) {
  constexpr double kSlack = 1e-9;
  return std::all_of(problem.bounds().begin(), problem.bounds().end(), [&](const Bound& bound) {
    const double value = x[bound.coordinate];
    return value >= bound.lower - kSlack && value <= bound.upper + kSlack;
  });
}

}  // namespace

void KinsolOptions::Validate() const {
  CheckRange("KinsolOptions", "tolerance", tolerance, 1e-16, 1e-3);
  stopping.Validate();
}

Summary Solve(ConstrainedLeastSquares& problem, const KinsolOptions& options, const VectorXd& x0) {
  options.Validate();
  static const PackageSolver<KinsolOptions> by_kinsol("kinsol", "libsundials-dev");
  HeldCoordinates driven(problem, options.held);
  return Run("kinsol", driven, options.stopping, x0, [&](CountedProblem& counted, VectorXd* x) {
    Outcome outcome = by_kinsol(counted, options, x);
    if (outcome.claim != SolveStatus::kUnavailable && !BoundsHold(problem, *x)) {
      outcome.claim = SolveStatus::kUnsuitable;
      outcome.message = "a bound is active, and KINSOL solves equations only";
    }
    return outcome;
  });
}

}  // namespace vmech
