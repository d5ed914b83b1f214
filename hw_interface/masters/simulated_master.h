#pragma once

#include <random>

#include "vmech/hw_interface/arm/sarcos_arm.h"
#include "vmech/hw_interface/masters/master.h"
#include "vmech/hw_interface/masters/operator_model.h"

namespace vmech {

/// What the simulated master is like, and who holds it.
struct SimulatedMasterOptions {
  double period = 1e-3;   ///< T [s], in [1e-5, 0.1]
  int substeps = 2;       ///< Runge-Kutta steps per period, 1..100; raise it for stiff operators
  int encoder_bits = 16;  ///< counts per turn are 2^bits; 8..24, or 0 for a perfect encoder
  int delay_periods = 0;  ///< whole periods from a command to its torque, 0..16
  double lost_share = 0;  ///< share of commands that are lost, in [0, 0.999]; the last one holds
  unsigned seed = 1;      ///< of the losses
  bool compensates_gravity = true;  ///< the device carries its own weight, from measured angles
  double stop_stiffness = 300;      ///< of the joints' end stops [N m/rad], in [1e-9, 1e6]
  double stop_damping = 3;          ///< of the same [N m s/rad], in [0, 1e4]
  OperatorImpedance hand = ImpedanceOf(Grip::kRelaxed);  ///< stiffness and damping of the operator
  HandMotion motion;  ///< of the operator's target; none: stays where the handle starts
  /// Moment [N m] with which the operator closes the gripper at a time [s]; none: zero.
  std::function<double(double time)> squeeze;
  double gripper_damping = 0.2;  ///< of the gripper [N m s/rad], in [1e-6, 1e3]

  /// @throws std::invalid_argument naming the field, its value and its range.
  void Validate() const;
};

/// A torque-controlled arm in simulation, with the hand that holds it, of which the device itself
/// knows nothing: what it states are its own mass and room. The hand's mass moves with the handle,
/// its weight is the operator's to carry. Rigid-body dynamics between samples, motors held constant
/// over a period, encoders in whole counts, commands delayed and lost as asked, torques limited as
/// one vector so that their direction stays. Time is the caller's: each Read advances the arm by
/// whole periods up to `now_ns`, at most kMaxCatchUp of them. Same options, same calls: same bits.
class SimulatedMaster : public Master {
 public:
  static constexpr int kMaxCatchUp = 100;  ///< periods that one Read makes up for

  explicit SimulatedMaster(const SimulatedMasterOptions& options = {});  ///< of SarcosMasterArm
  SimulatedMaster(SimulatedMasterOptions options, ArmDescription arm);   ///< of another arm
  ~SimulatedMaster() override { Shutdown(); }

  /// The true joint coordinates [joints; rad or m], which a real master would not show.
  const VectorXd& q() const noexcept { return q_; }
  const VectorXd& v() const noexcept { return v_; }  ///< their velocities [joints; rad/s or m/s]
  double time() const noexcept { return time_; }     ///< simulated [s]
  /// Kinetic energy of the arm with the hand's mass, potential energy of the arm [J].
  double Energy() noexcept;
  /// Holds or releases the dead-man switch.
  void SetDeadMan(bool held) noexcept { dead_man_ = held; }
  /// Presses or releases the emergency stop.
  void SetEmergencyStop(bool pressed) noexcept { emergency_stop_ = pressed; }

 private:
  struct Derivative {
    VectorXd v, a;
  };
  DeviceInfo OnConfigure() override;
  void OnDeactivate() noexcept override { SetIdle(); }
  IoStatus OnRead(std::int64_t now_ns, MasterState* state) noexcept override;
  IoStatus OnWrite(const MasterCommand& command) noexcept override;

  void SetIdle() noexcept;
  void AdvancePeriod() noexcept;
  void TakeCommand() noexcept;
  void MotorTorques() noexcept;
  void Differentiate(double time, const VectorXd& q, const VectorXd& v, Derivative* d) noexcept;
  void Step(double dt) noexcept;
  void MoveGripper() noexcept;
  void Measure() noexcept;
  HandlePhysics PhysicsOf(const MatrixXd& J_part) noexcept;

  SimulatedMasterOptions options_;
  ArmModel arm_;     // the truth with the hand, at any stage of a step
  ArmModel sensed_;  // what the device's own controller knows: at measured angles
  double count_;     // encoder step [rad]
  std::int64_t period_ns_ = 0;
  VectorXd q_, v_, measured_, motor_, passive_, trial_q_, trial_v_;
  std::array<Derivative, 4> stages_;
  double time_ = 0;
  double gripper_ = 0.4;
  std::int64_t start_ns_ = 0;
  std::int64_t periods_ = -1;  // -1: not read yet
  std::array<MasterCommand, 17> pipeline_;
  MasterCommand current_;
  Vector6d applied_ = Vector6d::Zero();
  std::mt19937 losses_;
  bool dead_man_ = true;
  bool emergency_stop_ = false;
};

}  // namespace vmech
