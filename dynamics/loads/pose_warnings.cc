#include "vmech/dynamics/loads/pose_warnings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "vmech/dynamics/reactions/certainty.h"

namespace vmech {

double RoundingAlongIdle(const LoadModel& model, double largest_force) {
  return 1e-7 * largest_force * std::max(1.0, model.tree.length);
}

void WarnOfDrivenIdle(const LoadModel& model, double largest_force, LoadStudyResult* result) {
  const std::vector<PoseState>& states = result->poses.arrays().states;
  if (model.idle == 0 || states.empty()) return;
  const auto most = std::max_element(
      states.begin(), states.end(),
      [](const PoseState& a, const PoseState& b) { return a.along_idle < b.along_idle; });
  if (most->along_idle <= RoundingAlongIdle(model, largest_force)) return;
  result->warnings.push_back(fmt::format(
      "friction, springs or loads from outside act with up to {:.4g} N or N m (pose {}) along an "
      "idle freedom ({}), and would set it moving; the loads are those of links that have not "
      "gathered that motion. Take off what acts along it, or simulate (`vmech simulate`)",
      most->along_idle, most - states.begin(), fmt::join(result->idle, ", ")));
}

void FindSingularPoses(const LoadModel& model, const Motion& motion, LoadStudyResult* result) {
  constexpr double kNear = 1e-8;      // of pivots, which are squares
  constexpr double kRounded = 1e-12;  // over distance^2: what rounding makes of accelerations
  const LoadArrays& loads = result->poses.arrays();
  double nearest = 1;
  size_t beside = 0, nearest_pose = 0;
  for (size_t i = 0; i < loads.pose_count(); ++i) {
    if (loads.smallest_pivots[i] >= kNear) continue;
    const double distance = DistanceFromDeadCentre(model.tree, model.partition, motion.q(i));
    if (distance < kSingularTolerance) {
      result->singular_poses.push_back(i);
      continue;
    }
    if (distance * distance >= kNear) continue;
    ++beside;
    if (distance < nearest) nearest_pose = i;
    nearest = std::min(nearest, distance);
  }
  if (!result->singular_poses.empty()) {
    result->warnings.push_back(fmt::format(
        "{} pose(s), the first of them {}, lie at a dead centre: loads grow without bound there",
        result->singular_poses.size(), result->singular_poses.front()));
  }
  if (beside == 0) return;
  result->warnings.push_back(fmt::format(
      "{} pose(s) lie beside a dead centre, pose {} by {:.2g} rad: about {:.2g} of the "
      "accelerations there, and of what they load, may be rounding; take poses that are farther "
      "from it",
      beside, nearest_pose, nearest, std::min(1.0, kRounded / (nearest * nearest))));
}

}  // namespace vmech
