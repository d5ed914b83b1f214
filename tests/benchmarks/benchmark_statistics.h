#pragma once

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace vmech {

/// The smallest value that at least 99 % of the values do not exceed (nearest rank).
inline double Percentile99(const std::vector<double>& values) {
  std::vector<double> sorted = values;
  std::sort(sorted.begin(), sorted.end());
  const double rank = std::ceil(0.99 * static_cast<double>(sorted.size()));
  return sorted[static_cast<std::size_t>(rank) - 1];
}

inline double Maximum(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end());
}

/// Reports the median, the 99th percentile and the maximum over many short repetitions:
/// `BENCHMARK(InverseDynamics)->Apply(vmech::ReportPercentiles)`. A repetition is the mean over the
/// calls of one millisecond: short against a scheduler's time slice, long against the clock.
inline void ReportPercentiles(benchmark::internal::Benchmark* benchmark) {
  constexpr int kRepetitions = 300;
  constexpr double kSecondsEach = 1e-3;
  benchmark->Repetitions(kRepetitions)
      ->MinTime(kSecondsEach)
      ->ReportAggregatesOnly(true)
      ->ComputeStatistics("p99", Percentile99)
      ->ComputeStatistics("max", Maximum);
}

}  // namespace vmech
