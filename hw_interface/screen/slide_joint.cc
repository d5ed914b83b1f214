#include "vmech/hw_interface/screen/slide_joint.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "vmech/kinematics/loops/assembled_mechanism.h"
#include "vmech/kinematics/tree/kinematic_tree.h"
#include "vmech/mechanisms/freedoms.h"

namespace vmech {
namespace {

constexpr double kLargestTurn = 0.05;   // of a step [rad]
constexpr double kLargestShift = 0.02;  // [characteristic lengths]
constexpr double kSmallest = 1e-4;      // of the largest: where halving ends
constexpr double kFarthest = 0.2;       // that another coordinate may move in a step, as above

/// The largest move of any coordinate, angles in radians, shifts in characteristic lengths.
double LargestMove(const KinematicTree& tree, const VectorXd& from, const VectorXd& to) {
  double largest = 0;
  for (const TreeNode& node : tree.nodes) {
    if (node.q < 0) continue;
    const double unit = node.motion == NodeMotion::kPrismatic ? tree.length : 1;
    const int count = node.motion == NodeMotion::kSpherical ? 4 : 1;
    for (int i = node.q; i < node.q + count; ++i) {
      largest = std::max(largest, std::abs(to[i] - from[i]) / unit);
    }
  }
  return largest;
}

}  // namespace

SlideResult SlideJoint(const Mechanism& assembled, int joint, int freedom, double value) {
  const Joint& moved = assembled.joints[joint];
  if (moved.type == JointType::kSpherical) {
    throw std::invalid_argument(fmt::format(
        "joint '{}' is spherical: it has no single coordinate to set; drag a link", moved.name));
  }
  const KinematicTree tree = BuildKinematicTree(assembled, {{joint}, {}, {}});
  const bool turns = FreedomsOfType(moved.type).rotates[freedom];
  const double largest = turns ? kLargestTurn : kLargestShift * tree.length;
  const int at = CoordinateIndex(tree, joint, freedom);
  AssemblyOptions nearby = AssemblyOptions::Nearby();
  nearby.fixed = {VelocityIndex(tree, joint, freedom)};

  const double wanted = std::clamp(value, moved.lower[freedom], moved.upper[freedom]);
  SlideResult result{assembled, wanted != value};
  VectorXd q = StartCoordinates(tree);
  const size_t outside = StartsOutsideLimits(assembled).size();
  for (double step = largest; std::abs(wanted - q[at]) > 0 && step > kSmallest * largest;) {
    VectorXd next = q;
    next[at] += std::clamp(wanted - q[at], -step, step);
    const double move = std::abs(next[at] - q[at]);
    const bool closed = Assemble(tree, nearby, &next).closed;
    Mechanism there = result.mechanism;
    if (closed) SetStarts(tree, next, &there);
    const bool jumps = LargestMove(tree, q, next) > kFarthest;
    if (closed && !jumps && StartsOutsideLimits(there).size() <= outside && move > 0) {
      q = next;
      result.mechanism = std::move(there);
    } else {
      step /= 2;
      if (step <= kSmallest * largest) result.stopped = true;
    }
  }
  return result;
}

}  // namespace vmech
