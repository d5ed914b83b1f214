#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "vmech/apps/commands.h"
#include "vmech/apps/console/option_error.h"
#include "vmech/apps/files/inputs_apart.h"
#include "vmech/apps/haptic/handle_home.h"
#include "vmech/apps/haptic/hold_mechanism.h"

namespace vmech {
namespace {

WorkspaceOptions WorkspaceOf(const HapticArguments& arguments) {
  WorkspaceOptions workspace;
  workspace.motion_scale = arguments.motion_scale;
  workspace.clutch = arguments.clutch - 1;
  workspace.known = ParseHandle(arguments.handle);
  return workspace;
}

/// A grasp for every device.
void RequireGraspsForMasters(const HapticArguments& arguments) {
  const std::size_t hands = arguments.masters.size();
  const bool named = arguments.grasps.size() == hands || (hands == 1 && arguments.grasps.empty());
  if (!named) {
    throw OptionError(fmt::format("--grasp: {} given for {} device{}; give one for each --master",
                                  arguments.grasps.size(), hands, hands == 1 ? "" : "s"));
  }
  if (arguments.grips.size() > hands) {
    throw OptionError(fmt::format("--grip: {} given for {} device{}; give one for each --master",
                                  arguments.grips.size(), hands, hands == 1 ? "" : "s"));
  }
}

/// What the virtual coupling does not know is not passed over in silence.
void RequireOptionsOfCoupling(const HapticArguments& arguments) {
  if (arguments.coupling == "paper") return;
  const HapticArguments plain;
  const std::pair<const char*, bool> of_the_paper[] = {
      {"--stiffness", arguments.stiffness != plain.stiffness},
      {"--inertia", arguments.inertia != plain.inertia},
      {"--contact", arguments.contact != plain.contact},
      {"--estimator", arguments.estimator != plain.estimator},
      {"--wrench", arguments.wrench != plain.wrench}};
  for (const auto& [option, given] : of_the_paper) {
    if (!given) continue;
    throw OptionError(fmt::format(
        "{}: counts in the paper's way alone; add --coupling paper, or leave it out", option));
  }
}

/// What the scaled motion makes of a device's force is one that a filter can hold.
void RequireBearable(const DeviceInfo& device) {
  constexpr double kMost = 1e4;  // [N], of SafetyOptions
  if (device.linear.peak <= kMost) return;
  throw OptionError(
      fmt::format("--motion-scale: makes {:.4g} N of the largest force of {}, more than {:g} N; "
                  "give a larger one",
                  device.linear.peak, device.name, kMost));
}

/// Nothing is written over what a session reads.
void RequireRecordApart(const HapticArguments& arguments) {
  if (arguments.record.empty()) return;
  constexpr std::string_view kReplay = "replay:";
  std::vector<std::filesystem::path> inputs{arguments.file};
  for (const std::string& master : arguments.masters) {
    if (master.starts_with(kReplay)) inputs.emplace_back(master.substr(kReplay.size()));
  }
  RequireOutputsApart(inputs, {arguments.record});
}

}  // namespace

int RunHaptic(const HapticArguments& arguments) {
  RequireRecordApart(arguments);
  RequireGraspsForMasters(arguments);
  RequireOptionsOfCoupling(arguments);
  const WorkspaceOptions workspace = WorkspaceOf(arguments);
  HeldMechanism held(arguments);
  const std::unique_ptr<LoopClock> clock = ClockOf(arguments);
  Masters masters;
  for (std::size_t i = 0; i < arguments.masters.size(); ++i) {
    const std::string& grip = arguments.grips[std::min(i, arguments.grips.size() - 1)];
    std::unique_ptr<Master> master =
        MakeMaster({arguments.masters[i], arguments.rate, ParseGrip(grip), held.R_WD, held.X_WG[i],
                    i == 0 ? held.subject.law : std::nullopt, held.subject.end, arguments.gripper,
                    static_cast<unsigned>(i + 1)});
    master->Configure();
    if (!arguments.home.empty()) {
      BringHome(master.get(), clock.get(), Vector3d(arguments.home.data()));
    }
    masters.push_back(InWorkspace(workspace, std::move(master)));
    RequireBearable(masters.back()->info());
    held.FitTo(masters.back()->info(), i, arguments.quiet);
  }
  return HoldMechanism(held, arguments, masters, clock.get());
}

}  // namespace vmech
