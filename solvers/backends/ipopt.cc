#include "vmech/solvers/backends/ipopt.h"

#include "vmech/base/check_range.h"
#include "vmech/solvers/backends/package.h"

namespace vmech {

void IpoptOptions::Validate() const {
  CheckRange("IpoptOptions", "tolerance", tolerance, 1e-14, 1e-2);
  CheckRange("IpoptOptions", "initial_barrier", initial_barrier, 1e-12, 1e3);
  stopping.Validate();
}

Summary Solve(ConstrainedLeastSquares& problem, const IpoptOptions& options, const VectorXd& x0) {
  options.Validate();
  static const PackageSolver<IpoptOptions> by_ipopt("ipopt", "coinor-libipopt-dev");
  return Run("ipopt", problem, options.stopping, x0,
             [&](CountedProblem& counted, VectorXd* x) { return by_ipopt(counted, options, x); });
}

}  // namespace vmech
