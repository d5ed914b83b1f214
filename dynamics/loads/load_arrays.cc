#include "vmech/dynamics/loads/load_arrays.h"

#include <numeric>

namespace vmech {

LoadArrays::LoadArrays(const Shape& shape)
    : drive_count(shape.drives),
      link_count(shape.links),
      first_freedom(shape.freedoms.size() + 1, 0),
      times(shape.poses, 0.0),
      drives(shape.poses * shape.drives),
      drive_forces(shape.poses * shape.drives),
      wrenches(shape.poses * shape.freedoms.size() * 6),
      powers(shape.poses),
      power_errors(shape.poses),
      power_error_scales(shape.poses),
      smallest_pivots(shape.poses),
      closures(shape.poses),
      links(shape.poses * shape.links),
      hands(shape.has_hand ? shape.poses : 0),
      states(shape.has_pose_state ? shape.poses : 0) {
  std::partial_sum(shape.freedoms.begin(), shape.freedoms.end(), first_freedom.begin() + 1);
  positions.resize(shape.poses * freedom_count());
  rates.resize(shape.poses * freedom_count());
  accelerations.resize(shape.poses * freedom_count());
}

JointSample LoadArrays::Joint(size_t pose, size_t joint) const {
  JointSample sample{Wrench(pose, joint)};
  const size_t first = pose * freedom_count() + static_cast<size_t>(first_freedom[joint]);
  const int count = first_freedom[joint + 1] - first_freedom[joint];
  for (int k = 0; k < count; ++k) {
    sample.position[k] = positions[first + static_cast<size_t>(k)];
    sample.rate[k] = rates[first + static_cast<size_t>(k)];
    sample.acceleration[k] = accelerations[first + static_cast<size_t>(k)];
  }
  return sample;
}

std::vector<int> FreedomsOfJoints(const Mechanism& mechanism) {
  std::vector<int> freedoms;
  for (const vmech::Joint& joint : mechanism.joints) freedoms.push_back(FreedomsOf(joint.type));
  return freedoms;
}

PoseLoads::PoseLoads(std::shared_ptr<const LoadArrays> arrays, size_t pose)
    : time(arrays->times[pose]),
      drives(arrays.get(), pose),
      joints(arrays.get(), pose),
      links(arrays->links.data() + pose * arrays->link_count, arrays->link_count),
      power(arrays->powers[pose]),
      power_error(arrays->power_errors[pose]),
      power_error_scale(arrays->power_error_scales[pose]),
      smallest_pivot(arrays->smallest_pivots[pose]),
      closure(arrays->closures[pose]),
      arrays_(std::move(arrays)) {
  if (!arrays_->states.empty()) PoseState::operator=(arrays_->states[pose]);
  if (arrays_->hands.empty()) return;
  hand = arrays_->hands[pose].wrench;
  hand_error = arrays_->hands[pose].error;
}

}  // namespace vmech
