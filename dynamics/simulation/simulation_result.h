#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/simulation/simulation.h"
#include "vmech/kinematics/tree/kinematic_tree.h"

namespace vmech {

/// How a simulation ended.
enum class SimulationStatus {
  kNotRun,
  kFinished,     ///< it went to the last of the times
  kReached,      ///< a CoordinateWatch that ends the run was reached
  kInterrupted,  ///< SimulationOptions::progress said so; what was computed is there
  kFailed,       ///< it could not go on, and `message` says why; what was computed is there
};

/// The status in words.
constexpr std::string_view NameOf(SimulationStatus status) {
  switch (status) {
    case SimulationStatus::kNotRun:
      return "not run";
    case SimulationStatus::kFinished:
      return "finished";
    case SimulationStatus::kReached:
      return "reached";
    case SimulationStatus::kInterrupted:
      return "interrupted";
    case SimulationStatus::kFailed:
      return "failed";
  }
  return "";
}

/// Something that happened at once.
struct SimulationEvent {
  /// What happened.
  enum class Kind {
    kRebound,        ///< a limit was hit, and the freedom does not stay there
    kLimitCloses,    ///< a freedom comes to rest at its limit
    kLimitOpens,     ///< and leaves it
    kSticks,         ///< dry friction brings a contact to rest, or holds it from the start
    kSlips,          ///< and lets it go
    kReached,        ///< a CoordinateWatch
    kMethodChanged,  ///< the mechanism has proved stiff: BDF from here
  };

  double time = 0;             ///< [s]
  Kind kind = Kind::kReached;  ///< what happened
  FreedomId at;                ///< the first freedom of its contact; no joint for kMethodChanged
  double value = 0;            ///< the coordinate [m] or [rad]
  double rate = 0;             ///< before the event [m/s] or [rad/s]
};
/// The kind in words.
std::string_view NameOf(SimulationEvent::Kind kind);

/// The energies of the whole mechanism at one time [J].
struct EnergySample {
  double kinetic = 0;  ///< of all links
  double weight = 0;   ///< zero with all centres of gravity at the height of the reference point
  double springs = 0;  ///< of joints
  /// By drives, motors, external wrenches and the hand's coupling, since the start.
  double supplied = 0;
  double dissipated = 0;  ///< by dampers, dry friction and impacts, since the start
  double Total() const { return kinetic + weight + springs; }  ///< kinetic and potential
  /// Total less what it was at the start, less what was supplied, plus what was dissipated.
  double error = 0;
};

/// What a simulation cost.
struct SimulationStatistics {
  SimulationMethod method = SimulationMethod::kAdams;     ///< at the end
  long steps = 0;                                         ///< that were kept
  long evaluations = 0;                                   ///< of the accelerations
  long error_test_failures = 0;                           ///< steps that were done again, smaller
  long nonlinear_iterations = 0, nonlinear_failures = 0;  ///< of the implicit methods' equations
  long jacobians = 0;                                     ///< BDF and IDAS
  long projections = 0;                                   ///< returns to the loops in mid-run
  long restarts = 0;              ///< of the integrator: after projections and events
  long partitions = 0;            ///< choices of independent freedoms
  long singular_poses = 0;        ///< evaluations at poses where loops lose rank
  double largest_drift = 0;       ///< loop error, dimensionless, before projection
  double largest_rate_drift = 0;  ///< the same of the loops' rates [1/s]
  double largest_closure = 0;     ///< of the results
  double seconds = 0;             ///< the run without the joints' wrenches
};

/// A start rate that the loops moved.
struct MovedRate {
  FreedomId at;             ///< the freedom that was given a rate
  double from = 0, to = 0;  ///< [m/s] or [rad/s]
};

/// What a simulation came to, in SI units. Shapes stand in square brackets.
struct SimulationResult {
  SimulationStatus status = SimulationStatus::kNotRun;  ///< how the run ended
  std::string message;                                  ///< why it stopped, a sentence

  KinematicTree tree;           ///< of the assembled mechanism; q and v are its coordinates
  std::vector<double> times;    ///< [poses] as wanted, as far as it went; and the end, if not one
  std::vector<double> q;        ///< [poses, nq]
  std::vector<double> v, vdot;  ///< [poses, nv]
  std::vector<EnergySample> energies;  ///< [poses]
  std::vector<Wrenchd> hand;  ///< [poses] what the hand's coupling does to the mechanism at Go
  std::vector<double> motor_forces;     ///< [poses, motors] [N] or [N m]
  std::vector<SimulationEvent> events;  ///< in their order
  SimulationStatistics statistics;      ///< what it cost

  std::vector<MovedRate> moved_rates;  ///< start rates that the loops did not allow as given
  std::vector<std::string> notes;      ///< what the assembly moved, as AssembledMechanism::Notes
  std::vector<std::string> warnings;   ///< sentences for the user

  /// Every joint along the trajectory, with the verdicts and rules of a load study: coordinates,
  /// rates, accelerations, wrenches, link motions. Its drives are those of the simulation. Empty if
  /// SimulationOptions::loads is off.
  LoadStudyResult loads;

  size_t size() const { return times.size(); }  ///< poses that were reached
  /// [nq] of a pose, a view
  Eigen::Map<const VectorXd> Q(size_t pose) const { return {q.data() + pose * tree.nq, tree.nq}; }
  /// [nv] of a pose, a view
  Eigen::Map<const VectorXd> V(size_t pose) const { return {v.data() + pose * tree.nv, tree.nv}; }
  /// [nv] of a pose, a view
  Eigen::Map<const VectorXd> Vdot(size_t pose) const {
    return {vdot.data() + pose * tree.nv, tree.nv};
  }
  std::string BriefReport() const;  ///< a line
};

}  // namespace vmech
