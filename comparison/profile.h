#pragma once

#include <vector>

namespace vmech {

/// A performance profile [Dolan & More 2002]: for each solver the share of all problems that it
/// solves within `ratio` times what the best solver needs for them,
///
///   rho_s(tau) = |{p : cost[p][s] <= tau min_s' cost[p][s']}| / problems.
///
/// rho_s(1) is how often the solver is the best, its limit the share of problems that it solves.
struct PerformanceProfile {
  /// Steps of one solver, ratios increasing: from `ratio[i]` on the share is `share[i]`.
  struct Curve {
    std::vector<double> ratio, share;  ///< [steps] both increasing
    double At(double tau) const;       ///< 0 before the first step
  };
  std::vector<Curve> curves;  ///< per solver
  double largest_ratio = 1;   ///< of all solved problems
};

/// cost[problem][solver], positive; not finite where the solver failed. Every problem counts, those
/// that nobody solves too. @throws std::invalid_argument for rows of unequal length or a cost
/// <= 0.
PerformanceProfile MakePerformanceProfile(const std::vector<std::vector<double>>& cost);

/// The share of values that are at most x, as steps; values that are not finite count and are never
/// reached.
PerformanceProfile::Curve CumulativeShare(std::vector<double> values);

}  // namespace vmech
