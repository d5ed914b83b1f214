#pragma once

#include <cstddef>
#include <vector>

#include "vmech/dynamics/loads/pose/load_model.h"

namespace vmech {

/// Where the numbers of a pose are in a row of LoadRows.
struct LoadLayout {
  LoadLayout() = default;
  /// Of the studies that a model is of.
  explicit LoadLayout(const LoadModel& model);

  size_t joints = 0;               ///< of the mechanism
  size_t grasps = 0, drives = 0;   ///< of the mechanism, of the study
  std::vector<int> first_freedom;  ///< [joints + 1]

  /// Six numbers: what the joint transmits, as JointLoad::W_F.
  size_t wrench(size_t joint) const { return 6 * joint; }
  /// Six numbers: where the joint is, and its z axis: of its first anchor, in the world [m].
  size_t axis(size_t joint) const { return 6 * (joints + joint); }
  /// Three numbers: the force of the ground on the mechanism, world axes [N].
  size_t ground_force() const { return 12 * joints; }
  /// Three numbers: the origin of a grasp in the world [m].
  size_t grasp(size_t grasp) const { return 12 * joints + 3 + 3 * grasp; }
  /// The force of a drive [N] or [N m].
  size_t drive_force(size_t drive) const { return grasp(grasps) + drive; }
  /// The rates of a joint's freedoms [m/s] or [rad/s].
  size_t rate(size_t joint) const {
    return drive_force(drives) + static_cast<size_t>(first_freedom[joint]);
  }
  size_t width() const { return rate(joints); }  ///< numbers in a row
};

/// What comes of a study at some of its poses: a row of numbers for each.
template <typename T>
struct LoadRows {
  LoadLayout layout;          ///< of a row
  std::vector<size_t> poses;  ///< which poses of the motion they are, ascending
  std::vector<T> numbers;     ///< [poses, layout.width()]
  /// Of the i-th of the poses.
  const T* row(size_t i) const { return &numbers[i * layout.width()]; }
};

}  // namespace vmech
