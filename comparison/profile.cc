#include "vmech/comparison/profile.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace vmech {

PerformanceProfile MakePerformanceProfile(const std::vector<std::vector<double>>& cost) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  PerformanceProfile profile;
  if (cost.empty()) return profile;
  std::vector<std::vector<double>> ratios(cost[0].size());
  for (const std::vector<double>& problem : cost) {
    if (problem.size() != ratios.size()) {
      throw std::invalid_argument("a performance profile needs one cost per problem and solver");
    }
    double best = kNever;
    for (const double value : problem) {
      if (value <= 0) throw std::invalid_argument("costs in a performance profile are positive");
      if (std::isfinite(value)) best = std::min(best, value);
    }
    for (size_t s = 0; s < problem.size(); ++s) {
      const double ratio = std::isfinite(problem[s]) ? problem[s] / best : kNever;
      ratios[s].push_back(ratio);
      if (std::isfinite(ratio)) profile.largest_ratio = std::max(profile.largest_ratio, ratio);
    }
  }
  for (std::vector<double>& values : ratios) {
    profile.curves.push_back(CumulativeShare(std::move(values)));
  }
  return profile;
}

PerformanceProfile::Curve CumulativeShare(std::vector<double> values) {
  PerformanceProfile::Curve curve;
  for (double& value : values) {
    if (!std::isfinite(value)) value = std::numeric_limits<double>::infinity();
  }
  std::sort(values.begin(), values.end());
  const double count = static_cast<double>(values.size());
  for (size_t i = 0; i < values.size() && std::isfinite(values[i]); ++i) {
    if (i + 1 < values.size() && values[i + 1] == values[i]) continue;
    curve.ratio.push_back(values[i]);
    curve.share.push_back(static_cast<double>(i + 1) / count);
  }
  return curve;
}

double PerformanceProfile::Curve::At(double tau) const {
  const auto after = std::upper_bound(ratio.begin(), ratio.end(), tau);
  return after == ratio.begin() ? 0 : share[static_cast<size_t>(after - ratio.begin()) - 1];
}

}  // namespace vmech
