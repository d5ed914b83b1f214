#pragma once

#include <span>
#include <string>
#include <vector>

#include "vmech/dynamics/bearings/arrangement.h"
#include "vmech/dynamics/bearings/duty_cycle.h"
#include "vmech/dynamics/bearings/selection.h"

namespace vmech {

/// Whether statics determines the components of the joint's wrench that load its bearings.
enum class LoadCertainty {
  kCertain,
  kDependsOnRule,  ///< another rule for the undetermined components gives another life
};

/// The bearings of one joint: from its wrenches over the duty cycle to a choice with reasons.
struct JointBearings {
  RotationSummary rotation;                  ///< over one cycle
  ArrangementLoads loads;                    ///< of each position, sample by sample
  std::vector<BearingSelection> selections;  ///< one per position
  /// Life of all bearings together at the required reliability [h]; zero if a position is not
  /// filled. With mixed kinds the flatter Weibull slope is taken, which gives the shorter life.
  double system_life_hours = 0;
  double peak_tilting_moment = 0;  ///< greatest moment that a single bearing cannot take [N m]
  LoadCertainty certainty = LoadCertainty::kCertain;  ///< of the wrenches that load them
  std::vector<std::string> warnings;                  ///< about the joint as a whole
  double asked_system_life = 0;  ///< of two bearings together [h]; zero for a single one

  /// True if every position has a bearing.
  bool complete() const;
  /// True if every position has a bearing and all of them together live as long as is asked.
  bool met() const { return complete() && system_life_hours >= asked_system_life; }
  /// One line: the choice at each position and the life of the system.
  std::string BriefReport() const;
  /// A page: how the joint turns, loads, choices, warnings, and the reason against every bearing
  /// that was passed over.
  std::string FullReport() const;
};

/// Distributes the joint's wrench over the arrangement and selects a bearing for every position;
/// the bores may differ within the range of the shaft. Two bearings that meet what is asked of each
/// but together live shorter than is asked of the pair give way to the smallest pair that does:
/// least sum of outer diameters, then of widths. If there is none, the pair that lives longest is
/// taken and is not `met`.
/// @throws std::invalid_argument if the cycle, the arrangement or the requirements are not valid.
JointBearings SelectJointBearings(const DutyCycle& cycle, const Arrangement& arrangement,
                                  const BearingRequirements& requirements, LoadCertainty certainty,
                                  std::span<const Bearing> catalogue);

}  // namespace vmech
