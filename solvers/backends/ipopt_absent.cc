#include "vmech/solvers/backends/ipopt.h"
#include "vmech/solvers/run.h"

namespace vmech {

void IpoptOptions::Validate() const {
  stopping.Validate();
}

Summary Solve(ConstrainedLeastSquares& problem, const IpoptOptions& options, const VectorXd& x0) {
  return Run("ipopt", problem, options.stopping, x0, [](CountedProblem&, VectorXd*) {
    return Outcome{SolveStatus::kUnavailable,
                   "vmech was built without Ipopt; install coinor-libipopt-dev and build again"};
  });
}

}  // namespace vmech
