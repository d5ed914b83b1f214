#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "vmech/hw_interface/masters/master.h"

namespace vmech {

/// A handle that slides along x, y, z and turns about z: four times mass and damping, each with the
/// exact solution of m v' + b v = F under a constant force; a perfect sensor; commands delayed and
/// lost. A hand may hold it: a spring and damper to a moving point, and a mass.
struct PointOptions {
  double mass = 0.5, damping = 2, inertia = 0.005, angular_damping = 0.02;
  double period = 1e-3;
  int delay_periods = 0;
  double lost_share = 0;
  unsigned seed = 1;
  double hand_stiffness = 0, hand_damping = 0;
  double reach = 0, hertz = 1;  // of the hand's target, about each axis
  double peak = 20;
  bool senses_wrench = false;
  double coulomb = 0;         // dry friction along x, y and z [N]
  double saturates_at = 0;    // what the motors give at most, whatever the device states; 0: all
  double resolution = 0;      // steps of the measured position [m]; 0: a perfect sensor
  bool forces_alone = false;  // no moments, and no turning: three freedoms
};

class PointMaster : public Master {
 public:
  explicit PointMaster(const PointOptions& options) : options_(options), random_(options.seed) {}
  ~PointMaster() override { Shutdown(); }

  std::array<double, 4> x{}, v{};  // x, y, z, angle about z
  double given = 0;          // energy given to the hand: beyond what the handle itself loses [J]
  double least_balance = 0;  // smallest -given so far
  std::array<double, 4> force{};  // at work

 private:
  DeviceInfo OnConfigure() override {
    DeviceInfo info;
    info.name = "point";
    info.period = options_.period;
    info.delay = options_.delay_periods * options_.period;
    info.senses = kSensesPose | (options_.senses_wrench ? kSensesAppliedWrench : kSensesEcho);
    info.takes_wrench = true;
    info.linear = {options_.mass, options_.damping, 0, options_.resolution, options_.peak, 5};
    if (options_.forces_alone) return info;
    info.angular = {options_.inertia, options_.angular_damping, 0, 0, 0.05 * options_.peak, 50};
    return info;
  }

  IoStatus OnWrite(const MasterCommand& command) noexcept override {
    const double lot = std::generate_canonical<double, 32>(random_);
    if (lot >= options_.lost_share) pipeline_[0] = command;
    return IoStatus::kOk;
  }

  IoStatus OnRead(std::int64_t now_ns, MasterState* state) noexcept override {
    const auto period_ns = std::llround(options_.period * 1e9);
    if (sequence_ > 0) Advance(now_ns - period_ns);
    *state = MasterState{};
    state->sequence = sequence_++;
    state->valid = info().senses;
    state->dead_man = true;
    state->command_echo = echo_;
    for (int axis = 0; axis < 3; ++axis) state->X_DH.p[axis] = Measured(x[axis]);
    state->X_DH.R = Eigen::AngleAxisd(x[3], Vector3d::UnitZ()).toRotationMatrix();
    state->applied_F_Ho_D << force[0], force[1], force[2], 0, 0, force[3];
    return IoStatus::kOk;
  }

  double Measured(double value) const noexcept {
    const double step = options_.resolution;
    return step > 0 ? step * std::round(value / step) : value;
  }

  void Advance(std::int64_t now_ns) noexcept {
    MasterCommand command = pipeline_[options_.delay_periods];
    std::move_backward(pipeline_.begin(), pipeline_.end() - 1, pipeline_.end());
    if (now_ns > command.valid_until_ns) command = MasterCommand{};
    echo_ = command.sequence;
    const double most = options_.saturates_at, wanted = command.F_Ho_D.head<3>().norm();
    if (most > 0 && wanted > most) command.F_Ho_D *= most / wanted;
    force = {command.F_Ho_D[0], command.F_Ho_D[1], command.F_Ho_D[2], command.F_Ho_D[5]};
    for (int axis = 0; axis < (options_.forces_alone ? 3 : 4); ++axis) {
      const double before = x[axis];
      const double damping = axis < 3 ? options_.damping : options_.angular_damping;
      for (int i = 0; i < kSubsteps; ++i) {
        const double start = x[axis];
        MoveAxis(axis, time_ + i * options_.period / kSubsteps);
        given -= damping * std::pow(x[axis] - start, 2) * kSubsteps / options_.period;
      }
      given += force[axis] * (x[axis] - before);
    }
    time_ += options_.period;
    least_balance = std::min(least_balance, -given);
  }

  /// m v' + b v = F over a substep; the hand's force is that of its start.
  void MoveAxis(int axis, double time) noexcept {
    const double lever2 = axis < 3 ? 1 : 0.0025;
    const double m = axis < 3 ? options_.mass : options_.inertia;
    const double b = axis < 3 ? options_.damping : options_.angular_damping;
    const double dt = options_.period / kSubsteps;
    const double phase = 2 * M_PI * options_.hertz * time + axis;
    const double target = options_.reach * (axis < 3 ? 1 : 10) * (std::sin(phase) - std::sin(axis));
    const double hand =
        lever2 * (options_.hand_stiffness * (target - x[axis]) - options_.hand_damping * v[axis]);
    const double F = WithFriction(force[axis] + hand, m / dt * v[axis], axis);
    const double decay = std::exp(-b / m * dt);
    const double rest = b > 0 ? (1 - decay) * m / b : dt;  // [s]
    const double drift = b > 0 ? (dt - rest) / b : 0.5 * dt * dt / m;
    x[axis] += rest * v[axis] + drift * F;
    v[axis] = decay * v[axis] + rest / m * F;
  }

  /// A force with dry friction, which holds the handle if it can; `stops`: what stops it at once.
  double WithFriction(double F, double stops, int axis) const noexcept {
    const double f = axis < 3 ? options_.coulomb : 0;
    return F - std::clamp(F + stops, -f, f);
  }

  static constexpr int kSubsteps = 4;
  PointOptions options_;
  std::mt19937 random_;
  std::array<MasterCommand, 17> pipeline_;
  double time_ = 0;
  std::uint64_t sequence_ = 0, echo_ = 0;
};

/// A spring and damper to the origin: the virtual side of these tests.
struct Wall {
  double stiffness, damping;
  double lever2 = 0.0025;

  double StoredEnergy(const MasterState& state) const {
    return 0.5 * stiffness * state.X_DH.p.squaredNorm();
  }

  Vector6d Wrench(const MasterState& state, const MasterState& last, double period) const {
    const double angle = std::atan2(state.X_DH.R(1, 0), state.X_DH.R(0, 0));
    const double before = std::atan2(last.X_DH.R(1, 0), last.X_DH.R(0, 0));
    Vector6d F = Vector6d::Zero();
    F.head<3>() = -stiffness * state.X_DH.p - damping / period * (state.X_DH.p - last.X_DH.p);
    F[5] =
        -lever2 * (stiffness * angle + damping / period * std::remainder(angle - before, 2 * M_PI));
    return F;
  }
};

}  // namespace vmech
