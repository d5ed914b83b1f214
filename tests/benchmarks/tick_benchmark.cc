// What a tick of the haptic mode costs, whole and stage by stage, behind a 7-joint arm with 16-bit
// encoders and with a hand that pulls.

#include "benchmark_statistics.h"
#include "held_tick.h"

namespace vmech {
namespace {

void RegisterStages(const std::string& example) {
  const std::pair<const char*, void (HeldTick::*)()> stages[] = {
      {"full", &HeldTick::Full},     {"mechanism", &HeldTick::Step},
      {"track", &HeldTick::Track},   {"dynamics", &HeldTick::Evaluate},
      {"safety", &HeldTick::Filter}, {"arm_torques", &HeldTick::Resolve}};
  for (const auto& [name, stage] : stages) {
    benchmark::RegisterBenchmark((example + "/" + name).c_str(), [example, stage = stage](
                                                                     benchmark::State& state) {
      HeldTick tick(example);
      for (auto _ : state) (tick.*stage)();
    })->Apply(ReportPercentiles);
  }
}

const bool registered = [] {
  for (const char* example :
       {"crank", "two-link-arm", "slider-crank", "four-bar", "rssr", "bennett", "stewart-gough"}) {
    RegisterStages(example);
  }
  return true;
}();

}  // namespace
}  // namespace vmech
