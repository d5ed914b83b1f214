#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "vmech/base/pose.h"
#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/load_study.h"

namespace vmech {

/// The transmission angle of a planar loop of four links [Alt 1932]: what the pressure angle, that
/// between the force which a massless coupler passes on and the velocity of the point of the output
/// on which it acts, leaves to a right angle,
///
///   sin mu = |f . v| / (|f| |v|).
///
/// Between two revolutes f is along the coupler: at a rocker mu is the angle between coupler and
/// rocker, at a slide the angle between the connecting rod and the normal to the slide. A coupler
/// that slides on one of its neighbours pushes across the slide, through its revolute. 90 degrees
/// are best; at 0 nothing is passed on.
struct TransmissionAngle {
  std::array<int, 4> joints{};                ///< ground - input - coupler - output - ground
  int input = -1, coupler = -1, output = -1;  ///< links
  bool slides = false;                        ///< the output slides on the ground
  bool coupler_slides = false;                ///< the coupler slides on the input or on the output
  std::vector<double> angles;                 ///< [poses] in [0, pi/2]; not finite where v is zero
  size_t least_pose = 0;                      ///< the pose with the smallest angle
};

/// None where the mechanism is not one loop of four links, the ground among them, of revolutes with
/// parallel axes and prismatics across these, driven at the ground; nor where both ends of the
/// coupler slide, or the motion of the links was not computed.
std::optional<TransmissionAngle> FindTransmissionAngle(const LoadStudy& study,
                                                       const LoadStudyResult& result);

/// The four joints of such a loop at one pose, in the order of TransmissionAngle::joints. T is
/// double, or Dual to take a derivative along.
template <typename T>
struct PlanarLoop {
  std::array<Vector3<T>, 4> points, axes;  ///< where they are, and their z axes, in the world
  std::array<bool, 4> turns{};             ///< revolute, else prismatic

  /// mu [rad]; not finite where v is zero.
  T TransmissionAngle() const;
};

template <typename T>
T PlanarLoop<T>::TransmissionAngle() const {
  using std::abs, std::atan2;
  const Vector3<T> normal = axes[turns[2] ? 2 : 1];
  const Vector3<T> at = points[turns[2] ? 2 : 1];
  Vector3<T> force = points[2] - points[1];
  if (!turns[1]) force = normal.cross(axes[1]);
  if (!turns[2]) force = normal.cross(axes[2]);
  force -= force.dot(normal) * normal;
  const Vector3<T> velocity = turns[3] ? Vector3<T>(normal.cross(at - points[3])) : axes[3];
  const T along = abs(force.dot(velocity)), across = abs(force.cross(velocity).dot(normal));
  if (!(along + across > T(0))) return T(std::numeric_limits<double>::quiet_NaN());
  return atan2(along, across);
}

}  // namespace vmech
