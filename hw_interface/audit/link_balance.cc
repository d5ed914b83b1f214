#include "vmech/hw_interface/audit/link_balance.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "vmech/base/screw_algebra.h"
#include "vmech/mechanisms/freedoms.h"

namespace vmech {
namespace {

constexpr double kLeastForce = 1e-3;  // [N], of which shares are told

/// Forces, and moments over a length.
double Size(const Screw& W, double length) {
  return std::max(Length(W.linear), Length(W.angular) / length);
}

bool HasLimits(const Joint& joint) {
  const auto finite = [](double x) { return std::isfinite(x); };
  return std::any_of(joint.lower.begin(), joint.lower.end(), finite) ||
         std::any_of(joint.upper.begin(), joint.upper.end(), finite);
}

/// Nothing acts along its freedoms but what the constraints do.
bool IsBare(const Joint& joint) {
  return std::none_of(joint.passive.begin(), joint.passive.end(),
                      [](const Passive& passive) { return HasPassive(passive); }) &&
         !HasLimits(joint);
}

}  // namespace

LinkBalance::LinkBalance(const KinematicTree& tree, double period)
    : tree_(tree),
      period_(period),
      net_(tree.nodes.size() + 1),
      wrenches_(tree.mechanism.joints.size()) {}

/// Along the freedoms of a cut joint, which the tree does not have.
double LinkBalance::AlongCutFreedoms(int j, const Wrenchd& w) const {
  const Joint& joint = tree_.mechanism.joints[j];
  if (joint.type == JointType::kScrew) {
    return std::abs(joint.pitch * w.force.z() + w.moment.z()) / tree_.length;
  }
  if (joint.type == JointType::kUniversal) return 0;
  double most = 0;
  const std::array<bool, 6>& free_axes = FreedomsOfType(joint.type).free;
  for (int i = 0; i < 3; ++i) {
    if (free_axes[i]) most = std::max(most, std::abs(w.force[i]));
    if (free_axes[3 + i]) most = std::max(most, std::abs(w.moment[i]) / tree_.length);
  }
  return most;
}

void LinkBalance::TakeJoints(const AuditedPose& at, const std::vector<Wrenchd>& joints,
                             const VectorXd& v) {
  std::fill(net_.begin(), net_.end(), Screw{});
  double most = 0;
  joint_work_ = constraint_work_ = corrected_ = moved_ = 0;
  for (size_t j = 0; j < wrenches_.size(); ++j) {
    wrenches_[j] = WrenchFrom(at.joints[j].F, joints[j]);
    largest_ = std::max(largest_, Size(wrenches_[j], tree_.length));
    const JointPlacement& place = tree_.placements[j];
    net_[place.second_node + 1] += wrenches_[j];
    net_[place.first_node + 1] -= wrenches_[j];
    const Screw& V = at.ws.nodes[static_cast<size_t>(place.second_node + 1)].V;
    moved_ += period_ * (joints[j].force.norm() * Length(VelocityAt(at.joints[j].F.p, V)) +
                         joints[j].moment.norm() * Length(V.angular));
    if (place.tree_node >= 0) continue;
    const double along = AlongCutFreedoms(static_cast<int>(j), joints[j]);
    most = std::max(most, along);
    constraint_work_ += period_ * along;
  }
  for (const TreeNode& node : tree_.nodes) {
    if (node.v < 0) continue;
    const double sign = node.reversed ? -1 : 1;
    const bool bare = IsBare(tree_.mechanism.joints[node.joint]);
    for (int i = 0; i < VelocitiesOf(node.motion); ++i) {
      const double along = sign * Power(wrenches_[node.joint], at.ws.S[node.v + i]);
      const double work = period_ * along * v[node.v + i];
      joint_work_ += work;
      if (!bare) continue;
      const bool slides = node.motion == NodeMotion::kPrismatic;
      most = std::max(most, std::abs(along) / (slides ? 1 : tree_.length));
      constraint_work_ += std::abs(work);
    }
  }
  along_ = most / std::max(largest_, kLeastForce);
}

void LinkBalance::TakeHand(int node, const Vector3d& p_WGo, const Vector6d& w) {
  const Vector3d p_Go = p_WGo - tree_.reference;
  net_[node + 1] += WrenchAt(Double4Of(p_Go), Double4Of(w.head<3>()), Double4Of(w.tail<3>()));
}

Screw LinkBalance::WeightOf(const AuditedPose& at, size_t node) const {
  const ScrewInertia& body = at.inertias.bodies[node + 1];
  const Double4 g = Double4Of(tree_.mechanism.gravity_W);
  return {body.mass * g, Cross(body.moment, g)};
}

double LinkBalance::OffInStep(const AuditedPose& before, const AuditedPose& now) {
  double most = 0;
  for (size_t i = 0; i < tree_.nodes.size(); ++i) {
    const Screw weight = WeightOf(before, i);
    const Screw rate = (1 / period_) * (now.momenta[i + 1] - before.momenta[i + 1]);
    const Screw open = rate - net_[i + 1] - weight;
    most = std::max(most, Size(open, tree_.length));
    const Screw& V = now.ws.nodes[i + 1].V;
    corrected_ += period_ * Power(open, V);
    const ScrewInertia& body = now.inertias.bodies[i + 1];
    if (!(body.mass > 0)) continue;
    const Double4 p_cm = (1 / body.mass) * body.moment;
    moved_ += period_ * Length(weight.linear) * Length(VelocityAt(p_cm, V));
    largest_ = std::max(largest_, Size(weight, tree_.length));
  }
  return most / std::max(largest_, kLeastForce);
}

double LinkBalance::OffAt(const AuditedPose& at, int held) {
  double most = 0;
  for (size_t i = 0; i < tree_.nodes.size(); ++i) {
    const Screw weight = WeightOf(at, i);
    largest_ = std::max(largest_, Size(weight, tree_.length));
    if (static_cast<int>(i) == held) continue;
    most = std::max(most, Size(at.needed[i + 1] - net_[i + 1] - weight, tree_.length));
  }
  return most / std::max(largest_, kLeastForce);
}

}  // namespace vmech
