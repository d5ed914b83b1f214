#include "vmech/hw_interface/probing/probe_ticks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "vmech/base/check_range.h"

namespace vmech {
namespace {

constexpr double kRest = 0.5;        // [s] between two axes
constexpr int kLevels = 12;          // of the blows
constexpr double kBlowEvery = 0.25;  // [s]

Vector3d Within(const Vector3d& f, double largest) {
  const double length = f.norm();
  return length > largest ? Vector3d(largest / length * f) : f;
}

TickOutput Force(const Vector3d& f) {
  TickOutput out;
  out.F_Ho_W << f, Vector3d::Zero();
  return out;
}

/// Five sines of one speed for a mass, at most 1 in all.
double Sines(double time) {
  constexpr std::array<double, 5> kHertz{0.9, 1.7, 3.1, 5.3, 8.9};
  double sum = 0, total = 0;
  for (std::size_t i = 0; i < kHertz.size(); ++i) {
    const double phase = static_cast<double>(i * i);
    sum += kHertz[i] * std::sin(2 * std::numbers::pi * kHertz[i] * time + phase);
    total += kHertz[i];
  }
  return sum / total;
}

/// How long a blow of this force may push a mass: to a tenth of a metre per second [s].
double PushTime(double force, double mass, double period) {
  const double wanted = 0.1 * mass / force;
  return period * std::clamp(std::round(wanted / period), 3.0, 30.0);
}

}  // namespace

SafetyOptions ProbeSafety(double force, double speed) {
  SafetyOptions safety;
  safety.soft_start = 0.2;
  safety.max_force = force;
  safety.force_slew = 5e4;
  safety.max_speed = 2 * speed;
  safety.passivity.enabled = false;
  safety.passivity.forgiven = 1;
  return safety;
}

void HandleSpring::Update(const Vector3d& p, double elapsed) noexcept {
  constexpr double kSmoothing = 5e-3;  // [s]
  if (has_pose_) {
    const double dt = std::max(elapsed, period_);
    v_ += std::min(1.0, dt / kSmoothing) * ((p - p_) / dt - v_);
  } else {
    v_.setZero();
  }
  p_ = p;
  has_pose_ = true;
}

void ShakeOptions::Validate() const {
  CheckRange("ShakeOptions", "force", force, 0.01, 100);
  CheckRange("ShakeOptions", "reach", reach, 1e-4, 0.2);
  CheckRange("ShakeOptions", "speed", speed, 1e-3, 1);
  CheckRange("ShakeOptions", "seconds", seconds, 1, 100);
  CheckRange("ShakeOptions", "blows_to", blows_to, 0, 1e3);
  CheckRange("ShakeOptions", "mass", mass, blows_to > 0 ? 1e-4 : 0, 1e3);
}

double ShakeOptions::total_seconds() const noexcept {
  return 3 * ((blows_to > 0 ? kLevels * kBlowEvery : seconds) + kRest);
}

ShakeTick::ShakeTick(const ShakeOptions& options, double period)
    : options_(options),
      period_(period),
      spring_(options.force / 0.1, 0.5 * options.force, period) {
  options_.Validate();
}

void ShakeTick::Reset() noexcept {
  ticks_ = 0;
  axis_ = -1;
  spring_.Reset();
}

TickOutput ShakeTick::Step(const TickInput& input, std::span<double> channels) noexcept {
  const Vector3d& p = input.state->X_DH.p;
  if (ticks_ == 0) start_ = p;
  if (input.fresh) spring_.Update(p, input.elapsed);
  const double each = options_.total_seconds() / 3;
  const double now = static_cast<double>(ticks_++) * period_;
  const int axis = std::min(2, static_cast<int>(now / each));
  if (axis != axis_) gain_ = 0.02 * options_.force;
  axis_ = axis;
  const double time = now - axis * each - kRest;
  double blow = 0;
  Vector3d f = spring_.Pull(start_);
  if (options_.blows_to > 0) {
    f[axis] += Struck(time, &blow);
  } else {
    f[axis] += Shaken(time);
  }
  channels[0] = time > 0 ? axis : -1;
  channels[1] = blow;
  return Force(Within(f, std::max(options_.force, options_.blows_to)));
}

/// The force grows while there is little motion, slower than the slowest sine; what is too fast is
/// taken back at once.
double ShakeTick::Shaken(double time) noexcept {
  constexpr double kGrowth = 0.8, kRetreat = 0.05;  // [s]: by the factor e
  constexpr double kLittle = 0.7;
  if (time < 0) return 0;
  const double way = (spring_.p() - start_).norm() / options_.reach;
  const double speed = spring_.v().norm() / options_.speed;
  if (std::max(way, speed) < kLittle) {
    gain_ = std::min(options_.force, gain_ * (1 + period_ / kGrowth));
  }
  if (speed > 1) gain_ *= 1 - std::min(0.5, period_ / kRetreat);
  return gain_ * Sines(time);
}

/// Forth, twice back, forth: the handle comes to rest where it was.
double ShakeTick::Struck(double time, double* blow) const noexcept {
  const int level = static_cast<int>(std::floor(time / kBlowEvery));
  if (time < 0 || level >= kLevels) return 0;
  const double force = options_.blows_to * std::pow(1.3, level + 1 - kLevels);
  const double push = PushTime(force, options_.mass, period_);
  const double since = time - (level + 0.2) * kBlowEvery;
  if (since < 0 || since >= 4 * push) return 0;
  *blow = force;
  return since < push || since >= 3 * push ? force : -force;
}

GuideTick::GuideTick(const Vector3d& home, double force, double period,
                     std::function<void()> arrived)
    : home_(home),
      force_(force),
      period_(period),
      spring_(force / 0.02, 0.5 * force / 0.1, period),
      arrived_(std::move(arrived)) {}

void GuideTick::Reset() noexcept {
  started_ = false;
  there_for_ = 0;
  spring_.Reset();
}

TickOutput GuideTick::Step(const TickInput& input, std::span<double>) noexcept {
  constexpr double kSpeed = 0.1;     // [m/s]
  constexpr double kThere = 3e-3;    // [m]
  constexpr double kStays = 1. / 3;  // [s]
  constexpr double kAhead = 0.03;    // [m] that the target runs ahead at most
  if (input.fresh) spring_.Update(input.state->X_DH.p, input.elapsed);
  if (!started_) target_ = spring_.p();
  started_ = true;
  const Vector3d left = home_ - target_;
  const double step = kSpeed * period_;
  const bool waits = (target_ - spring_.p()).norm() > kAhead;
  if (!waits) target_ += left.norm() > step ? Vector3d(step * left.normalized()) : left;
  const bool was_there = there_for_ >= kStays;
  there_for_ = distance() < kThere ? there_for_ + period_ : 0;
  if (!was_there && there_for_ >= kStays) arrived_();
  return Force(Within(spring_.Pull(target_), force_));
}

}  // namespace vmech
