#include "vmech/solvers/backends/ceres.h"

#include "vmech/base/check_range.h"
#include "vmech/solvers/backends/package.h"

namespace vmech {

void CeresOptions::Validate() const {
  CheckRange("CeresOptions", "weight", weight, 1, 1e6);
  CheckRange("CeresOptions", "max_weight", max_weight, 10, 1e7);
  stopping.Validate();
}

Summary Solve(ConstrainedLeastSquares& problem, const CeresOptions& options, const VectorXd& x0) {
  options.Validate();
  static const PackageSolver<CeresOptions> by_ceres("ceres", "libceres-dev");
  const char* name = options.method == CeresMethod::kExact ? "ceres_exact" : "ceres_weighted";
  return Run(name, problem, options.stopping, x0,
             [&](CountedProblem& counted, VectorXd* x) { return by_ceres(counted, options, x); });
}

}  // namespace vmech
