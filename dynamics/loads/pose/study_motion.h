#pragma once

#include <array>
#include <memory_resource>
#include <vector>

#include "vmech/base/dual.h"
#include "vmech/base/tape/tape.h"
#include "vmech/dynamics/loads/load_study.h"
#include "vmech/kinematics/motion/motion_law.h"

namespace vmech {

/// A study's motion, pose by pose.
struct Motion {
  std::pmr::vector<double> times;            ///< [poses] [s]
  std::pmr::vector<double> coordinates;      ///< [poses * nq] of closed poses
  std::pmr::vector<MotionSample> drives;     ///< [poses * drives]
  std::pmr::vector<HandSample> hand;         ///< [poses] if a hand drives
  std::pmr::vector<Vector3d> cut_positions;  ///< [poses * loops] of the cut joints, unwrapped
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

/// The motion at some of its poses.
Motion PartOf(const Motion& motion, const std::vector<size_t>& poses);

/// How what a study prescribes goes with a parameter: the slopes of its motion, and its external
/// loads with theirs.
struct PrescribedSlopes {
  std::vector<double> times;                ///< [poses]; empty where they are all zero
  std::vector<MotionSample> drives;         ///< [poses * drives]; empty where they are all zero
  std::vector<LoadTableOf<Dual>> external;  ///< per load, as LoadStudy::external
};

/// What a study prescribes at the poses at hand, for kernels whose numbers T are on a tape.
template <typename T>
struct PrescribedOnTape;
/// As variables of the tape.
template <typename N>
struct PrescribedOnTape<TapedOf<N>> {
  TapeOf<N>* tape = nullptr;                      ///< must outlive it
  std::vector<std::array<TapedOf<N>, 3>> drives;  ///< [drives] as MotionSample
  std::vector<Vector3<TapedOf<N>>> points;        ///< per load: LoadTableOf::p_L
  std::vector<Wrench<TapedOf<N>>> external;       ///< per load, in its own axes
};

}  // namespace vmech
