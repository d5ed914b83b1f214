#include "vmech/dynamics/in_hand/passive_joints.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "vmech/dynamics/loads/pose/contact_friction.h"

namespace vmech {
namespace {

/// A limit's stiffness over what it has to hold.
constexpr double kHardLimit = 1e4;
constexpr double kNoLimit = std::numeric_limits<double>::infinity();

}  // namespace

PassiveJoints::PassiveJoints(const KinematicTree& tree) {
  RefuseUnrenderedFriction(tree);
  for (size_t i = 0; i < tree.nodes.size(); ++i) {
    const TreeNode& node = tree.nodes[i];
    if (node.v < 0 || node.motion == NodeMotion::kSpherical) continue;
    const Joint& joint = tree.mechanism.joints[node.joint];
    const bool alone = joint.type == JointType::kUniversal;  // two pins, each slides for itself
    const Freedom freedom{static_cast<int>(i),
                          node.q,
                          node.v,
                          joint.passive[node.freedom],
                          joint.lower[node.freedom],
                          joint.upper[node.freedom],
                          3 * node.joint + (alone ? node.freedom : 0)};
    if (HasPassive(freedom.passive) || freedom.lower > -kNoLimit || freedom.upper < kNoLimit) {
      freedoms_.push_back(freedom);
    }
  }
}

void PassiveJoints::Take(const HeldDesign& design) noexcept {
  for (Freedom& freedom : freedoms_) {
    const HeldDesign::FreedomNumbers& numbers = design.freedoms[static_cast<size_t>(freedom.node)];
    freedom.passive = numbers.passive;
    freedom.lower = numbers.lower;
    freedom.upper = numbers.upper;
  }
}

template <typename Visit>
void PassiveJoints::ForEachDamper(const VectorXd& v, const Visit& visit) const noexcept {
  for (size_t first = 0, end = 0; first < freedoms_.size(); first = end) {
    double square = 0;
    for (; end < freedoms_.size() && freedoms_[end].contact == freedoms_[first].contact; ++end) {
      const double power = freedoms_[end].passive.coulomb * v[freedoms_[end].v];
      square += power * power;
    }
    const double power = std::sqrt(square);
    for (size_t i = first; i < end; ++i) {
      const Passive& passive = freedoms_[i].passive;
      const double dry = FrictionDamping(passive.coulomb, power, kSlowSliding);
      visit(freedoms_[i], passive.viscous + dry);
    }
  }
}

void PassiveJoints::AddTo(const VectorXd& q, const VectorXd& v, double step, MatrixXd* A,
                          VectorXd* right) const noexcept {
  ForEachDamper(v, [&](const Freedom& f, double damping) {
    (*A)(f.v, f.v) += step * f.passive.stiffness + damping;
    (*right)[f.v] -= f.passive.stiffness * (q[f.q] - f.passive.rest);
  });
}

void PassiveJoints::AddForces(const VectorXd& q, const VectorXd& v, VectorXd* tau) const noexcept {
  ForEachDamper(v, [&](const Freedom& f, double damping) {
    (*tau)[f.v] += f.passive.stiffness * (q[f.q] - f.passive.rest) + damping * v[f.v];
  });
}

double PassiveJoints::Energy(const VectorXd& q) const noexcept {
  double energy = 0;
  for (const Freedom& f : freedoms_) {
    const double length = q[f.q] - f.passive.rest;
    energy += 0.5 * f.passive.stiffness * length * length;
  }
  return energy;
}

void PassiveJoints::AddLimits(const VectorXd& q, double step, MatrixXd* A,
                              VectorXd* right) const noexcept {
  for (const Freedom& f : freedoms_) {
    if (f.held == 0) continue;
    const double hold = kHardLimit * (*A)(f.v, f.v);
    (*A)(f.v, f.v) += hold;
    (*right)[f.v] += hold * ((f.held > 0 ? f.upper : f.lower) - q[f.q]) / step;
  }
}

bool PassiveJoints::ChangeLimits(const VectorXd& q, const VectorXd& next_v, double step) noexcept {
  bool changed = false;
  at_limit_ = false;
  for (Freedom& f : freedoms_) {
    const double end = q[f.q] + step * next_v[f.v];
    const double above = end - f.upper, below = f.lower - end;
    // A limit that holds is passed a little: it pulls where it is not.
    if (f.held != 0) {
      if ((f.held > 0 ? above : below) < 0) {
        f.held = 0;
        changed = true;
      }
    } else if (above > 0 || below > 0) {
      f.held = above > 0 ? 1 : -1;
      changed = true;
    }
    at_limit_ |= f.held != 0;
  }
  return changed;
}

SpanningTreeOptions KeepPassiveJoints(const Mechanism& mechanism) {
  SpanningTreeOptions options;
  for (size_t j = 0; j < mechanism.joints.size(); ++j) {
    const Joint& joint = mechanism.joints[j];
    const auto limited = [](const std::vector<double>& limits) {
      return std::any_of(limits.begin(), limits.end(),
                         [](double limit) { return std::isfinite(limit); });
    };
    if (std::any_of(joint.passive.begin(), joint.passive.end(), HasPassive)) {
      options.keep.push_back(static_cast<int>(j));
    } else if (limited(joint.lower) || limited(joint.upper)) {
      options.prefer.push_back(static_cast<int>(j));
    }
  }
  return options;
}

void RefuseUnrenderedFriction(const KinematicTree& tree) {
  for (const Joint& joint : tree.mechanism.joints) {
    if (joint.load_friction.coefficient == 0) continue;
    throw std::invalid_argument(fmt::format(
        "joint '{}': friction in proportion to the load is not rendered to a hand; give "
        "it `coulomb` or `viscous` friction",
        joint.name));
  }
  for (const Loop& loop : tree.loops) {
    const Joint& joint = tree.mechanism.joints[loop.joint];
    if (std::none_of(joint.passive.begin(), joint.passive.end(), HasPassive)) continue;
    throw std::invalid_argument(
        fmt::format("joint '{}' is cut, but has a spring or friction; name another joint in `cuts`",
                    joint.name));
  }
}

}  // namespace vmech
