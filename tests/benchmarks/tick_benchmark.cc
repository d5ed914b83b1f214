// What a tick of the haptic mode costs, whole and stage by stage, behind a 7-joint arm with 16-bit
// encoders and with a hand that pulls.

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "benchmark_statistics.h"
#include "hw_interface/held_tick.h"
#include "support/examples.h"
#include "vmech/hw_interface/loop/replay_master.h"
#include "vmech/hw_interface/loop/runner.h"
#include "vmech/hw_interface/masters/simulated_master.h"

namespace vmech {
namespace {

void Register(const std::string& name, void (HeldTick::*stage)(), const std::string& example,
              Architecture architecture) {
  benchmark::RegisterBenchmark((example + "/" + name).c_str(), [=](benchmark::State& state) {
    HeldTick tick(example, architecture);
    for (auto _ : state) (tick.*stage)();
  })->Apply(ReportPercentiles);
}

/// A session as fast as it computes, in which a page takes sixty pictures a second if one is
/// attached. It keeps what each tick took from the sample to the command.
class PageClock : public FreeRunningClock {
 public:
  explicit PageClock(bool attached) : attached_(attached) {}
  void Watch(Runner* runner) { runner_ = runner; }
  void SleepUntil(std::int64_t time_ns) noexcept override {
    FreeRunningClock::SleepUntil(time_ns);
    if (runner_->live().ticks == 0) return;
    took_ns_.push_back(static_cast<double>(runner_->live().compute_ns));
    if (attached_ && took_ns_.size() % 16 == 0)
      benchmark::DoNotOptimize(runner_->pictures().Take());
  }
  /// The smallest time that a share of the ticks did not exceed [ns].
  double Percentile(double share) {
    const auto place = took_ns_.begin() + std::llround(share * double(took_ns_.size() - 1));
    std::nth_element(took_ns_.begin(), place, took_ns_.end());
    return *place;
  }

 private:
  bool attached_;
  Runner* runner_ = nullptr;
  std::vector<double> took_ns_;
};

/// A mechanism in the wandering hand, through the whole loop.
class WatchedSession {
 public:
  explicit WatchedSession(const std::string& example)
      : tree_(BuildKinematicTree(Example(example))), grasp_(FindGrasp(tree_.mechanism, "handle")) {
    SimulatedMasterOptions options;
    options.motion = WanderingHand();
    SimulatedMaster master(options);
    master.Configure();
    FreeRunningClock clock;
    std::unique_ptr<Tick> tick = TickFor(master.info());
    Runner runner(options_, &master, tick.get(), &clock);
    runner.Run();
    recording_ = runner.Kept();
  }

  /// The recorded hand again, with a page attached or without: the clock has what each tick took.
  PageClock Run(bool attached) {
    ReplayMaster master(recording_, ReplayKind::kSession);
    master.Configure();
    std::unique_ptr<Tick> tick = TickFor(master.info());
    PageClock clock(attached);
    Runner runner(options_, &master, tick.get(), &clock);
    clock.Watch(&runner);
    runner.Run();
    return clock;
  }

 private:
  std::unique_ptr<Tick> TickFor(const DeviceInfo& device) {
    return ChosenTick(tree_, grasp_, device, Architecture::kCoupled, &options_.safety);
  }

  static RunnerOptions Seconds(double seconds) {
    RunnerOptions options;
    options.seconds = seconds;
    options.record = true;
    options.realtime.reset();
    return options;
  }

  KinematicTree tree_;
  int grasp_;
  RunnerOptions options_ = Seconds(10);
  Recording recording_;
};

/// A session with a page and one without in turn, and by how much the page's ticks are longer.
void RegisterWatched(const std::string& example) {
  benchmark::RegisterBenchmark(
      (example + "/watched").c_str(),
      [=](benchmark::State& state) {
        WatchedSession session(example);
        for (auto _ : state) {
          PageClock alone = session.Run(false), watched = session.Run(true);
          for (const auto& [name, share] : {std::pair("median", 0.5), std::pair("p99", 0.99)}) {
            const double ns = watched.Percentile(share);
            state.counters[std::string(name) + "_ns"] = ns;
            state.counters[std::string(name) + "_longer_by"] = ns / alone.Percentile(share) - 1;
          }
        }
      })
      ->Iterations(1)
      ->Repetitions(51)
      ->ReportAggregatesOnly(true);
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
    RegisterWatched(example);
  }
  Register("observer", &HeldTick::Observe, "crank", Architecture::kCoupled);
  Register("safety", &HeldTick::Filter, "crank", Architecture::kCoupled);
  Register("arm_torques", &HeldTick::Resolve, "crank", Architecture::kCoupled);
  return true;
}();

}  // namespace
}  // namespace vmech
