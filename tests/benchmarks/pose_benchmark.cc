#include <array>

#include "benchmark_statistics.h"
#include "vmech/base/pose.h"

namespace vmech {
namespace {

/// The poses of seven links in a row, each from the one before.
void PoseChain(benchmark::State& state) {
  std::array<Posed, 7> X_PL;
  for (Posed& X : X_PL) X = {Matrix3d::Identity(), Vector3d(0.1, 0.2, 0.3)};
  for (auto _ : state) {
    benchmark::DoNotOptimize(X_PL.data());
    Posed X_WL;
    for (const Posed& X : X_PL) X_WL = X_WL * X;
    benchmark::DoNotOptimize(X_WL);
  }
}
BENCHMARK(PoseChain)->Apply(ReportPercentiles);

}  // namespace
}  // namespace vmech
