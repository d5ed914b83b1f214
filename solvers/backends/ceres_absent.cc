#include "vmech/solvers/backends/ceres.h"
#include "vmech/solvers/run.h"

namespace vmech {

void CeresOptions::Validate() const {
  stopping.Validate();
}

Summary Solve(ConstrainedLeastSquares& problem, const CeresOptions& options, const VectorXd& x0) {
  const char* name = options.method == CeresMethod::kExact ? "ceres_exact" : "ceres_weighted";
  return Run(name, problem, options.stopping, x0, [](CountedProblem&, VectorXd*) {
    return Outcome{SolveStatus::kUnavailable,
                   "vmech was built without Ceres; install libceres-dev and build again"};
  });
}

}  // namespace vmech
