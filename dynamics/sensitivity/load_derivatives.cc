#include "vmech/dynamics/sensitivity/load_derivatives.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>

#include "vmech/base/dual.h"
#include "vmech/base/lanes4.h"
#include "vmech/dynamics/loads/pose/pose_loads.h"
#include "vmech/dynamics/loads/pose/resting_friction.h"
#include "vmech/dynamics/sensitivity/pose_row.h"

namespace vmech {
namespace {

/// What a loop is left open by, of what closing it has to move: more than rounding.
constexpr double kOpens = 1e-7;

std::vector<size_t> AllPoses(const Motion& motion) {
  std::vector<size_t> poses(motion.size());
  std::iota(poses.begin(), poses.end(), size_t{0});
  return poses;
}

template <typename T>
LoadRows<T> MakeRows(const LoadModel& model, std::vector<size_t> poses) {
  LoadRows<T> rows{LoadLayout(model), std::move(poses), {}};
  rows.numbers.resize(rows.layout.width() * rows.poses.size());
  return rows;
}

void RequireMotion(bool jammed, const Motion& motion, size_t pose, size_t number) {
  if (!jammed) return;
  throw std::runtime_error(fmt::format(
      "pose {} (t = {:.6g} s): friction locks the mechanism, and its loads have no derivative",
      number, motion.times[pose]));
}

/// Evaluates poses side by side, in lanes or alone.
template <typename T>
bool FillRows(const LoadModel& model, const Motion& motion, size_t pose,
              const std::vector<Vector3<T>>& p_LG, LoadWorkspace<T>* ws, LoadRows<double>* rows) {
  if (!EvaluatePoseLoads(model, motion, pose, ws)) return false;
  RequireMotion(ws->jammed, motion, pose, pose);
  const size_t width = rows->layout.width();
  std::vector<T> row(width, T(0));
  FillRow(model, p_LG, *ws, rows->layout, row.data());
  StoreLanes(row.data(), static_cast<int>(width), &rows->numbers[pose * width],
             static_cast<ptrdiff_t>(width));
  return true;
}

template <typename T>
std::vector<Vector3<T>> GraspOrigins(const Mechanism& mechanism) {
  std::vector<Vector3<T>> p_LG;
  for (const Grasp& grasp : mechanism.grasps) p_LG.push_back(grasp.X_LG.p.cast<T>());
  return p_LG;
}

/// Evaluates poses on duals, one by one.
class Differentiation {
 public:
  Differentiation(const LoadModel& model, const Motion& motion, const StudyChange& change)
      : model_(model), motion_(motion), change_(change), ws_(model, change.design) {
    ws_.slopes = &change.prescribed;
    for (const auto& link : change.design.links) {
      for (const Pose<Dual>& X : link.X_LA) {
        for (const Dual& p : X.p) size_ = std::max(size_, std::abs(p.slope));
      }
    }
  }

  void Evaluate(size_t pose, const LoadLayout& layout, Dual* row) {
    if (!EvaluatePoseLoads(model_, motion_, pose, &ws_)) {
      RefusePose(model_, motion_, pose, change_.pose_number(pose));
    }
    RequireMotion(ws_.jammed, motion_, pose, change_.pose_number(pose));
    RequireClosed(pose);
    FillRow(model_, change_.grasps, ws_, layout, row);
  }

 private:
  void RequireClosed(size_t pose) const {
    // What changes all sizes alike moves no loop but in the rounding of its slopes.
    const double moved = std::max(ws_.closing.slope, size_ / model_.tree.length);
    if (ws_.opening.slope <= std::max(kOpens * moved, change_.rounding)) return;
    throw std::runtime_error(
        fmt::format("the loop that is cut at '{}' cannot stay closed when this changes (pose {}, t "
                    "= {:.6g} s): "
                    "the mechanism moves, or can be assembled, for this value alone",
                    model_.tree.mechanism.joints[model_.tree.loops[ws_.opening.loop].joint].name,
                    change_.pose_number(pose), motion_.times[pose]));
  }

  const LoadModel& model_;
  const Motion& motion_;
  const StudyChange& change_;
  LoadWorkspace<Dual> ws_;
  double size_ = 0;  ///< largest slope of an anchor's coordinate
};

}  // namespace

std::string ReasonAgainstDerivatives(const LoadModel& model) {
  if (model.hand) return "a hand drives: give the mechanism a drive at a joint";
  if (model.rule == ReactionRule::kPaperJoint) {
    return "the rule 'paper_joint' has no derivative: take 'stiffness' or 'minimum_norm'";
  }
  return "";
}

LoadRows<double> EvaluateLoads(const PreparedStudy& prepared, const Motion& motion) {
  const LoadModel& model = prepared.model;
  LoadRows<double> rows = MakeRows<double>(model, AllPoses(motion));
  LoadWorkspace<double> one(model);
  LoadWorkspace<Lanes4> four(model);
  const std::vector<Vector3d> p_LG = GraspOrigins<double>(model.tree.mechanism);
  const std::vector<Vector3<Lanes4>> p_LG_four = GraspOrigins<Lanes4>(model.tree.mechanism);
  constexpr size_t kLanes = Lanes4::kLanes;
  const size_t poses = motion.size();
  for (size_t i = 0; i < poses;) {
    // The last packet reaches back to poses that were there before.
    const size_t at = std::min(i, poses - std::min(poses, kLanes));
    if (RunsInLanes(model) && poses >= kLanes &&
        FillRows(model, motion, at, p_LG_four, &four, &rows)) {
      i = at + kLanes;
      continue;
    }
    const bool rests = model.has_dry_friction && AnyStands(model, motion, i, 1);
    if (rests || !FillRows(model, motion, i, p_LG, &one, &rows)) RefusePose(model, motion, i, i);
    ++i;
  }
  return rows;
}

LoadRows<Dual> DifferentiateLoads(const PreparedStudy& prepared, const Motion& motion,
                                  const StudyChange& change, std::vector<size_t> poses) {
  const std::string reason = ReasonAgainstDerivatives(prepared.model);
  if (!reason.empty()) throw std::invalid_argument("the loads are not differentiated: " + reason);
  LoadRows<Dual> rows = MakeRows<Dual>(prepared.model, std::move(poses));
  Differentiation differentiation(prepared.model, motion, change);
  Dual* row = rows.numbers.data();
  for (const size_t pose : rows.poses) {
    differentiation.Evaluate(pose, rows.layout, row);
    row += rows.layout.width();
  }
  return rows;
}

LoadRows<Dual> DifferentiateLoads(const PreparedStudy& prepared, const Motion& motion,
                                  const StudyChange& change) {
  return DifferentiateLoads(prepared, motion, change, AllPoses(motion));
}

}  // namespace vmech
