#include "vmech/hw_interface/masters/simulated_master.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "vmech/base/check_range.h"

namespace vmech {
namespace {

/// Puts a target in the handle's start pose and a squeeze of nothing where none is given.
SimulatedMasterOptions Completed(SimulatedMasterOptions options, const Posed& X_DH) {
  options.Validate();
  if (!options.motion) options.motion = HoldAt(X_DH);
  if (!options.squeeze) options.squeeze = [](double) { return 0.0; };
  return options;
}

double Quantised(double value, double count) {
  return count > 0 ? count * std::round(value / count) : value;
}

}  // namespace

void SimulatedMasterOptions::Validate() const {
  CheckRange("SimulatedMasterOptions", "period", period, 1e-5, 0.1);
  CheckRange("SimulatedMasterOptions", "substeps", substeps, 1, 100);
  if (encoder_bits != 0) CheckRange("SimulatedMasterOptions", "encoder_bits", encoder_bits, 8, 24);
  CheckRange("SimulatedMasterOptions", "delay_periods", delay_periods, 0, 16);
  CheckRange("SimulatedMasterOptions", "lost_share", lost_share, 0, 0.999);
  CheckRange("SimulatedMasterOptions", "stop_stiffness", stop_stiffness, 1e-9, 1e6);
  CheckRange("SimulatedMasterOptions", "stop_damping", stop_damping, 0, 1e4);
  CheckRange("SimulatedMasterOptions", "hand.mass", hand.mass, 0, 5);
  CheckRange("SimulatedMasterOptions", "hand.stiffness", hand.stiffness, 0, 1e6);
  CheckRange("SimulatedMasterOptions", "hand.damping", hand.damping, 0, 1e4);
  CheckRange("SimulatedMasterOptions", "hand.angular_stiffness", hand.angular_stiffness, 0, 1e6);
  CheckRange("SimulatedMasterOptions", "hand.angular_damping", hand.angular_damping, 0, 1e4);
  CheckRange("SimulatedMasterOptions", "gripper_damping", gripper_damping, 1e-6, 1e3);
}

SimulatedMaster::SimulatedMaster(const SimulatedMasterOptions& options)
    : SimulatedMaster(options, SarcosMasterArm()) {}

SimulatedMaster::SimulatedMaster(SimulatedMasterOptions options, ArmDescription arm)
    : arm_(std::make_shared<const ArmDescription>(WithMassAtHandle(arm, options.hand.mass))),
      sensed_(std::make_shared<const ArmDescription>(std::move(arm))),
      count_(options.encoder_bits > 0 ? std::ldexp(2 * std::numbers::pi, -options.encoder_bits)
                                      : 0),
      q_(arm_.description().posture),
      v_(VectorXd::Zero(arm_.joints())),
      measured_(q_),
      motor_(v_),
      passive_(v_),
      trial_q_(v_),
      trial_v_(v_),
      losses_(options.seed) {
  options_ = Completed(std::move(options), arm_.X_DH());
  period_ns_ = std::llround(options_.period * 1e9);
  stages_.fill({v_, v_});
}

DeviceInfo SimulatedMaster::OnConfigure() {
  DeviceInfo info;
  info.name = "simulated " + arm_.description().tree.mechanism.name;
  info.period = options_.period;
  info.delay = options_.delay_periods * options_.period;
  info.senses = kSensesPose | kSensesJoints | kSensesGripper | kSensesAppliedWrench | kSensesEcho;
  info.takes_wrench = info.takes_torque = true;
  info.arm = sensed_.shared_description();
  sensed_.SetPosture(arm_.description().posture.data());
  info.linear = PhysicsOf(sensed_.J().topRows<3>());
  info.angular = PhysicsOf(sensed_.J().bottomRows<3>());
  const WrenchLimit room = sensed_.WrenchRoom(sensed_.TorqueRoom());
  info.linear.peak = room.force;
  info.angular.peak = room.moment;
  info.linear.max_speed = 2;
  info.angular.max_speed = 15;
  return info;
}

/// Along the weakest of three directions: 1/m = u' J M^-1 J' u, 1/b = u' J D^-1 J' u at most.
HandlePhysics SimulatedMaster::PhysicsOf(const MatrixXd& J_part) noexcept {
  const KinematicTree& tree = arm_.description().tree;
  VectorXd damping(arm_.joints());
  for (const TreeNode& node : tree.nodes) {
    if (node.v >= 0) damping[node.v] = tree.mechanism.joints[node.joint].passive[0].viscous;
  }
  const Matrix3d mobility = J_part * sensed_.MassMatrix().llt().solve(J_part.transpose());
  const Matrix3d yielding =
      J_part * (J_part.transpose().array().colwise() / damping.array()).matrix();
  HandlePhysics physics;
  // The trace bounds the largest eigenvalue from above: never more mass or damping than there is.
  physics.mass = 1 / mobility.trace();
  physics.damping = damping.minCoeff() > 0 ? 1 / yielding.trace() : 0;
  physics.resolution = count_ * J_part.colwise().norm().sum();
  return physics;
}

void SimulatedMaster::SetIdle() noexcept {
  pipeline_.fill(MasterCommand{});
  current_ = MasterCommand{};
}

IoStatus SimulatedMaster::OnRead(std::int64_t now_ns, MasterState* state) noexcept {
  if (periods_ < 0) {
    start_ns_ = now_ns;
    periods_ = 0;
    Measure();
  }
  const std::int64_t due = (now_ns - start_ns_ + period_ns_ / 2) / period_ns_ - periods_;
  const std::int64_t steps = std::min<std::int64_t>(due, kMaxCatchUp);
  if (due > steps) start_ns_ += (due - steps) * period_ns_;  // the simulation stood still
  for (std::int64_t i = 0; i < steps; ++i) AdvancePeriod();

  *state = MasterState{};
  state->sequence = static_cast<std::uint64_t>(periods_);
  state->device_time_ns = start_ns_ + periods_ * period_ns_;
  state->valid = info().senses;
  state->dead_man = dead_man_;
  state->emergency_stop = emergency_stop_;
  state->command_echo = current_.sequence;
  state->X_DH = sensed_.X_DH();
  state->applied_F_Ho_D = applied_;
  for (int i = 0; i < arm_.joints(); ++i) state->q[i] = measured_[i];
  state->gripper_opening = Quantised(gripper_, count_);
  return steps > 0 || periods_ == 0 ? IoStatus::kOk : IoStatus::kNoNewData;
}

IoStatus SimulatedMaster::OnWrite(const MasterCommand& command) noexcept {
  const double lot = std::generate_canonical<double, 32>(losses_);
  if (lot >= options_.lost_share) pipeline_[0] = command;
  return IoStatus::kOk;
}

void SimulatedMaster::AdvancePeriod() noexcept {
  TakeCommand();
  MotorTorques();
  const double dt = options_.period / options_.substeps;
  for (int i = 0; i < options_.substeps; ++i) Step(dt);
  MoveGripper();
  ++periods_;
  Measure();
}

/// The command that is now at the motors: it has gone through `delay_periods` places.
void SimulatedMaster::TakeCommand() noexcept {
  current_ = pipeline_[options_.delay_periods];
  std::move_backward(pipeline_.begin(), pipeline_.end() - 1, pipeline_.end());
  const bool expired = start_ns_ + periods_ * period_ns_ > current_.valid_until_ns;
  if (expired) current_ = MasterCommand{};
}

/// Gravity compensation and the command, in the direction asked for and within the limits.
void SimulatedMaster::MotorTorques() noexcept {
  motor_.setZero();
  if (current_.mode == CommandMode::kWrench) {
    motor_.noalias() = sensed_.J().transpose() * current_.F_Ho_D;
  } else if (current_.mode == CommandMode::kJointTorque) {
    for (int i = 0; i < arm_.joints(); ++i) motor_[i] = current_.torque[i];
  }
  if (!motor_.allFinite()) motor_.setZero();
  passive_.setZero();
  if (options_.compensates_gravity) passive_ = sensed_.GravityTorques();
  // Largest s in [0, 1] with |gravity + s command| <= limit.
  double scale = 1;
  for (int i = 0; i < arm_.joints(); ++i) {
    const double limit = arm_.description().torque_limit[i];
    const double room = std::max(0.0, limit - std::abs(passive_[i]));
    if (std::abs(motor_[i]) > room) scale = std::min(scale, room / std::abs(motor_[i]));
  }
  applied_ =
      current_.mode == CommandMode::kZero ? Vector6d::Zero().eval() : scale * current_.F_Ho_D;
  motor_ = passive_ + scale * motor_;
}

void SimulatedMaster::Differentiate(double time, const VectorXd& q, const VectorXd& v,
                                    Derivative* d) noexcept {
  const KinematicTree& tree = arm_.description().tree;
  arm_.SetPosture(q.data());
  for (const TreeNode& node : tree.nodes) {
    if (node.v < 0) continue;
    const Joint& joint = tree.mechanism.joints[node.joint];
    const double x = q[node.v];
    double torque = -joint.passive[0].viscous * v[node.v];
    const double beyond = x - std::clamp(x, joint.lower[0], joint.upper[0]);
    if (beyond != 0) {
      torque -= options_.stop_stiffness * beyond + options_.stop_damping * v[node.v];
    }
    passive_[node.v] = motor_[node.v] + torque;
  }
  const Vector6d V_DH = arm_.J() * v;
  Wrenchd hand = OperatorWrench(options_.hand, options_.motion(time), arm_.X_DH(), V_DH);
  hand.force -= options_.hand.mass * tree.mechanism.gravity_W;
  d->v = v;
  d->a = arm_.Accelerations(v, passive_, hand);
}

/// The classical Runge-Kutta step of fourth order; motors and gripper constant.
void SimulatedMaster::Step(double dt) noexcept {
  constexpr std::array<double, 4> kReach{0, 0.5, 0.5, 1};
  for (int i = 0; i < 4; ++i) {
    trial_q_ = q_;
    trial_v_ = v_;
    if (i > 0) {
      trial_q_ += kReach[i] * dt * stages_[i - 1].v;
      trial_v_ += kReach[i] * dt * stages_[i - 1].a;
    }
    Differentiate(time_ + kReach[i] * dt, trial_q_, trial_v_, &stages_[i]);
  }
  q_ += dt / 6 * (stages_[0].v + 2 * stages_[1].v + 2 * stages_[2].v + stages_[3].v);
  v_ += dt / 6 * (stages_[0].a + 2 * stages_[1].a + 2 * stages_[2].a + stages_[3].a);
  time_ += dt;
}

/// A gripper without mass: damping x' = squeeze and motor, between closed and open.
void SimulatedMaster::MoveGripper() noexcept {
  const GripperRange range;
  const double wanted = current_.mode == CommandMode::kZero ? 0 : current_.gripper_torque;
  const double motor = std::clamp(wanted, -range.torque_limit, range.torque_limit);
  const double rate = (motor - options_.squeeze(time_)) / options_.gripper_damping;
  gripper_ = std::clamp(gripper_ + options_.period * rate, range.closed, range.open);
}

void SimulatedMaster::Measure() noexcept {
  for (int i = 0; i < arm_.joints(); ++i) measured_[i] = Quantised(q_[i], count_);
  sensed_.SetPosture(measured_.data());
}

double SimulatedMaster::Energy() noexcept {
  arm_.SetPosture(q_.data());
  const Vector3d& g = arm_.description().tree.mechanism.gravity_W;
  const double of_hand = -options_.hand.mass * g.dot(arm_.X_DH().p);
  return 0.5 * v_.dot(arm_.MassMatrix() * v_) + arm_.PotentialEnergy() - of_hand;
}

}  // namespace vmech
