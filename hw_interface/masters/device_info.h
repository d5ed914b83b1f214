#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>

#include "vmech/hw_interface/arm/arm_model.h"

namespace vmech {

/// What a master can tell about itself, bit by bit; also which fields of a MasterState are valid.
enum Sense : std::uint32_t {
  kSensesPose = 1u << 0,           ///< X_DH
  kSensesTwist = 1u << 1,          ///< V_DH
  kSensesJoints = 1u << 2,         ///< q
  kSensesGripper = 1u << 3,        ///< gripper_opening
  kSensesAppliedWrench = 1u << 4,  ///< F_Ho_D of the period before
  kSensesButtons = 1u << 5,        ///< buttons
  kSensesEcho = 1u << 6,           ///< command_echo
};

/// The mechanics of a handle along its worst direction for each figure: for translations in N, m,
/// kg and for rotations in N m, rad, kg m^2. Zero means unknown or none.
struct HandlePhysics {
  double mass = 0;        ///< apparent at the handle, the least [kg] or [kg m^2]
  double damping = 0;     ///< physical viscous damping b, the least [N s/m] or [N m s/rad]
  double coulomb = 0;     ///< physical dry friction f_c, the least [N] or [N m]
  double resolution = 0;  ///< step of the measured pose, the coarsest [m] or [rad]
  double peak = 0;        ///< largest force or moment that it can exert in any direction [N], [N m]
  double max_speed = std::numeric_limits<double>::infinity();  ///< trips above [m/s] or [rad/s]
};

/// What a master states about its own physics; from it the bounds of stable gains are computed
/// (stability.h).
struct DeviceInfo {
  std::string name;               ///< maker and model, for reports
  double period = 1e-3;           ///< T, between two samples [s]
  double delay = 0;               ///< from a command to its torque, beyond the sampling [s]
  std::uint32_t senses = 0;       ///< bits of Sense
  bool takes_wrench = false;      ///< CommandMode::kWrench
  bool takes_torque = false;      ///< CommandMode::kJointTorque
  bool has_dead_man = false;      ///< MasterState::dead_man is a real switch
  HandlePhysics linear, angular;  ///< at the nominal posture
  bool observed = false;  ///< its samples come with the hand as an observer knew it: a recording's
  /// The arm behind the handle, where the master is one; needed for joint torques.
  std::shared_ptr<const ArmDescription> arm;
};

}  // namespace vmech
