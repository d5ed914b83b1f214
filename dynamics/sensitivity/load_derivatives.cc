#include "vmech/dynamics/sensitivity/load_derivatives.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "vmech/base/dual.h"
#include "vmech/base/lanes4.h"
#include "vmech/base/screw_algebra.h"
#include "vmech/dynamics/loads/load_arrays.h"
#include "vmech/dynamics/loads/pose/pose_loads.h"
#include "vmech/dynamics/loads/pose/resting_friction.h"

namespace vmech {
namespace {

/// What a loop is left open by, of what closing it has to move: more than rounding.
constexpr double kOpens = 1e-7;

Dual LaneOf(const Dual& number, int /*lane*/) {
  return number;
}
Dual LaneOf(const Dual4& number, int lane) {
  return {number.value[lane], number.slope[lane]};
}

/// values[0..count) of lane l to row + l * stride.
template <typename T>
void StoreDuals(const T* values, size_t count, Dual* row, size_t stride) {
  for (int lane = 0; lane < kLanesOf<T>; ++lane) {
    for (size_t k = 0; k < count; ++k) row[lane * stride + k] = LaneOf(values[k], lane);
  }
}

/// Evaluates the poses of a study on duals.
class Differentiation {
 public:
  Differentiation(const LoadModel& model, const Motion& motion, const StudyChange& change)
      : model_(model), motion_(motion), change_(change) {
    for (const auto& link : change.design.links) {
      for (const Pose<Dual>& X : link.X_LA) {
        for (const Dual& p : X.p) size_ = std::max(size_, std::abs(p.slope));
      }
    }
    result_.pose_numbers = change.pose_numbers;
    result_.first_freedom = {0};
    for (int freedoms : FreedomsOfJoints(model.tree.mechanism)) {
      result_.first_freedom.push_back(result_.first_freedom.back() + freedoms);
    }
    for (size_t i = 0; i < motion.size(); ++i) {
      result_.times.emplace_back(motion.times[i], change.prescribed.times[i]);
    }
    result_.wrenches.resize(motion.size() * 6 * joints());
    result_.drive_forces.resize(motion.size() * model.drives.size());
    result_.rates.resize(motion.size() * freedoms());
    result_.ground_forces.resize(motion.size() * 3);
    result_.axes.resize(motion.size() * 6 * joints());
    result_.grasps.resize(motion.size() * 3 * model.tree.mechanism.grasps.size());
  }

  LoadDerivatives Run() {
    LoadWorkspace<Dual> one = MakeWorkspace<Dual>();
    LoadWorkspace<Dual4> four = MakeWorkspace<Dual4>();
    const size_t poses = motion_.size();
    for (size_t i = 0; i < poses;) {
      // The last packet reaches back to poses that were there before.
      const size_t at = std::min(i, poses - std::min<size_t>(poses, Dual4Lanes()));
      if (RunsInLanes(model_) && poses >= Dual4Lanes() && Evaluate(at, &four)) {
        i = at + Dual4Lanes();
      } else if (Evaluate(i, &one)) {
        ++i;
      } else {
        Refuse(i);
      }
    }
    return std::move(result_);
  }

 private:
  static constexpr size_t Dual4Lanes() { return kLanesOf<Dual4>; }
  size_t joints() const { return model_.tree.mechanism.joints.size(); }
  size_t freedoms() const { return static_cast<size_t>(result_.first_freedom.back()); }

  template <typename T>
  LoadWorkspace<T> MakeWorkspace() const {
    LoadWorkspace<T> ws(model_, change_.design.cast<T>());
    ws.slopes = &change_.prescribed;
    return ws;
  }

  template <typename T>
  bool Evaluate(size_t pose, LoadWorkspace<T>* ws) {
    if (!EvaluatePoseLoads(model_, motion_, pose, ws)) return false;
    if (ws->jammed) {
      throw std::runtime_error(fmt::format(
          "pose {} (t = {:.6g} s): friction locks the mechanism, and its loads have no derivative",
          result_.pose_number(pose), motion_.times[pose]));
    }
    RequireClosed(pose, *ws);
    Store(pose, *ws);
    return true;
  }

  template <typename T>
  void RequireClosed(size_t pose, const LoadWorkspace<T>& ws) const {
    // What changes all sizes alike moves no loop but in the rounding of its slopes.
    const double moved = std::max(ws.closing.slope, size_ / model_.tree.length);
    if (ws.opening.slope <= std::max(kOpens * moved, change_.rounding)) return;
    throw std::runtime_error(
        fmt::format("the loop that is cut at '{}' cannot stay closed when this changes (pose {}, t "
                    "= {:.6g} s): "
                    "the mechanism moves, or can be assembled, for this value alone",
                    model_.tree.mechanism.joints[model_.tree.loops[ws.opening.loop].joint].name,
                    result_.pose_number(pose), motion_.times[pose]));
  }

