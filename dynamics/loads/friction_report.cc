#include "vmech/dynamics/loads/friction_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/pose/contact_friction.h"
#include "vmech/dynamics/rigid_body/passive.h"

namespace vmech {
namespace {

constexpr double kRounding = 1e-9;  // of the largest force or moment in the mechanism

/// The friction and the lead angle of a screw, in degrees, as words.
std::string AnglesOf(const Joint& screw) {
  constexpr double kDegree = std::numbers::pi / 180;
  const LoadFriction& friction = screw.load_friction;
  return fmt::format("its friction angle is {:.3g} degrees, its lead angle {:.3g}",
                     std::atan(friction.coefficient) / kDegree,
                     std::atan(std::abs(screw.pitch) / friction.radius) / kDegree);
}

void WarnOfJams(const Mechanism& mechanism, LoadStudyResult* result) {
  const LoadArrays& loads = result->poses.arrays();
  const auto is_jammed = [](const PoseState& state) { return state.jammed; };
  const auto jammed = std::count_if(loads.states.begin(), loads.states.end(), is_jammed);
  if (jammed == 0) return;
  const auto first = std::find_if(loads.states.begin(), loads.states.end(), is_jammed);
  std::string where;
  if (first->locking_joint >= 0) {
    const Joint& joint = mechanism.joints[first->locking_joint];
    where = fmt::format(" by joint '{}'", joint.name);
    if (joint.type == JointType::kScrew) where += fmt::format(" ({})", AnglesOf(joint));
  }
  result->warnings.push_back(fmt::format(
      "friction locks the mechanism{} at {} of {} poses, the first at t = {:.6g} s: any force of "
      "the drive presses harder than it moves. There is no equilibrium under the drive; the loads "
      "there are not meaningful",
      where, jammed, result->poses.size(),
      loads.times[static_cast<size_t>(first - loads.states.begin())]));
}

void WarnOfSelfLocking(const Mechanism& mechanism, LoadStudyResult* result) {
  for (const Joint& joint : mechanism.joints) {
    if (!IsSelfLocking(joint)) continue;
    result->warnings.push_back(fmt::format(
        "screw '{}' is self-locking: no axial force turns it ({})", joint.name, AnglesOf(joint)));
  }
  const std::vector<PoseState>& states = result->poses.arrays().states;
  const auto held = std::count_if(states.begin(), states.end(),
                                  [](const PoseState& state) { return state.held_by_friction; });
  if (held == 0) return;
  result->warnings.push_back(
      fmt::format("at {} of {} poses the drive stands still and friction alone holds the "
                  "mechanism: the drive need exert nothing there",
                  held, result->poses.size()));
}

/// The largest that any force is in the study [N], and any moment [N m].
struct LargestLoads {
  double force = 0, moment = 0;
};

LargestLoads FindLargestLoads(const LoadStudyResult& result) {
  LargestLoads largest;
  for (const PoseLoads& pose : result.poses) {
    if (pose.jammed) continue;
    for (const JointSample& joint : pose.joints) {
      largest.force = std::max(largest.force, joint.force.norm());
      largest.moment = std::max(largest.moment, joint.moment.norm());
    }
  }
  return largest;
}

/// The largest loads of one joint that its keys have no formula for.
std::array<UnaccountedLoad, 2> FindUnaccounted(const Joint& joint, size_t index,
                                               const LoadStudyResult& result) {
  std::array<UnaccountedLoad, 2> largest;
  for (const PoseLoads& pose : result.poses) {
    if (pose.jammed) continue;
    const JointSample& sample = pose.joints[index];
    const auto here = UnaccountedLoads(joint, sample, sample.position);
    for (size_t i = 0; i < here.size(); ++i) {
      if (here[i].size > largest[i].size) largest[i] = here[i];
    }
  }
  return largest;
}

void WarnOfUnaccountedLoads(const Mechanism& mechanism, LoadStudyResult* result) {
  if (!HasLoadFriction(mechanism)) return;
  const LargestLoads scale = FindLargestLoads(*result);
  const double length = CharacteristicLength(mechanism);
  for (size_t j = 0; j < mechanism.joints.size(); ++j) {
    const Joint& joint = mechanism.joints[j];
    if (joint.load_friction.coefficient == 0) continue;
    for (const UnaccountedLoad& load : FindUnaccounted(joint, j, *result)) {
      const bool is_force = load.unit != nullptr && std::string_view(load.unit) == "N";
      const double all = is_force ? scale.force : std::max(scale.moment, scale.force * length);
      if (load.size <= kRounding * all) continue;
      const std::string remedy =
          load.key == nullptr ? "it tilts the contact beyond its radius, and the friction counts "
                                "the normal force alone"
                              : fmt::format("give '{}'", load.key);
      result->warnings.push_back(
          fmt::format("joint '{}': its friction does not count the {} of up to {:.4g} {}; {}",
                      joint.name, load.what, load.size, load.unit, remedy));
    }
  }
}

}  // namespace

void AddFrictionWarnings(const Mechanism& mechanism, LoadStudyResult* result) {
  WarnOfJams(mechanism, result);
  WarnOfSelfLocking(mechanism, result);
  WarnOfUnaccountedLoads(mechanism, result);
}

}  // namespace vmech
