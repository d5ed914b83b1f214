#include "vmech/apps/haptic/handle_home.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "vmech/apps/haptic/interrupt_scope.h"
#include "vmech/hw_interface/loop/runner.h"
#include "vmech/hw_interface/probing/probe_ticks.h"

namespace vmech {

double GentleForce(const DeviceInfo& device) {
  return device.linear.peak > 0 ? std::min(2.0, 0.25 * device.linear.peak) : 1.0;
}

void BringHome(Master* master, LoopClock* clock, const Vector3d& home) {
  constexpr double kPatience = 15;  // [s]
  constexpr double kSpeed = 0.25;   // [m/s] half of what trips
  const double force = GentleForce(master->info());
  Runner* running = nullptr;
  bool arrived = false;
  GuideTick tick(home, force, master->info().period, [&] {
    arrived = true;
    running->Stop();
  });
  RunnerOptions options;
  options.seconds = kPatience;
  options.safety = ProbeSafety(force, kSpeed);
  options.realtime.reset();
  Runner runner(options, master, &tick, clock);
  running = &runner;
  const InterruptScope interrupt(&runner);
  const RunSummary summary = runner.Run();
  if (arrived) return;
  const bool fault = summary.status == RunStatus::kFault;
  throw std::runtime_error(fmt::format(
      "--home: the handle is {:.0f} mm from there{}; bring it there by hand, or name another home",
      1e3 * tick.distance(), fault ? fmt::format(" ({})", NameOf(summary.cause)) : ""));
}

}  // namespace vmech
