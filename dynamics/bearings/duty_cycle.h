#pragma once

#include <span>
#include <vector>

#include "vmech/base/pose.h"

namespace vmech {

/// What one joint goes through, pose by pose, in a cycle that repeats. All lists have the same
/// length, at least one.
struct DutyCycle {
  std::vector<double> duration;  ///< time that each pose stands for [s], >= 0, not all zero
  std::vector<double> angle;     ///< of the second link against the first about z [rad], unwrapped
  std::vector<double> speed;     ///< rate of the angle [rad/s]
  /// Exerted by the first link on the second, about the origin of the second anchor, in the axes
  /// of the joint (z is the joint's axis) [N], [N m].
  std::vector<Wrenchd> wrench;

  /// @throws std::invalid_argument naming the list, the pose and the value.
  void Validate() const;
};

/// Durations for poses at ascending times: half of each neighbouring interval (trapezoidal rule).
/// A single pose stands for one second. Poses that repeat after `cycle` [s] stand for all of it:
/// the first one follows the last. 0: they do not repeat.
/// @throws std::invalid_argument if the times do not ascend.
std::vector<double> DurationsFromTimes(std::span<const double> times, double cycle = 0);

/// How a bearing turns over a cycle.
enum class Rotation {
  kStanding,     ///< does not turn: there is no rating life, static safety alone decides
  kTurning,      ///< always in the same direction
  kReversing,    ///< in both directions, through a turn or more
  kOscillating,  ///< in both directions, through less than a turn
};

/// How the joint turns over the cycle.
struct RotationSummary {
  Rotation rotation = Rotation::kStanding;  ///< whether it stands, goes to and fro or turns
  double cycle_time = 0;                    ///< [s]
  double revolutions = 0;  ///< path / (2 pi) per cycle, every direction counted positive
  double mean_speed = 0;   ///< path / cycle time [rad/s]
  double peak_speed = 0;   ///< max |speed| [rad/s]
  double amplitude = 0;    ///< half of the range of the angle [rad]; for oscillation
  /// Path / (2 pi) of each pose: the weights of the mean load. In oscillation, with amplitude gamma
  /// and n cycles, they add up to n 4 gamma / (2 pi): the rule of SKF (life in cycles =
  /// L10 180 / (2 gamma) with gamma in degrees) and of FAG (n = n_osc phi / 180, phi = 2 gamma).
  std::vector<double> revolutions_of_pose;
};

/// Oscillation is recognised from both signs of the speed and a range of the angle under a turn.
/// Expects a valid cycle.
RotationSummary SummariseRotation(const DutyCycle& cycle);

}  // namespace vmech
