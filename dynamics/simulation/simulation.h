#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vmech/dynamics/in_hand/virtual_coupling.h"
#include "vmech/dynamics/loads/load_study.h"
#include "vmech/dynamics/reactions/rule.h"
#include "vmech/kinematics/motion/motion_law.h"
#include "vmech/mechanisms/mechanism.h"

namespace vmech {

/// One freedom of a joint.
struct FreedomId {
  int joint = -1;   ///< index in Mechanism::joints; -1: none
  int freedom = 0;  ///< counted from 0
};

/// A number over time: linear between rows, a single row is constant. A table without a period
/// keeps its first value before it and its last one behind it.
struct TimeTable {
  std::vector<double> at;      ///< [s], increasing
  std::vector<double> values;  ///< as many
  double period = 0;           ///< after which the table repeats [s]; 0 if it does not

  /// Precondition: not empty.
  double At(double time) const;
};

/// A motor that exerts what its law says, and moves as that makes it. (A motor that moves as
/// prescribed, whatever force that takes, is a JointDrive; at a given speed it is
/// MotionLaw::Uniform.)
struct JointMotor {
  /// How its force comes about.
  enum class Law {
    kForce,       ///< F(t) of `force`
    kController,  ///< stiffness (wanted position - q) + damping (wanted rate - q')
  };

  FreedomId at;           ///< not of a spherical joint
  Law law = Law::kForce;  ///< decides which of the following count
  TimeTable force;        ///< kForce [N] or [N m]
  MotionLaw wanted;       ///< kController: position and rate
  double stiffness = 0;   ///< >= 0 [N/m] or [N m/rad]; 0 holds the speed alone
  double damping = 0;     ///< >= 0 [N s/m] or [N m s/rad]
  double max_force = std::numeric_limits<double>::infinity();  ///< > 0 [N] or [N m]
};

/// A hand that holds a grasp by a spring and a damper, and moves as its table or its callback says.
struct GraspSpring {
  int grasp = -1;                          ///< index in Mechanism::grasps
  HandLaw law;                             ///< a pose table, or
  std::function<HandSample(double)> hand;  ///< a callback of time, if there is one
  HandCoupling coupling;                   ///< rotational rows do not count for a point grasp
};

/// What happens at the limits of a freedom (Joint::lower, upper): it rebounds with `restitution`
/// times its speed until it rests there.
struct LimitRebound {
  FreedomId at;            ///< with a limit that is finite
  double restitution = 0;  ///< [0, 1]; that of freedoms that are not named is 0
};

/// A coordinate of a joint that is looked out for.
struct CoordinateWatch {
  FreedomId at;           ///< whose coordinate
  double value = 0;       ///< [m] or [rad]; an angle counts whole turns, as the coordinate does
  bool ends_run = false;  ///< the simulation ends there
};

/// The rate of one freedom at the start.
struct StartRate {
  FreedomId at;     ///< any freedom of any joint
  double rate = 0;  ///< [m/s] or [rad/s]; of a spherical joint about x, y or z of its second anchor
};

/// Where a simulation starts.
enum class SimulationStart {
  kAsDrawn,      ///< at the mechanism's start values, its loops closed
  kEquilibrium,  ///< at the static equilibrium that is reached from there, at rest
};

/// What is to be simulated: a mechanism, what acts on it, and where it starts. Springs, dampers,
/// dry friction (constant, and in proportion to loads) and limits are those of its joints.
struct Simulation {
  Mechanism mechanism;  ///< as its file describes it

  std::vector<JointDrive> drives;  ///< freedoms that move as prescribed, whatever force that takes
  std::vector<JointMotor> motors;  ///< that exert forces or controllers
  /// Wrenches on links. Tables over a drive's coordinate are read at `table_coordinate`.
  std::vector<ExternalLoad> external;
  /// The first drive's, or else the first motor's, if it is not given.
  std::optional<FreedomId> table_coordinate;
  std::optional<GraspSpring> hand;     ///< holds one grasp, or nobody does
  std::vector<LimitRebound> rebounds;  ///< of freedoms with limits

  SimulationStart start = SimulationStart::kAsDrawn;  ///< as drawn, or at its equilibrium
  /// Rates that are not given follow from these: the motion with the least kinetic energy. What
  /// does not fit together by rounding is projected (SimulationResult::moved_rates); by more it is
  /// refused.
  std::vector<StartRate> start_rates;

  std::vector<double> times;  ///< of the results [s], increasing, at least two; starts at the first
  std::vector<CoordinateWatch> watches;  ///< looked out for all the time

  ReactionRule rule = ReactionRule::kStiffness;  ///< as LoadStudy::rule; not kPaperJoint
  double norm_length = 0;                        ///< as LoadStudy::norm_length [m]
  DisplayUnits units;                            ///< of messages
};

/// Does the simulation say what it needs to, without contradiction?
/// @throws std::invalid_argument naming the field, its value and what it must be.
void RequireValid(const Simulation& simulation);

/// Who integrates.
enum class SimulationMethod {
  kAutomatic,  ///< Adams, and BDF from where the mechanism proves stiff
  kAdams,      ///< CVODES, Adams-Moulton of order 1 to 12, fixed-point iteration
  kBdf,        ///< CVODES, backward differences of order 1 to 5, Newton iteration: stiff mechanisms
  kIdas,       ///< IDAS on the stabilised index-2 equations: an independent check, without events
};

/// The method in words.
constexpr std::string_view NameOf(SimulationMethod method) {
  switch (method) {
    case SimulationMethod::kAutomatic:
      return "automatic";
    case SimulationMethod::kAdams:
      return "adams";
    case SimulationMethod::kBdf:
      return "bdf";
    case SimulationMethod::kIdas:
      return "idas";
  }
  return "";
}

/// How a simulation is integrated, and how exactly.
struct SimulationOptions {
  SimulationMethod method = SimulationMethod::kAutomatic;  ///< which integrator, on which equations
  /// Local error of coordinates and rates, relative, [1e-14, 1e-2]. Chaotic and fast mechanisms
  /// need less.
  double relative_tolerance = 1e-10;
  /// The same of what is near zero, in radians and characteristic lengths (a second for rates),
  /// [1e-15, 1e-2].
  double absolute_tolerance = 1e-10;
  /// Loop error, dimensionless, beyond which the run is brought back on its loops, [1e-13, 1e-3];
  /// 0: ten times what the tolerances above leave of the coordinates. Results are closed to 1e-12.
  double drift_tolerance = 0;
  double max_step = 0;          ///< longest step [s], in [0, 1e12]; 0: no bound
  long max_steps = 10'000'000;  ///< most steps of the integrator, in [1, 1e15]
  bool loads = true;            ///< whether the joints' wrenches are wanted
  bool link_motions = true;     ///< whether PoseLoads::links is wanted
  /// Called now and then with the time that has been reached [s]; false stops the run, which keeps
  /// all that it has computed.
  std::function<bool(double time)> progress;

  void Validate() const;  ///< @throws std::invalid_argument naming field, value and range
};

}  // namespace vmech
