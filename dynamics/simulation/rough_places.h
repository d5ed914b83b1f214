#pragma once

#include <optional>
#include <string>

#include "vmech/base/eigen.h"
#include "vmech/dynamics/simulation/equations/equations_of_motion.h"
#include "vmech/dynamics/simulation/simulation.h"
#include "vmech/mechanisms/mechanism.h"

namespace vmech {

/// Where the equations of motion are hard on an integrator: poses at which loops lose rank, and
/// motions that have long decayed. States are those of EquationsOfMotion::Slopes.

/// Is a mechanism, after a step [s], next to a singular pose, or does it creep up to one? Its
/// distance is the root of the pivot.
bool NearSingularPose(EquationsOfMotion& equations, double step);

/// A step over a singular pose, by the rule of Lobatto (IIIA) of sixth order: its stages lie before
/// and behind the pose, and none at it.
struct Leap {
  static constexpr int kStages = 4;  ///< of a step
  /// (5 -+ sqrt 5) / 10 within the step.
  static constexpr double kAt[kStages] = {0, 0.27639320225002103, 0.72360679774997897, 1};

  double from = 0, step = 0;  ///< [s]
  VectorXd start;             ///< state at its beginning
  VectorXd slopes[kStages];   ///< of the state at its stages

  /// The state at a time within it.
  void At(double time, VectorXd* y) const;
};

/// Near a singular pose loops leave little more than rounding of how they bend there, and small
/// steps do not lead over it: one that is as long as there is room between them does. None, if
/// there is no such pose ahead: loops that only nearly lose rank turn the mechanism, and are
/// followed.
std::optional<Leap> LeapOverSingularPose(double time, const VectorXd& y,
                                         EquationsOfMotion* equations);

/// What is wrong with a state, and where the joints are there: for a message that says why a run
/// cannot go on.
std::string DescribePlace(double time, const VectorXd& y, const DisplayUnits& units,
                          EquationsOfMotion* equations);

/// The largest eigenvalue of df/dy, by a power iteration, if it is real and negative: its size
/// [1/s]; else 0.
double FastestDecay(double time, const VectorXd& y, EquationsOfMotion* equations);

/// Looks, ever more seldom, whether what decays fastest keeps the steps of a run short.
class StiffnessWatch {
 public:
  /// Of a run of this simulation.
  explicit StiffnessWatch(const Simulation& simulation);

  /// The run begins at a time [s].
  void BeginAt(double time) { last_look_ = time; }
  /// Is the run stiff, at a state that the integrator's `steps` led to?
  bool Limits(long steps, double time, const VectorXd& y, EquationsOfMotion* equations);

 private:
  bool decays_;                           ///< does anything?
  long next_look_ = 100, looked_at_ = 0;  ///< steps
  double last_look_ = 0;                  ///< [s]
};

}  // namespace vmech
