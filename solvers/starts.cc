#include "vmech/solvers/starts.h"

#include <algorithm>
#include <cmath>

#include "vmech/base/check_range.h"
#include "vmech/solvers/weighted_step.h"

namespace vmech {
namespace {

constexpr double kDamping = 1e-6;
constexpr double kMaxStep = 0.5;     // [unit of the tangent], to stay in the basin of the point
constexpr double kTolerance = 1e-6;  // of the gradient: it is a start, no solution

/// The box of tangents about x0 that is searched.
struct Box {
  VectorXd lower, upper;

  Box(const ConstrainedLeastSquares& problem, const VectorXd& x0, double radius)
      : lower(VectorXd::Constant(problem.sizes().tangents, -radius)), upper(-lower) {
    for (const Bound& bound : problem.bounds()) {
      const double to_lower = bound.lower - x0[bound.coordinate];
      const double to_upper = bound.upper - x0[bound.coordinate];
      const int i = bound.tangent;
      if (std::isfinite(to_lower)) lower[i] = to_lower;
      if (std::isfinite(to_upper)) upper[i] = to_upper;
      if (!std::isfinite(to_lower)) lower[i] = std::min(lower[i], upper[i] - 2 * radius);
      if (!std::isfinite(to_upper)) upper[i] = std::max(upper[i], lower[i] + 2 * radius);
    }
  }

  VectorXd Point(int k) const {
    return lower + EvenPoint(static_cast<int>(lower.size()), k).cwiseProduct(upper - lower);
  }
};

struct Candidate {
  double value;
  VectorXd x;
};

double PenaltyValue(const Linearization& at_x, double weight) {
  return 0.5 * at_x.r.squaredNorm() + 0.5 * weight * weight * at_x.c.squaredNorm();
}

bool IsNew(const std::vector<VectorXd>& starts, const VectorXd& x, double separation) {
  return std::none_of(starts.begin(), starts.end(), [&](const VectorXd& other) {
    return (x - other).cwiseAbs().maxCoeff() < separation;
  });
}

}  // namespace

VectorXd EvenPoint(int n, int k) {
  double g = 2;
  for (int i = 0; i < 50; ++i) g = std::pow(1 + g, 1.0 / (n + 1));
  VectorXd point(n);
  for (int i = 0; i < n; ++i) {
    const double turns = k * std::pow(g, -(i + 1)) + 0.5;
    point[i] = turns - std::floor(turns);
  }
  return point;
}

void StartsOptions::Validate() const {
  CheckRange("StartsOptions", "samples", samples, 1, 1e7);
  CheckRange("StartsOptions", "kept", kept, 1, 1e6);
  CheckRange("StartsOptions", "radius", radius, 1e-6, 1e6);
  CheckRange("StartsOptions", "weight", weight, 1e-3, 1e6);
  CheckRange("StartsOptions", "steps", steps, 0, 1e4);
  CheckRange("StartsOptions", "separation", separation, 1e-300, 1e300);
}

std::vector<VectorXd> FindStarts(ConstrainedLeastSquares& problem, const VectorXd& x0,
                                 const StartsOptions& options) {
  options.Validate();
  const Box box(problem, x0, options.radius);
  const VectorXd no_multipliers = VectorXd::Zero(problem.sizes().constraints);
  WeightedStep step(problem);
  std::vector<Candidate> candidates;
  for (int k = 0; k < options.samples; ++k) {
    VectorXd x = x0;
    if (k > 0) problem.Plus(x0, box.Point(k), &x);
    // However the descent ends, x is the best point that it has seen.
    static_cast<void>(step.Minimize(problem, options.weight, no_multipliers, kDamping, kMaxStep,
                                    kTolerance, options.steps, &x));
    const double value = PenaltyValue(step.at_x, options.weight);
    if (std::isfinite(value)) candidates.push_back({value, std::move(x)});
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.value < b.value; });
  std::vector<VectorXd> starts;
  for (Candidate& candidate : candidates) {
    if (static_cast<int>(starts.size()) == options.kept) break;
    if (IsNew(starts, candidate.x, options.separation)) starts.push_back(std::move(candidate.x));
  }
  if (starts.empty()) starts.push_back(x0);
  return starts;
}

}  // namespace vmech
