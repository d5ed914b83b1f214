// What a tick of the haptic mode costs, whole and stage by stage, behind a 7-joint arm with 16-bit
// encoders and with a hand that pulls.

#include <atomic>
#include <chrono>
#include <memory>
#include <string>
#include <thread>

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

/// A page that takes a picture of the tick sixty times a second.
class Watcher {
 public:
  explicit Watcher(TripleBuffer<TickPicture>* pictures)
      : thread_([this, pictures] {
          while (!over_) {
            benchmark::DoNotOptimize(pictures->Take());
            std::this_thread::sleep_for(std::chrono::microseconds(16'667));
          }
        }) {}
  ~Watcher() {
    over_ = true;
    thread_.join();
  }

 private:
  std::atomic<bool> over_ = false;
  std::thread thread_;
};

/// As `Full`, with a page attached or without: both in turn in one run.
void RegisterWatched(const std::string& example, bool watched) {
  const std::string name = example + (watched ? "/watched" : "/unwatched");
  benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
    HeldTick tick(example, Architecture::kCoupled);
    std::unique_ptr<Watcher> page;
    if (watched) page = std::make_unique<Watcher>(tick.Show());
    for (auto _ : state) tick.Full();
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
  for (const char* example : {"slider-crank", "stewart-gough"}) {
    RegisterWatched(example, false);
    RegisterWatched(example, true);
  }
  Register("observer", &HeldTick::Observe, "crank", Architecture::kCoupled);
  Register("safety", &HeldTick::Filter, "crank", Architecture::kCoupled);
  Register("arm_torques", &HeldTick::Resolve, "crank", Architecture::kCoupled);
  return true;
}();

}  // namespace
}  // namespace vmech
