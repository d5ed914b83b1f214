#include "vmech/solvers/backends/kinsol.h"

#include "vmech/solvers/held_coordinates.h"
#include "vmech/solvers/run.h"

namespace vmech {

void KinsolOptions::Validate() const {
  stopping.Validate();
}

Summary Solve(ConstrainedLeastSquares& problem, const KinsolOptions& options, const VectorXd& x0) {
  HeldCoordinates driven(problem, options.held);
  return Run("kinsol", driven, options.stopping, x0, [](CountedProblem&, VectorXd*) {
    return Outcome{SolveStatus::kUnavailable,
                   "vmech was built without KINSOL; install libsundials-dev and build again"};
  });
}

}  // namespace vmech
