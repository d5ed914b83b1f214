#include "vmech/dynamics/loads/rule_dependence.h"

#include <algorithm>
#include <cmath>

#include "vmech/base/lanes4.h"
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

/// The motion as the weights of the model's hand make it.
Motion LedByHand(const LoadModel& model, Motion motion) {
  if (!model.hand) return motion;
  InverseKinematics hand(
      model.tree, GraspFrameOf(model.tree, model.hand->grasp),
      InverseKinematicsOptions{.stiffness = model.hand_stiffness, .joint_limits = false});
  for (size_t i = 0; i < motion.size(); ++i) {
    hand.SetTarget(motion.hand[i].X_WH);
    const Summary summary = Solve(hand, NullspaceOptions(), motion.q(i));
    std::copy(summary.x.begin(), summary.x.end(), motion.coordinates.begin() + i * model.tree.nq);
  }
  return motion;
}

/// A model with its motion.
struct Choice {
  LoadModel model;
  Motion motion;
};

std::vector<Choice> OtherChoices(const LoadModel& model, const Motion& motion) {
  std::vector<Choice> others;
  for (int choice = 1; choice <= kChoices; ++choice) {
    LoadModel other = WithOtherChoices(model, choice);
    Motion led = LedByHand(other, motion);
    others.push_back({std::move(other), std::move(led)});
  }
  return others;
}

/// Marks what differs between two solutions for one pose.
template <typename T>
void Compare(const LoadModel& model, const LoadWorkspace<T>& a, const LoadWorkspace<T>& b,
             RuleDependence* result) {
  using std::abs, std::max, std::sqrt;
  const double changed = std::max(kChanged, TouchOfRounding(model.rounding));
  const auto size = [](const Vector3<T>& vector) { return sqrt(vector.squaredNorm()); };
  T force = size(a.hand.force);
  for (const auto& load : a.loads) force = max(force, size(load.W_F.force));
  T moment = force * T(model.tree.length);
  for (const auto& load : a.loads) moment = max(moment, size(load.W_F.moment));
  for (size_t j = 0; j < a.loads.size(); ++j) {
    const Wrench<T> change = b.loads[j].W_F - a.loads[j].W_F;
    for (int k = 0; k < 3; ++k) {
      if (!AllLanes(abs(change.force[k]) <= changed * force)) result->joints[j][k] = true;
      if (!AllLanes(abs(change.moment[k]) <= changed * moment)) result->joints[j][3 + k] = true;
    }
  }
  for (size_t k = 0; k < result->drives.size(); ++k) {
    const T change = abs(b.drive_forces[k] - a.drive_forces[k]);
    const Joint& joint = model.tree.mechanism.joints[model.drives[k].joint];
    const bool turns = FreedomsOfType(joint.type).rotates[model.drives[k].freedom];
    if (!AllLanes(change <= changed * (turns ? moment : force))) result->drives[k] = true;
  }
}

/// Finds the loads of as many poses at once as T has lanes, as chosen and otherwise.
template <typename T>
class Comparison {
 public:
  Comparison(const LoadModel& model, const Motion& motion, const std::vector<Choice>& others)
      : model_(model), motion_(motion), others_(others), as_chosen_(model) {
    for (const Choice& other : others) otherwise_.emplace_back(other.model);
  }

  /// False if the poses cannot be evaluated, at least not at once.
  bool At(size_t pose, RuleDependence* result) {
    if (!EvaluatePoseLoads(model_, motion_, pose, &as_chosen_)) return false;
    for (size_t i = 0; !as_chosen_.jammed && i < others_.size(); ++i) {
      const Choice& other = others_[i];
      LoadWorkspace<T>& ws = otherwise_[i];
      if (!EvaluatePoseLoads(other.model, other.motion, pose, &ws) || ws.jammed) continue;
      Compare(model_, as_chosen_, ws, result);
    }
    return true;
  }

 private:
  const LoadModel& model_;
  const Motion& motion_;
  const std::vector<Choice>& others_;
  LoadWorkspace<T> as_chosen_;
  std::vector<LoadWorkspace<T>> otherwise_;
};

}  // namespace

RuleDependence FindRuleDependence(const PreparedStudy& prepared, const Motion& motion,
                                  const std::vector<size_t>& poses) {
  const LoadModel& model = prepared.model;
  RuleDependence result;
  result.joints.resize(model.tree.mechanism.joints.size());
  result.drives.resize(model.drives.size());
  const Motion judged = PartOf(motion, poses);
  const std::vector<Choice> others = OtherChoices(model, judged);
  Comparison<double> one(model, judged, others);
  Comparison<Lanes4> four(model, judged, others);
  for (size_t i = 0; i < poses.size();) {
    const bool at_once = RunsInLanes(model) && i + Lanes4::kLanes <= poses.size();
    if (at_once && four.At(i, &result)) {
      i += Lanes4::kLanes;
    } else {
      one.At(i++, &result);
    }
  }
  return result;
}

}  // namespace vmech
