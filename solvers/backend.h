#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "vmech/solvers/constrained_least_squares.h"
#include "vmech/solvers/stopping_rule.h"
#include "vmech/solvers/summary.h"

namespace vmech {

/// Every way to solve a ConstrainedLeastSquares, each with its default options.
enum class Backend {
  kPenalty,
  kAugmentedLagrangian,
  kNullspace,
  kCeresWeighted,
  kCeresExact,
  kIpopt,
  kNloptSlsqp,
  kNloptAuglagLbfgs,
  kNloptAuglagCobyla,
  kNloptAuglagMma,
  kKinsol,
};

/// All of them, in the order of the enumeration.
inline constexpr std::array kAllBackends = {
    Backend::kPenalty,
    Backend::kAugmentedLagrangian,
    Backend::kNullspace,
    Backend::kCeresWeighted,
    Backend::kCeresExact,
    Backend::kIpopt,
    Backend::kNloptSlsqp,
    Backend::kNloptAuglagLbfgs,
    Backend::kNloptAuglagCobyla,
    Backend::kNloptAuglagMma,
    Backend::kKinsol,
};

/// The name by which files and command lines know a back end.
std::string_view NameOf(Backend backend);

/// The back end of that name, if there is one.
std::optional<Backend> BackendFromName(std::string_view name);

/// Solves with a back end's default options and this stopping rule. A back end whose package was
/// absent at build time returns kUnavailable and says which.
Summary Solve(Backend backend, ConstrainedLeastSquares& problem, const StoppingRule& stopping,
              const VectorXd& x0);

}  // namespace vmech
