#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "vmech/apps/commands.h"
#include "vmech/apps/haptic/handle_home.h"
#include "vmech/apps/haptic/haptic_session.h"
#include "vmech/apps/haptic/interrupt_scope.h"
#include "vmech/hw_interface/loop/realtime.h"
#include "vmech/hw_interface/loop/runner.h"
#include "vmech/hw_interface/probing/identification.h"
#include "vmech/hw_interface/probing/probe_ticks.h"
#include "vmech/hw_interface/remote/udp_server.h"
#include "vmech/hw_interface/safety/stability.h"

namespace vmech {
namespace {

/// "0.3 kg", or that it is unknown.
std::string Figure(const char* name, double value, const char* unit, double times = 1) {
  if (value == 0) return fmt::format("{} unknown", name);
  return fmt::format("{} {:.4g} {}", name, times * value, unit);
}

std::string LinearReport(const HandlePhysics& handle) {
  return fmt::format("  translation   {}, {}, {},\n                {}, {}, {}\n",
                     Figure("mass", handle.mass, "kg"), Figure("damping", handle.damping, "N s/m"),
                     Figure("dry friction", handle.coulomb, "N"),
                     Figure("resolution", handle.resolution, "um", 1e6),
                     Figure("peak", handle.peak, "N"),
                     std::isinf(handle.max_speed) ? "no speed that trips"
                                                  : Figure("trips above", handle.max_speed, "m/s"));
}

std::string AngularReport(const HandlePhysics& handle) {
  return fmt::format(
      "  rotation      {}, {},\n                {}, {}\n",
      Figure("inertia", handle.mass, "g m^2", 1e3), Figure("damping", handle.damping, "N m s/rad"),
      Figure("resolution", handle.resolution, "mrad", 1e3), Figure("peak", handle.peak, "N m"));
}

std::string SensesReport(std::uint32_t senses) {
  constexpr std::array<std::pair<std::uint32_t, const char*>, 7> kNames{
      {{kSensesPose, "pose"},
       {kSensesTwist, "velocity"},
       {kSensesJoints, "joints"},
       {kSensesGripper, "gripper"},
       {kSensesButtons, "buttons"},
       {kSensesAppliedWrench, "force at work"},
       {kSensesEcho, "command at work"}}};
  std::string text;
  for (const auto& [bit, name] : kNames) {
    if ((senses & bit) != 0) text += (text.empty() ? "" : ", ") + std::string(name);
  }
  return text.empty() ? "nothing" : text;
}

std::string StatedReport(const DeviceInfo& info) {
  const bool forces = info.takes_wrench || info.takes_torque;
  const char* takes = !forces             ? "no commands: it exerts no force"
                      : ForcesAlone(info) ? "forces, no moments: mechanisms are held at a point"
                      : info.takes_torque ? "forces and moments, or joint torques"
                                          : "forces and moments";
  std::string report = fmt::format(
      "{}\n  samples       every {:.4g} ms; a command acts {:.3g} ms later\n"
      "  senses        {}{}\n  takes         {}\n",
      info.name, 1e3 * info.period, 1e3 * info.delay, SensesReport(info.senses),
      info.has_dead_man ? ", a dead-man switch" : "", takes);
  if (!forces) return report;
  report += LinearReport(info.linear);
  if (!ForcesAlone(info)) report += AngularReport(info.angular);
  return report + BoundsReport(info);
}

/// What a device was seen to do.
struct Watched {
  int samples = 0, missing = 0, lost = 0;
  MasterState last;
  Vector3d low = Vector3d::Constant(1e9), high = -low;
};

/// Reads a device that is not active, period after period.
Watched Watch(Master* master, LoopClock* clock, double seconds) {
  const auto period_ns = std::llround(1e9 * master->info().period);
  const auto ticks = std::llround(seconds / master->info().period);
  Watched watched;
  std::int64_t slot_ns = clock->Now();
  for (long k = 0; k < ticks; ++k, slot_ns += period_ns) {
    clock->SleepUntil(slot_ns);
    const IoStatus io = master->Read(slot_ns, &watched.last);
    (void)master->Write({});  // some devices answer only when they are spoken to
    watched.samples += io == IoStatus::kOk;
    watched.missing += io == IoStatus::kNoNewData;
    watched.lost += io == IoStatus::kLinkLost || io == IoStatus::kDeviceFault;
    if (io != IoStatus::kOk) continue;
    watched.low = watched.low.cwiseMin(watched.last.X_DH.p);
    watched.high = watched.high.cwiseMax(watched.last.X_DH.p);
  }
  return watched;
}

std::string WatchedReport(const Watched& watched) {
  if (watched.samples == 0) return "it gave no sample\n";
  const MasterState& state = watched.last;
  const Vector3d p = 1e3 * state.X_DH.p;
  const bool posed = (state.valid & kSensesPose) != 0;
  return fmt::format(
      "{} samples, {} periods without, {} with the link lost\n"
      "handle {}at {:.2f}, {:.2f}, {:.2f} mm, which went over {:.3g} mm; buttons {:b}{}{}\n",
      watched.samples, watched.missing, watched.lost, posed ? "" : "(no pose) ", p.x(), p.y(),
      p.z(), 1e3 * (watched.high - watched.low).norm(), state.buttons,
      state.dead_man ? "" : "; the dead-man switch is released",
      state.emergency_stop ? "; the emergency stop is pressed" : "");
}

/// One run that moves the handle. @throws std::runtime_error where it was cut short.
Recording Shake(const ShakeOptions& shake, Master* master, LoopClock* clock) {
  ShakeTick tick(shake, master->info().period);
  RunnerOptions options;
  options.seconds = shake.total_seconds();
  options.record = true;
  options.joint_torques = false;
  if (dynamic_cast<FreeRunningClock*>(clock) != nullptr) options.realtime.reset();
  options.safety = ProbeSafety(std::max(shake.force, shake.blows_to), shake.speed);
  Runner runner(options, master, &tick, clock);
  const InterruptScope interrupt(&runner);
  const RunSummary summary = runner.Run();
  if (summary.status == RunStatus::kFinished) return runner.Kept();
  throw std::runtime_error(
      summary.status == RunStatus::kStopped
          ? "interrupted; the motors are off"
          : fmt::format("the handle was let go ({}); the motors are off. Try a smaller --force, "
                        "and let nobody hold the handle",
                        NameOf(summary.cause)));
}

std::string FitReport(const HandleFit& fit, const DeviceInfo& info) {
  std::string report = "                     x        y        z     stated\n";
  const auto line = [&](const char* name, double AxisFit::*figure, double stated) {
    report += fmt::format("  {:<14}", name);
    for (const AxisFit& axis : fit.axes) report += fmt::format(" {:>8.3g}", axis.*figure);
    report += stated > 0 ? fmt::format("   {:>8.3g}\n", stated) : "    unknown\n";
  };
  line("mass kg", &AxisFit::mass, info.linear.mass);
  line("damping N s/m", &AxisFit::damping, info.linear.damping);
  line("dry friction N", &AxisFit::coulomb, info.linear.coulomb);
  double worst = 0;
  for (const AxisFit& axis : fit.axes) worst = std::max(worst, axis.unexplained);
  return report + fmt::format(
                      "  delay {:.2g} ms (stated: {:.2g}); {:.1f} % of the force is left "
                      "over at most\n",
                      1e3 * fit.delay, 1e3 * info.delay, 100 * worst);
}

std::string Verdict(const HandleFit& fit) {
  constexpr double kDoubtful = 0.2;
  for (const AxisFit& axis : fit.axes) {
    if (axis.unexplained <= kDoubtful && axis.mass > 0) continue;
    return "These figures are not to be trusted: the handle did not move as a mass with friction. "
           "Let nobody hold it, and see that it does not stand at the end of its way.\n";
  }
  const HandlePhysics handle = fit.Physics();
  std::string figures = fmt::format("mass={:.3g}", handle.mass);
  if (handle.damping > 0) figures += fmt::format(",damping={:.3g}", handle.damping);
  if (handle.coulomb > 0) figures += fmt::format(",coulomb={:.3g}", handle.coulomb);
  return fmt::format("The least of each, for the driver or for vmech haptic:\n  --handle {}\n",
                     figures);
}

std::string PeakReport(const PeakFit& peak, double asked) {
  if (peak.reached) {
    return fmt::format("peak {:.3g} N: more was not exerted when {:.3g} N were asked for\n",
                       peak.peak, asked);
  }
  return fmt::format("peak at least {:.3g} N, all that was asked for\n", peak.peak);
}

void Identify(const DeviceArguments& arguments, Master* master, LoopClock* clock) {
  const DeviceInfo& info = master->info();
  if (!info.takes_wrench) {
    throw std::invalid_argument("device: '" + info.name + "' exerts no force that could move it");
  }
  ShakeOptions shake;
  shake.force = arguments.force > 0 ? arguments.force : GentleForce(info);
  fmt::print("The handle is moved for {:.0f} s with at most {:.2g} N; let nobody hold it.\n",
             shake.total_seconds(), shake.force);
  std::fflush(stdout);
  const HandleFit fit = FitHandle(Shake(shake, master, clock));
  fmt::print("{}{}", FitReport(fit, info), Verdict(fit));
  if (arguments.peak_to == 0) return;
  shake.blows_to = arguments.peak_to;
  shake.mass = std::max(fit.Physics().mass, 1e-3);
  shake.speed = 0.3;
  fmt::print("{}", PeakReport(FitPeak(Shake(shake, master, clock), fit), arguments.peak_to));
}

/// The device's end of `--master udp:..`, until Ctrl-C.
void Serve(const DeviceArguments& arguments, Master* master) {
  UdpServerOptions options;
  options.local = {arguments.listen, *arguments.serve};
  UdpServer server(options, master);
  fmt::print("served at {}:{} until Ctrl-C\n", arguments.listen, server.port());
  std::fflush(stdout);
  std::atomic<bool> over = false;
  const InterruptScope interrupt(&over);
  const RealtimeScope realtime({});
  const auto period_ns = std::llround(1e9 * master->info().period);
  WallClock clock;
  for (std::int64_t slot_ns = clock.Now(); !over; slot_ns += period_ns) {
    clock.SleepUntil(slot_ns);
    server.Step(slot_ns);
    slot_ns += (clock.Now() - slot_ns) / period_ns * period_ns;  // never in a burst
  }
  master->Deactivate();
  const LinkStatistics& link = server.statistics();
  fmt::print("{} packets, {} missing, {} stale, {} malformed\n", link.received, link.missing,
             link.stale, link.malformed);
}

}  // namespace

int RunDevice(const DeviceArguments& arguments) {
  constexpr double kLook = 1;  // [s]
  MasterRequest request;
  request.word = arguments.master;
  request.rate = arguments.rate;
  request.grip = Grip::kAbsent;
  const std::unique_ptr<Master> master = MakeMaster(request);
  master->Configure();
  FreeRunningClock free;
  WallClock wall;
  LoopClock* clock = arguments.free_running ? static_cast<LoopClock*>(&free) : &wall;
  fmt::print("{}", StatedReport(master->info()));
  if (arguments.serve) {
    Serve(arguments, master.get());
    return kSuccess;
  }
  fmt::print("{}", WatchedReport(Watch(master.get(), clock, kLook)));
  if (arguments.identify) Identify(arguments, master.get(), clock);
  return kSuccess;
}

}  // namespace vmech
