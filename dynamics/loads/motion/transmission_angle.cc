#include "vmech/dynamics/loads/motion/transmission_angle.h"

#include <array>
#include <cmath>

namespace vmech {
namespace {

constexpr double kParallel = 1e-6;   // [rad]
constexpr double kRounding = 1e-12;  // [rad]: what turns of a cycle differ by

/// The joints of the loop in their order: ground - input - coupler - output - ground.
struct FourJoints {
  std::array<int, 4> joints;
  int input, coupler, output;
};

bool Joins(const Joint& joint, int link) {
  return joint.first.link == link || joint.second.link == link;
}

int OtherLink(const Joint& joint, int link) {
  return joint.first.link == link ? joint.second.link : joint.first.link;
}

/// The joint of a link that is not the given one; -1 where there is not exactly one.
int NextJoint(const Mechanism& mechanism, int link, int joint) {
  int next = -1;
  for (int j = 0; j < static_cast<int>(mechanism.joints.size()); ++j) {
    if (j == joint || !Joins(mechanism.joints[j], link)) continue;
    if (next >= 0) return -1;
    next = j;
  }
  return next;
}

std::optional<FourJoints> FindLoop(const LoadStudy& study) {
  const Mechanism& mechanism = study.mechanism;
  if (mechanism.joints.size() != 4 || mechanism.links.size() != 4 || study.drives.size() != 1) {
    return {};
  }
  for (const Joint& joint : mechanism.joints) {
    if (joint.type != JointType::kRevolute && joint.type != JointType::kPrismatic) return {};
  }
  FourJoints loop{};
  std::array<int, 4> links{};  // behind each joint
  int joint = study.drives[0].joint, link = mechanism.ground;
  if (!Joins(mechanism.joints[joint], link)) return {};
  for (size_t i = 0; i < 4; ++i) {
    loop.joints[i] = joint;
    links[i] = link = OtherLink(mechanism.joints[joint], link);
    if (i < 3 && link == mechanism.ground) return {};
    joint = NextJoint(mechanism, link, joint);
    if (joint < 0) return {};
  }
  loop.input = links[0], loop.coupler = links[1], loop.output = links[2];
  return links[3] == mechanism.ground ? std::optional(loop) : std::nullopt;
}

/// The first anchor of a joint in the world.
Posed AnchorInWorld(const Mechanism& mechanism, const PoseLoads& pose, int joint) {
  const AnchorId id = mechanism.joints[joint].first;
  return pose.links[id.link].X_WL * mechanism.anchor(id).X_LA;
}

/// The loop at one pose.
PlanarLoop<double> LoopAt(const Mechanism& mechanism, const FourJoints& loop,
                          const PoseLoads& pose) {
  PlanarLoop<double> at;
  for (size_t i = 0; i < 4; ++i) {
    const Posed X = AnchorInWorld(mechanism, pose, loop.joints[i]);
    at.points[i] = X.p;
    at.axes[i] = X.R.col(2);
    at.turns[i] = mechanism.joints[loop.joints[i]].type == JointType::kRevolute;
  }
  return at;
}

bool IsPlanar(const PlanarLoop<double>& loop) {
  if (!loop.turns[1] && !loop.turns[2]) return false;
  const Vector3d normal = loop.axes[loop.turns[2] ? 2 : 1];
  for (size_t i = 0; i < 4; ++i) {
    const double off = loop.turns[i] ? loop.axes[i].cross(normal).norm() : loop.axes[i].dot(normal);
    if (std::abs(off) > kParallel) return false;
  }
  return true;
}

}  // namespace

std::optional<TransmissionAngle> FindTransmissionAngle(const LoadStudy& study,
                                                       const LoadStudyResult& result) {
  const Mechanism& mechanism = study.mechanism;
  const std::optional<FourJoints> loop = FindLoop(study);
  if (!loop || result.poses.empty() || result.poses.front().links.size() != 4) return {};
  if (!IsPlanar(LoopAt(mechanism, *loop, result.poses.front()))) return {};
  const auto slides = [&](size_t i) {
    return mechanism.joints[loop->joints[i]].type == JointType::kPrismatic;
  };
  TransmissionAngle found{
      loop->joints,           loop->input, loop->coupler, loop->output, slides(3),
      slides(1) || slides(2), {}};
  for (const PoseLoads& pose : result.poses) {
    found.angles.push_back(LoopAt(mechanism, *loop, pose).TransmissionAngle());
    const double least = found.angles[found.least_pose];
    if (found.angles.back() < least - kRounding || std::isnan(least)) {
      found.least_pose = found.angles.size() - 1;
    }
  }
  return found;
}

}  // namespace vmech
