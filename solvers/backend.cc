#include "vmech/solvers/backend.h"

#include "vmech/solvers/augmented_lagrangian.h"
#include "vmech/solvers/nullspace.h"
#include "vmech/solvers/penalty.h"

namespace vmech {
namespace {

template <typename Options>
Summary SolveWith(Options options, ConstrainedLeastSquares& problem, const StoppingRule& stopping,
                  const VectorXd& x0) {
  options.stopping = stopping;
  return Solve(problem, options, x0);
}

struct Entry {
  std::string_view name;
  Summary (*solve)(ConstrainedLeastSquares&, const StoppingRule&, const VectorXd&);
};

// In the order of the enumeration.
constexpr Entry kEntries[] = {
    {"penalty", [](auto& problem, const auto& stopping,
                   const auto& x0) { return SolveWith(PenaltyOptions{}, problem, stopping, x0); }},
    {"augmented_lagrangian",
     [](auto& problem, const auto& stopping, const auto& x0) {
       return SolveWith(AugmentedLagrangianOptions{}, problem, stopping, x0);
     }},
    {"nullspace",
     [](auto& problem, const auto& stopping, const auto& x0) {
       return SolveWith(NullspaceOptions{}, problem, stopping, x0);
     }},
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
