#pragma once

#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "vmech/base/pose.h"
#include "vmech/bindings/shared/number_array.h"
#include "vmech/dynamics/loads/load_peaks.h"
#include "vmech/dynamics/reactions/certainty.h"
#include "vmech/studies/study.h"

namespace vmech {

/// What can be read of a computation, one array each; SI units and radians.
enum class ArrayKind {
  kTimes,          ///< [poses] [s]
  kWrenches,       ///< [poses, joints, 6] as JointSample [N], [N m]
  kPositions,      ///< [poses, freedoms] coordinates [m] or [rad]
  kRates,          ///< [poses, freedoms]
  kAccelerations,  ///< [poses, freedoms]
  kDriveMotions,   ///< [poses, drives, 3] position, velocity, acceleration
  kDriveForces,    ///< [poses, drives] [N] or [N m]
  kPowers,         ///< [poses] of the drives and the hand [W]
  kPowerErrors,    ///< [poses] as LoadArrays::power_errors
  kClosures,       ///< [poses] loop error that is left, dimensionless
  kLinkPositions,  ///< [poses, links, 3] of the links' drawing frames in the world [m]
  kLinkRotations,  ///< [poses, links, 3, 3] their axes, as columns
  kLinkTwists,     ///< [poses, links, 6] velocity, angular velocity, world axes
  kHandWrenches,   ///< [poses, 6] of the hand on the mechanism about Go, world axes
  kHandErrors,     ///< [poses, 6] from the grasp to the hand [m], [rad], world axes
  kEnergies,       ///< [poses, 6] kinetic, weight, springs, supplied, dissipated, error [J]
  kMotorForces,    ///< [poses, motors] [N] or [N m]
  kPeaks,          ///< [joints, 6] the largest size of every component
};

struct ArrayKindName {
  ArrayKind quantity;
  std::string_view name;
};

inline constexpr std::array kQuantities = {
    ArrayKindName{ArrayKind::kTimes, "times"},
    ArrayKindName{ArrayKind::kWrenches, "wrenches"},
    ArrayKindName{ArrayKind::kPositions, "positions"},
    ArrayKindName{ArrayKind::kRates, "rates"},
    ArrayKindName{ArrayKind::kAccelerations, "accelerations"},
    ArrayKindName{ArrayKind::kDriveMotions, "drive_motions"},
    ArrayKindName{ArrayKind::kDriveForces, "drive_forces"},
    ArrayKindName{ArrayKind::kPowers, "powers"},
    ArrayKindName{ArrayKind::kPowerErrors, "power_errors"},
    ArrayKindName{ArrayKind::kClosures, "closures"},
    ArrayKindName{ArrayKind::kLinkPositions, "link_positions"},
    ArrayKindName{ArrayKind::kLinkRotations, "link_rotations"},
    ArrayKindName{ArrayKind::kLinkTwists, "link_twists"},
    ArrayKindName{ArrayKind::kHandWrenches, "hand_wrenches"},
    ArrayKindName{ArrayKind::kHandErrors, "hand_errors"},
    ArrayKindName{ArrayKind::kEnergies, "energies"},
    ArrayKindName{ArrayKind::kMotorForces, "motor_forces"},
    ArrayKindName{ArrayKind::kPeaks, "peaks"},
};

/// Closed poses of a mechanism, without time.
struct PoseList {
  size_t poses = 0;
  std::vector<double> positions;  ///< [poses, freedoms] as StartOfFreedoms
  std::vector<Posed> links;       ///< [poses, links] X_WL
  std::vector<Vector6d> errors;   ///< [poses] of a hand; empty without one
  size_t link_count = 0;
};

/// What came of a study, or of a question for poses; it owns the numbers of its arrays.
class Computed {
 public:
  Computed() = default;
  explicit Computed(StudyOutcome outcome);
  explicit Computed(PoseList list) : list_(std::move(list)) {}

  /// Lives as long as this. Rank 0 and no data where there is no such array, such as the wrenches
  /// of a list of poses.
  NumberArray Array(ArrayKind quantity) const;
  size_t pose_count() const;
  const StudyOutcome& outcome() const { return outcome_; }
  /// Verdicts on the joints' wrenches.
  const std::vector<JointCertainty>& certainty() const { return outcome_.loads.certainty; }
  const std::vector<std::string>& warnings() const { return outcome_.warnings; }
  void Warn(std::string warning) { outcome_.warnings.push_back(std::move(warning)); }

 private:
  NumberArray OfLoads(ArrayKind quantity) const;
  NumberArray OfLinks(ArrayKind quantity) const;
  NumberArray OfSimulation(ArrayKind quantity) const;
  NumberArray OfList(ArrayKind quantity) const;

  StudyOutcome outcome_;
  LoadPeaks peaks_;
  PoseList list_;
};

}  // namespace vmech