  template <typename T>
  void Store(size_t pose, const LoadWorkspace<T>& ws) {
    const size_t drives = model_.drives.size();
    StoreDuals(ws.drive_forces.data(), drives, result_.drive_forces.data() + drives * pose, drives);
    for (size_t j = 0; j < joints(); ++j) {
      const JointLoad<T>& load = ws.loads[j];
      const auto first = static_cast<size_t>(result_.first_freedom[j]);
      const size_t count = static_cast<size_t>(result_.first_freedom[j + 1]) - first;
      StoreDuals(load.W_F.Stacked().data(), 6, &result_.wrenches[6 * (joints() * pose + j)],
                 6 * joints());
      StoreDuals(AxisOf(ws, j).data(), 6, &result_.axes[6 * (joints() * pose + j)], 6 * joints());
      StoreDuals(load.rate.data(), count, result_.rates.data() + freedoms() * pose + first,
                 freedoms());
    }
    StoreDuals(GroundForce(ws).data(), 3, &result_.ground_forces[3 * pose], 3);
    const std::vector<Grasp>& grasps = model_.tree.mechanism.grasps;
    for (size_t g = 0; g < grasps.size(); ++g) {
      StoreDuals(OriginOf(g, ws).data(), 3, &result_.grasps[3 * (grasps.size() * pose + g)],
                 3 * grasps.size());
    }
  }

  template <typename T>
  Vector3<T> GroundForce(const LoadWorkspace<T>& ws) const {
    const Mechanism& mechanism = model_.tree.mechanism;
    Vector3<T> force = Vector3<T>::Zero();
    for (size_t j = 0; j < joints(); ++j) {
      const Vector3<T> on_second = Vector3Of(ws.joints[j].W.linear);
      if (mechanism.joints[j].first.link == mechanism.ground) force += on_second;
      if (mechanism.joints[j].second.link == mechanism.ground) force -= on_second;
    }
    return force;
  }

  /// Where a joint is, and its z axis.
  template <typename T>
  Eigen::Vector<T, 6> AxisOf(const LoadWorkspace<T>& ws, size_t joint) const {
    const FrameT<T>& F = ws.joints[joint].F;
    Eigen::Vector<T, 6> axis;
    axis << Vector3Of(F.p) + ws.tree.reference.template cast<T>(), Vector3Of(F.z);
    return axis;
  }

  template <typename T>
  Vector3<T> OriginOf(size_t grasp, const LoadWorkspace<T>& ws) const {
    const int node = model_.tree.NodeOfLink(model_.tree.mechanism.grasps[grasp].link);
    const FrameT<T> X_WL = ws.tree.at(node).X * ws.tree.at(node).X_BL;
    const Vector3<T> p_LG = change_.grasps[grasp].template cast<T>();
    return Vector3Of(PointInWorld(X_WL, TripleOf<T>(p_LG))) + ws.tree.reference.template cast<T>();
  }

  [[noreturn]] void Refuse(size_t pose) const {
    const bool rests = model_.has_dry_friction && AnyStands(model_, motion_, pose, 1);
    throw std::runtime_error(fmt::format(
        "pose {} (t = {:.6g} s): {}, so that its loads have no derivative. {}",
        result_.pose_number(pose), motion_.times[pose],
        rests ? "a drive stands still and dry friction holds" : "the mechanism is at a dead centre",
        rests ? "Leave the pose out of the study" : "Choose another start or number of steps"));
  }

  const LoadModel& model_;
  const Motion& motion_;
  const StudyChange& change_;
  double size_ = 0;  ///< largest slope of an anchor's coordinate
  LoadDerivatives result_;
};

}  // namespace

std::string ReasonAgainstDerivatives(const LoadModel& model) {
  if (model.hand) return "a hand drives: give the mechanism a drive at a joint";
  if (model.rule == ReactionRule::kPaperJoint) {
    return "the rule 'paper_joint' has no derivative: take 'stiffness' or 'minimum_norm'";
  }
  return "";
}

LoadDerivatives DifferentiateLoads(const PreparedStudy& prepared, const Motion& motion,
                                   const StudyChange& change) {
  const std::string reason = ReasonAgainstDerivatives(prepared.model);
  if (!reason.empty()) throw std::invalid_argument("the loads are not differentiated: " + reason);
  return Differentiation(prepared.model, motion, change).Run();
}

}  // namespace vmech
