#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <stdexcept>
#include <thread>

#include "vmech/apps/commands.h"
#include "vmech/apps/haptic_session.h"
#include "vmech/hw_interface/runner.h"
#include "vmech/hw_interface/stability.h"
#include "vmech/kinematics/assembly.h"
#include "vmech/kinematics/forward_kinematics.h"

namespace vmech {
namespace {

std::atomic<Runner*> running = nullptr;

void StopRunning(int) {
  if (Runner* runner = running) runner->Stop();
}

/// Ends the run on Ctrl-C, with the motors off and the report printed.
class InterruptScope {
 public:
  explicit InterruptScope(Runner* runner) {
    running = runner;
    std::signal(SIGINT, StopRunning);
    std::signal(SIGTERM, StopRunning);
  }
  ~InterruptScope() {
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
    running = nullptr;
  }
};

/// Prints the newest figures ten times a second while it lives, on a terminal only.
class StatusLine {
 public:
  StatusLine(const Runner& runner, bool quiet) {
    if (quiet || !isatty(STDERR_FILENO)) return;
    thread_ = std::thread([this, &runner] {
      while (!done_) {
        const LiveStatus& live = runner.live();
        fmt::print(stderr, "\r{:>9} ticks  {:>7.2f} N  compute {:>6.1f} us  skipped {:<6} {:<15}",
                   live.ticks.load(), live.force.load(),
                   1e-3 * static_cast<double>(live.compute_ns.load()), live.skipped.load(),
                   NameOf(live.off.load()));
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
      }
      fmt::print(stderr, "\r{:78}\r", "");
    });
  }
  ~StatusLine() {
    done_ = true;
    if (thread_.joinable()) thread_.join();
  }

 private:
  std::atomic<bool> done_ = false;
  std::thread thread_;
};

/// The loops closed at the file's start values.
VectorXd StartPose(const KinematicTree& tree, const std::filesystem::path& file) {
  VectorXd q = StartCoordinates(tree);
  const AssemblySummary summary = Assemble(tree, {}, &q);
  if (summary.closed) return q;
  throw std::runtime_error(fmt::format("{}: {}", file.string(), summary.message));
}

/// Joints with springs or friction stay whole: the hand's dynamics know them in the tree only.
SpanningTreeOptions KeepSprings(const Mechanism& mechanism) {
  SpanningTreeOptions options;
  for (size_t j = 0; j < mechanism.joints.size(); ++j) {
    for (const Passive& p : mechanism.joints[j].passive) {
      if (p.stiffness == 0 && p.viscous == 0 && p.coulomb == 0) continue;
      options.keep.push_back(static_cast<int>(j));
      break;
    }
  }
  return options;
}

RunnerOptions OptionsOf(const HapticArguments& arguments, const Matrix3d& R_WD,
                        const SafetyOptions& safety) {
  RunnerOptions options;
  options.seconds = arguments.seconds;
  options.record = !arguments.record.empty();
  options.post_mortem = arguments.file.stem().string() + "-fault.csv";
  options.R_WD = R_WD;
  options.safety = safety;
  if (arguments.free_running) options.realtime.reset();
  return options;
}

}  // namespace

int RunHaptic(const HapticArguments& arguments) {
  const HapticSubject subject = ReadSubject(arguments.file, arguments.grasp);
  const KinematicTree tree = BuildKinematicTree(subject.mechanism, KeepSprings(subject.mechanism));
  const VectorXd q = StartPose(tree, arguments.file);
  const GraspFrame grasp = GraspFrameOf(tree, subject.grasp);
  TreeWorkspace<double> ws(tree);
  ForwardKinematics(tree, q.data(), &ws);

  MasterRequest request{arguments.master,
                        arguments.rate,
                        ParseGrip(arguments.grip),
                        DeviceAxes(subject.mechanism),
                        PoseInWorld(ws, grasp.node, grasp.X_BG),
                        subject.law};
  const std::unique_ptr<Master> master = MakeMaster(request);
  master->Configure();
  const Rendering rendering =
      MakeRendering({arguments.coupling, arguments.scale, arguments.stiffness, arguments.inertia},
                    tree, subject.grasp, q, master->info());
  WallClock wall;
  FreeRunningClock free;
  LoopClock* clock = &wall;
  if (arguments.free_running) clock = &free;
  Runner runner(OptionsOf(arguments, request.R_WD, rendering.safety), master.get(),
                rendering.tick.get(), clock);
  if (!arguments.quiet) fmt::print("{}{}", BoundsReport(master->info()), rendering.report);
  RunSummary summary;
  {
    const InterruptScope interrupt(&runner);
    const StatusLine line(runner, arguments.quiet);
    summary = runner.Run();
  }
  if (!arguments.record.empty()) WriteRecording(arguments.record, runner.Kept());
  if (!arguments.quiet) fmt::print("{}{}", summary.FullReport(), rendering.tick->FullReport());
  return summary.status == RunStatus::kFault ? kNoSolution : kSuccess;
}

}  // namespace vmech
