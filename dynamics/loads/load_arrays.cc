#include "vmech/dynamics/loads/load_arrays.h"

#include <numeric>

namespace vmech {

namespace {

/// What a study stores of one pose [bytes].
size_t BytesOfPose(const LoadArrays::Shape& shape) {
  constexpr size_t kOfPose = 6, kOfJoint = 6, kOfFreedom = 3;
  const size_t freedoms = std::reduce(shape.freedoms.begin(), shape.freedoms.end(), size_t{0});
  return (sizeof(double) + sizeof(MotionSample)) * shape.drives +
         sizeof(double) * (kOfPose + kOfJoint * shape.freedoms.size() + kOfFreedom * freedoms) +
         sizeof(LinkMotion) * shape.links;
}

}  // namespace

LoadArrays::LoadArrays(const Shape& shape)
    : drive_count(shape.drives),
      link_count(shape.links),
      memory(shape.poses * BytesOfPose(shape)),
      first_freedom(shape.freedoms.size() + 1, 0),
      times(shape.poses, memory.resource()),
      drives(shape.poses * shape.drives, memory.resource()),
      drive_forces(shape.poses * shape.drives, memory.resource()),
      wrenches(shape.poses * shape.freedoms.size() * 6, memory.resource()),
      positions(memory.resource()),
      rates(memory.resource()),
      accelerations(memory.resource()),
      powers(shape.poses, memory.resource()),
      power_errors(shape.poses, memory.resource()),
      power_error_scales(shape.poses, memory.resource()),
      smallest_pivots(shape.poses, memory.resource()),
      closures(shape.poses, memory.resource()),
      links(shape.poses * shape.links, memory.resource()),
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
