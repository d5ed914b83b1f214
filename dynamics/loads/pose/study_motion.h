#pragma once

#include <vector>

#include "vmech/base/dual.h"
#include "vmech/dynamics/loads/load_study.h"
#include "vmech/kinematics/motion/motion_law.h"

namespace vmech {

/// A study's motion, pose by pose.
struct Motion {
  std::vector<double> times;            ///< [poses] [s]
  std::vector<double> coordinates;      ///< [poses * nq] of closed poses
  std::vector<MotionSample> drives;     ///< [poses * drives]
  std::vector<HandSample> hand;         ///< [poses] if a hand drives
  std::vector<Vector3d> cut_positions;  ///< [poses * loops] of the cut joints, unwrapped
  /// The largest speed of any drive or of the hand [rad/s], lengths divided by the characteristic
  /// length: what rounding of velocities is measured by.
  double speed = 0;

  size_t size() const { return times.size(); }  ///< poses
  /// Coordinates of a pose [nq].
  Eigen::Map<const VectorXd> q(size_t pose) const {
    const size_t nq = coordinates.size() / times.size();
    return {coordinates.data() + pose * nq, static_cast<Eigen::Index>(nq)};
  }
};

/// How what a study prescribes goes with a parameter: the slopes of its motion, and its external
/// loads with theirs.
struct PrescribedSlopes {
  std::vector<double> times;                ///< [poses]
  std::vector<MotionSample> drives;         ///< [poses * drives]
  std::vector<LoadTableOf<Dual>> external;  ///< per load, as LoadStudy::external
};

}  // namespace vmech
