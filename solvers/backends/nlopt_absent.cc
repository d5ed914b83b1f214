#include "vmech/solvers/backends/nlopt.h"
#include "vmech/solvers/run.h"

namespace vmech {

void NloptOptions::Validate() const {
  stopping.Validate();
}

Summary Solve(ConstrainedLeastSquares& problem, const NloptOptions& options, const VectorXd& x0) {
  return Run(NameOf(options.method), problem, options.stopping, x0, [](CountedProblem&, VectorXd*) {
    return Outcome{SolveStatus::kUnavailable,
                   "vmech was built without NLopt; install libnlopt-dev and build again"};
  });
}

}  // namespace vmech
