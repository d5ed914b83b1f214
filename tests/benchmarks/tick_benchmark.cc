// What a tick of the haptic mode costs, whole and stage by stage, behind a 7-joint arm with 16-bit
// encoders and with a hand that pulls.

#include "benchmark_statistics.h"
#include "hw_interface/held_tick.h"

namespace vmech {
namespace {

void Register(const std::string& name, void (HeldTick::*stage)(), const std::string& example,
              Architecture architecture) {
  benchmark::RegisterBenchmark((example + "/" + name).c_str(), [=](benchmark::State& state) {
    HeldTick tick(example, architecture);
    for (auto _ : state) (tick.*stage)();
  })->Apply(ReportPercentiles);
}

const bool registered = [] {
  for (const char* example :
       {"crank", "two-link-arm", "slider-crank", "four-bar", "rssr", "bennett", "stewart-gough"}) {
    Register("coupled", &HeldTick::Full, example, Architecture::kCoupled);
    Register("coupled_mechanism", &HeldTick::Step, example, Architecture::kCoupled);
    Register("paper", &HeldTick::Full, example, Architecture::kPaper);
    Register("paper_mechanism", &HeldTick::Step, example, Architecture::kPaper);
  }
  Register("observer", &HeldTick::Observe, "crank", Architecture::kCoupled);
  Register("safety", &HeldTick::Filter, "crank", Architecture::kCoupled);
  Register("arm_torques", &HeldTick::Resolve, "crank", Architecture::kCoupled);
  return true;
}();

}  // namespace
}  // namespace vmech
