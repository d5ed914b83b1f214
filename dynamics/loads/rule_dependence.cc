#include "vmech/dynamics/loads/rule_dependence.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "vmech/dynamics/loads/pose/pose_loads.h"
#include "vmech/kinematics/inverse/inverse_kinematics.h"
#include "vmech/mechanisms/freedoms.h"
#include "vmech/solvers/nullspace.h"

namespace vmech {
namespace {

constexpr int kChoices = 4;
constexpr double kDecades = 1.5;    // that a stiffness or a weight is changed by, up or down
constexpr double kChanged = 2e-10;  // of the largest load

/// Positive numbers around 1, spread evenly by the golden ratio; the same every time.
class Factors {
 public:
  /// Another part of the sequence for every choice.
  Factors(int count, int choice) : next_(1 + count * choice) {}
  double Next() {
    constexpr double kGolden = 0.6180339887498949;
    const double turns = kGolden * next_++;
    return std::pow(10, kDecades * (2 * (turns - std::floor(turns)) - 1));
  }

 private:
  int next_;
};

/// The same model with other stiffnesses of all joints and other weights of the hand.
LoadModel WithOtherChoices(const LoadModel& model, int choice) {
  LoadModel other = model;
  Factors factors(static_cast<int>(6 * model.compliances.size()) + 6, choice);
  for (JointCompliance& compliance : other.compliances) {
    for (double& force : compliance.force) force *= factors.Next();
    for (double& moment : compliance.moment) moment *= factors.Next();
  }
  for (double& weight : other.hand_stiffness) weight *= factors.Next();
  return other;
}

/// Poses of a motion, as other weights of the hand make them.
class OtherMotion {
 public:
  explicit OtherMotion(const LoadModel& model) : model_(model) {
    if (!model.hand) return;
    hand_.emplace(
        model.tree, GraspFrameOf(model.tree, model.hand->grasp),
        InverseKinematicsOptions{.stiffness = model.hand_stiffness, .joint_limits = false});
  }

  /// One pose, from that of the motion.
  Motion At(const Motion& motion, size_t pose) {
    const auto part = [pose](const auto& list, size_t each) {
      return std::vector(list.begin() + pose * each, list.begin() + (pose + 1) * each);
    };
    const size_t loops = model_.tree.loops.size();
    Motion one{part(motion.times, 1),
               part(motion.coordinates, model_.tree.nq),
               part(motion.drives, model_.drives.size()),
               {},
               part(motion.cut_positions, loops),
               motion.speed};
    if (!hand_) return one;
    one.hand = part(motion.hand, 1);
    hand_->SetTarget(one.hand[0].X_WH);
    const Summary summary = Solve(*hand_, NullspaceOptions(), motion.q(pose));
    one.coordinates.assign(summary.x.begin(), summary.x.end());
    return one;
  }

 private:
  const LoadModel& model_;
  std::optional<InverseKinematics> hand_;
};

void Compare(const LoadModel& model, const LoadWorkspace<double>& a, const LoadWorkspace<double>& b,
             RuleDependence* result) {
  const double changed = std::max(kChanged, TouchOfRounding(model.rounding));
  double force = a.hand.force.norm();
  for (const auto& load : a.loads) force = std::max(force, load.W_F.force.norm());
  double moment = force * model.tree.length;
  for (const auto& load : a.loads) moment = std::max(moment, load.W_F.moment.norm());
  for (size_t j = 0; j < a.loads.size(); ++j) {
    const Wrenchd change = b.loads[j].W_F - a.loads[j].W_F;
    for (int k = 0; k < 3; ++k) {
      if (!(std::abs(change.force[k]) <= changed * force)) result->joints[j][k] = true;
      if (!(std::abs(change.moment[k]) <= changed * moment)) result->joints[j][3 + k] = true;
    }
  }
  for (size_t k = 0; k < result->drives.size(); ++k) {
    const double change = std::abs(b.drive_forces[k] - a.drive_forces[k]);
    const Joint& joint = model.tree.mechanism.joints[model.drives[k].joint];
    const bool turns = FreedomsOfType(joint.type).rotates[model.drives[k].freedom];
    if (!(change <= changed * (turns ? moment : force))) result->drives[k] = true;
  }
}

}  // namespace

RuleDependence FindRuleDependence(const PreparedStudy& prepared, const Motion& motion,
                                  const std::vector<size_t>& poses) {
  const LoadModel& model = prepared.model;
  RuleDependence result;
  result.joints.resize(model.tree.mechanism.joints.size());
  result.drives.resize(model.drives.size());
  LoadWorkspace<double> as_chosen(model);
  for (int choice = 1; choice <= kChoices; ++choice) {
    const LoadModel other = WithOtherChoices(model, choice);
    LoadWorkspace<double> ws(other);
    OtherMotion other_motion(other);
    for (const size_t pose : poses) {
      if (!EvaluatePoseLoads(model, motion, pose, &as_chosen) || as_chosen.jammed) continue;
      if (!EvaluatePoseLoads(other, other_motion.At(motion, pose), 0, &ws) || ws.jammed) continue;
      Compare(model, as_chosen, ws, &result);
    }
  }
  return result;
}

}  // namespace vmech
