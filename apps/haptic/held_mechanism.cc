#include "vmech/apps/haptic/held_mechanism.h"

#include <fmt/format.h>

#include <stdexcept>
#include <string>

#include "vmech/dynamics/in_hand/passive_joints.h"
#include "vmech/hw_interface/audit/recorded_tree.h"
#include "vmech/kinematics/loops/assembled_mechanism.h"
#include "vmech/kinematics/tree/forward_kinematics.h"
#include "vmech/mechanisms/files/document.h"
#include "vmech/mechanisms/plausibility.h"

namespace vmech {
namespace {

/// The mechanism with its loops closed, within its limits.
Mechanism Assembled(const HapticArguments& arguments, Mechanism mechanism) {
  const std::string file = arguments.file.string();
  if (arguments.tolerance) mechanism.tolerance = *arguments.tolerance;
  const AssembledMechanism assembled = AssembleMechanism(mechanism);
  if (!assembled.summary.closed) {
    throw std::runtime_error(fmt::format("{}: {}", file, assembled.summary.message));
  }
  for (const std::string& outside : StartsOutsideLimits(assembled.mechanism)) {
    throw FileErrors(file, outside + "; give start values within the limits");
  }
  if (!arguments.quiet) {
    for (const std::string& note : assembled.Notes()) fmt::print("note: {}\n", note);
    for (const std::string& doubt : DoubtsOf(mechanism)) fmt::print("warning: {}\n", doubt);
  }
  return assembled.mechanism;
}

HapticSubject SubjectOf(const RecordingHeader& header) {
  const RecordedTree recorded(header);
  return {recorded.tree.mechanism, recorded.grasp_indices, {}};
}

}  // namespace

HeldMechanism::HeldMechanism(const HapticArguments& arguments)
    : HeldMechanism(ReadSubject(arguments.file, arguments.grasps, arguments.set), arguments) {}

HeldMechanism::HeldMechanism(const HapticSubject& held, const HapticArguments& arguments)
    : HeldMechanism(held, Assembled(arguments, held.mechanism)) {
  try {
    RefuseUnrenderedFriction(tree);
  } catch (const std::invalid_argument& error) {
    throw FileErrors(arguments.file.string(), error.what());
  }
}

HeldMechanism::HeldMechanism(const RecordingHeader& header) : HeldMechanism(SubjectOf(header)) {}

HeldMechanism::HeldMechanism(const HapticSubject& held) : HeldMechanism(held, held.mechanism) {}

HeldMechanism::HeldMechanism(const HapticSubject& held, const Mechanism& assembled)
    : subject(held),
      tree(BuildKinematicTree(assembled, KeepPassiveJoints(subject.mechanism))),
      q(StartCoordinates(tree)),
      R_WD(DeviceAxes(subject.mechanism)) {
  TreeWorkspace<double> ws(tree);
  ForwardKinematics(tree, q.data(), &ws);
  for (const int index : subject.grasps) {
    const GraspFrame grasp = GraspFrameOf(tree, index);
    X_WG.push_back(PoseInWorld(ws, grasp.node, grasp.X_BG));
  }
}

void HeldMechanism::FitTo(const DeviceInfo& device, std::size_t hand, bool quiet) {
  Grasp& grasp = tree.mechanism.grasps[static_cast<std::size_t>(subject.grasps[hand])];
  if (!ForcesAlone(device) || grasp.kind == GraspKind::kPoint) return;
  grasp.kind = GraspKind::kPoint;
  if (quiet) return;
  fmt::print(
      "note: {} exerts forces and no moments; it holds the mechanism at the point of "
      "grasp {}, which turns as it likes\n",
      device.name, grasp.name);
}

}  // namespace vmech
