#include "vmech/solvers/backends/nlopt.h"

#include "vmech/base/check_range.h"
#include "vmech/solvers/backends/package.h"

namespace vmech {

void NloptOptions::Validate() const {
  CheckRange("NloptOptions", "tolerance", tolerance, 1e-17, 1e-3);
  CheckRange("NloptOptions", "initial_step", initial_step, 1e-6, 10);
  CheckRange("NloptOptions", "final_step", final_step, 1e-12, 1e-3);
  CheckRange("NloptOptions", "max_seconds", max_seconds, 1e-3, 1e6);
  stopping.Validate();
}

Summary Solve(ConstrainedLeastSquares& problem, const NloptOptions& options, const VectorXd& x0) {
  options.Validate();
  static const PackageSolver<NloptOptions> by_nlopt("nlopt", "libnlopt-dev");
  return Run(NameOf(options.method), problem, options.stopping, x0,
             [&](CountedProblem& counted, VectorXd* x) { return by_nlopt(counted, options, x); });
}

}  // namespace vmech
