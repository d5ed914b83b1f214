#include "vmech/solvers/backend.h"

#include "vmech/solvers/augmented_lagrangian.h"
#include "vmech/solvers/backends/ceres.h"
#include "vmech/solvers/backends/ipopt.h"
#include "vmech/solvers/backends/kinsol.h"
#include "vmech/solvers/backends/nlopt.h"
#include "vmech/solvers/nullspace.h"
#include "vmech/solvers/penalty.h"

namespace vmech {
namespace {

struct Entry {
  std::string_view name;
  Summary (*solve)(ConstrainedLeastSquares&, const StoppingRule&, const VectorXd&);
};

template <typename Options>
Summary SolveByDefault(ConstrainedLeastSquares& problem, const StoppingRule& stopping,
                       const VectorXd& x0) {
  Options options;
  options.stopping = stopping;
  return Solve(problem, options, x0);
}

template <typename Options, auto kMethod>
Summary SolveByMethod(ConstrainedLeastSquares& problem, const StoppingRule& stopping,
                      const VectorXd& x0) {
  Options options;
  options.method = kMethod;
  options.stopping = stopping;
  return Solve(problem, options, x0);
}

// In the order of the enumeration.
constexpr Entry kEntries[] = {
    {"penalty", SolveByDefault<PenaltyOptions>},
    {"augmented_lagrangian", SolveByDefault<AugmentedLagrangianOptions>},
    {"nullspace", SolveByDefault<NullspaceOptions>},
    {"ceres_weighted", SolveByMethod<CeresOptions, CeresMethod::kWeighted>},
    {"ceres_exact", SolveByMethod<CeresOptions, CeresMethod::kExact>},
    {"ipopt", SolveByDefault<IpoptOptions>},
    {"nlopt_slsqp", SolveByMethod<NloptOptions, NloptMethod::kSlsqp>},
    {"nlopt_auglag_lbfgs", SolveByMethod<NloptOptions, NloptMethod::kAuglagLbfgs>},
    {"nlopt_auglag_cobyla", SolveByMethod<NloptOptions, NloptMethod::kAuglagCobyla>},
    {"nlopt_auglag_mma", SolveByMethod<NloptOptions, NloptMethod::kAuglagMma>},
    {"kinsol", SolveByDefault<KinsolOptions>},
};
static_assert(std::size(kEntries) == kAllBackends.size());

}  // namespace

std::string_view NameOf(Backend backend) {
  return kEntries[static_cast<int>(backend)].name;
}

std::optional<Backend> BackendFromName(std::string_view name) {
  for (Backend backend : kAllBackends) {
    if (NameOf(backend) == name) return backend;
  }
  return std::nullopt;
}

Summary Solve(Backend backend, ConstrainedLeastSquares& problem, const StoppingRule& stopping,
              const VectorXd& x0) {
  return kEntries[static_cast<int>(backend)].solve(problem, stopping, x0);
}

}  // namespace vmech
