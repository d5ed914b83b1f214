#include "vmech/bindings/shared/computed.h"

#include <initializer_list>

namespace vmech {
namespace {

// What is read as rows of numbers has to be nothing else.
static_assert(sizeof(MotionSample) == 3 * sizeof(double));
static_assert(sizeof(EnergySample) == 6 * sizeof(double));
static_assert(sizeof(Wrenchd) == 6 * sizeof(double));
static_assert(sizeof(LinkMotion) == 24 * sizeof(double));

constexpr ptrdiff_t kNumber = sizeof(double);

/// `shape` numbers behind each other, the last index fastest.
NumberArray Dense(const double* data, std::initializer_list<size_t> shape) {
  NumberArray array{data, shape.size(), {}, {}};
  ptrdiff_t stride = kNumber;
  for (size_t i = shape.size(); i-- > 0;) {
    array.shape[i] = shape.begin()[i];
    array.strides[i] = stride;
    stride *= static_cast<ptrdiff_t>(array.shape[i]);
  }
  return array;
}

/// The same for one field of `count` things, of which each takes `size` bytes.
NumberArray Field(const double* data, size_t count, size_t size, size_t numbers) {
  NumberArray array = Dense(data, {count, numbers});
  array.strides[0] = static_cast<ptrdiff_t>(size);
  return array;
}

/// [poses, links, ...] of a field of every link; a rotation lies column after column.
NumberArray OfEveryLink(const double* data, size_t poses, size_t links, size_t size,
                        std::initializer_list<size_t> of_link) {
  const ptrdiff_t link = static_cast<ptrdiff_t>(size);
  NumberArray array{data, 2 + of_link.size(), {poses, links}, {}};
  array.strides = {static_cast<ptrdiff_t>(links) * link, link, kNumber, 0};
  size_t i = 2;
  for (const size_t n : of_link) array.shape[i++] = n;
  if (of_link.size() == 2) array.strides[3] = 3 * kNumber;
  return array;
}

}  // namespace

Computed::Computed(StudyOutcome outcome) : outcome_(std::move(outcome)) {
  const LoadArrays& loads = outcome_.loads.poses.arrays();
  if (!outcome_.loads.poses.empty() && !loads.wrenches.empty()) peaks_ = FindPeaks(loads);
}

size_t Computed::pose_count() const {
  return list_.poses > 0 ? list_.poses : outcome_.loads.poses.size();
}

NumberArray Computed::Array(ArrayKind quantity) const {
  NumberArray array;
  if (list_.poses > 0) {
    array = OfList(quantity);
  } else if (!outcome_.loads.poses.empty()) {
    array = OfLoads(quantity);
    if (array.data == nullptr) array = OfLinks(quantity);
    if (array.data == nullptr) array = OfSimulation(quantity);
  }
  return array.data == nullptr ? NumberArray() : array;
}

NumberArray Computed::OfLoads(ArrayKind quantity) const {
  const LoadArrays& a = outcome_.loads.poses.arrays();
  const size_t poses = a.pose_count();
  switch (quantity) {
    case ArrayKind::kTimes:
      return Dense(a.times.data(), {poses});
    case ArrayKind::kWrenches:
      return Dense(a.wrenches.data(), {poses, a.joint_count(), 6});
    case ArrayKind::kPositions:
      return Dense(a.positions.data(), {poses, a.freedom_count()});
    case ArrayKind::kRates:
      return Dense(a.rates.data(), {poses, a.freedom_count()});
    case ArrayKind::kAccelerations:
      return Dense(a.accelerations.data(), {poses, a.freedom_count()});
    case ArrayKind::kDriveMotions:
      if (a.drives.empty()) return {};
      return Dense(&a.drives[0].position, {poses, a.drive_count, 3});
    case ArrayKind::kDriveForces:
      return Dense(a.drive_forces.data(), {poses, a.drive_count});
    case ArrayKind::kPowers:
      return Dense(a.powers.data(), {poses});
    case ArrayKind::kPowerErrors:
      return Dense(a.power_errors.data(), {poses});
    case ArrayKind::kClosures:
      return Dense(a.closures.data(), {poses});
    case ArrayKind::kPeaks:
      if (peaks_.components.empty()) return {};
      return Dense(peaks_.components[0].data(), {peaks_.components.size(), 6});
    default:
      return {};
  }
}

NumberArray Computed::OfLinks(ArrayKind quantity) const {
  const LoadArrays& a = outcome_.loads.poses.arrays();
  const size_t poses = a.pose_count();
  if (a.links.empty()) return {};
  const LinkMotion& first = a.links[0];
  const auto field = [&](const double* data, std::initializer_list<size_t> shape) {
    return OfEveryLink(data, poses, a.link_count, sizeof(LinkMotion), shape);
  };
  if (quantity == ArrayKind::kLinkPositions) return field(first.X_WL.p.data(), {3});
  if (quantity == ArrayKind::kLinkRotations) return field(first.X_WL.R.data(), {3, 3});
  if (quantity == ArrayKind::kLinkTwists) return field(first.v.data(), {6});
  return {};
}

NumberArray Computed::OfSimulation(ArrayKind quantity) const {
  const LoadArrays& a = outcome_.loads.poses.arrays();
  const SimulationResult* simulation = outcome_.simulation ? &*outcome_.simulation : nullptr;
  if (quantity == ArrayKind::kHandWrenches) {
    if (!a.hands.empty()) {
      const double* data = a.hands[0].wrench.force.data();
      return Field(data, a.hands.size(), sizeof(HandLoad), 6);
    }
    if (simulation == nullptr || simulation->hand.empty()) return {};
    return Dense(simulation->hand[0].force.data(), {simulation->hand.size(), 6});
  }
  if (simulation == nullptr || simulation->energies.empty()) return {};
  const size_t poses = simulation->energies.size();
  if (quantity == ArrayKind::kEnergies) return Dense(&simulation->energies[0].kinetic, {poses, 6});
  const std::vector<double>& motors = simulation->motor_forces;
  if (quantity == ArrayKind::kMotorForces)
    return Dense(motors.data(), {poses, motors.size() / poses});
  return {};
}

NumberArray Computed::OfList(ArrayKind quantity) const {
  const size_t poses = list_.poses;
  switch (quantity) {
    case ArrayKind::kPositions:
      return Dense(list_.positions.data(), {poses, list_.positions.size() / poses});
    case ArrayKind::kHandErrors:
      return list_.errors.empty() ? NumberArray() : Dense(list_.errors[0].data(), {poses, 6});
    case ArrayKind::kLinkPositions:
      return OfEveryLink(list_.links[0].p.data(), poses, list_.link_count, sizeof(Posed), {3});
    case ArrayKind::kLinkRotations:
      return OfEveryLink(list_.links[0].R.data(), poses, list_.link_count, sizeof(Posed), {3, 3});
    default:
      return {};
  }
}

}  // namespace vmech
