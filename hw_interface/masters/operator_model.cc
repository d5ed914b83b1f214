#include "vmech/hw_interface/masters/operator_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "vmech/base/rotation_error.h"

namespace vmech {
namespace {

constexpr OperatorImpedance kRelaxedArm{0.554, 135, 6.45, 135 * 0.05 * 0.05, 6.45 * 0.05 * 0.05};

/// The relaxed arm with other stiffness and mass at the same damping ratio.
OperatorImpedance Scaled(double stiffness, double mass) {
  const double damping = std::sqrt(stiffness * mass);
  const OperatorImpedance& arm = kRelaxedArm;
  return {arm.mass * mass, arm.stiffness * stiffness, arm.damping * damping,
          arm.angular_stiffness * stiffness, arm.angular_damping * damping};
}

/// Sum of sines of one axis and its derivative.
struct Wave {
  std::array<double, 3> amplitude, rate, phase;

  double Value(double t) const {
    double sum = 0;
    for (int i = 0; i < 3; ++i) sum += amplitude[i] * std::sin(rate[i] * t + phase[i]);
    return sum;
  }
  double Rate(double t) const {
    double sum = 0;
    for (int i = 0; i < 3; ++i) sum += amplitude[i] * rate[i] * std::cos(rate[i] * t + phase[i]);
    return sum;
  }
};

Wave RandomWave(double amplitude, std::mt19937* random) {
  constexpr std::array<double, 3> kHertz{0.31, 0.94, 2.93};
  constexpr std::array<double, 3> kShare{0.6, 0.3, 0.1};
  std::uniform_real_distribution<double> phase(0, 2 * std::numbers::pi);
  Wave wave;
  for (int i = 0; i < 3; ++i) {
    wave.amplitude[i] = amplitude * kShare[i];
    wave.rate[i] = 2 * std::numbers::pi * kHertz[i];
    wave.phase[i] = phase(*random);
  }
  return wave;
}

Matrix3d Rotation(double angle, const Vector3d& axis) {
  return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
}

}  // namespace

OperatorImpedance ImpedanceOf(Grip grip) {
  switch (grip) {
    case Grip::kAbsent:
      return {};
    case Grip::kLight:
      return Scaled(0.25, 0.5);
    case Grip::kRelaxed:
      return kRelaxedArm;
    case Grip::kFirm:
      return Scaled(10, 1);
  }
  return {};
}

Wrenchd OperatorWrench(const OperatorImpedance& impedance, const HandTargetMotion& target,
                       const Posed& X_DH, const Vector6d& V_DH) noexcept {
  const Vector6d error = HandError(X_DH, target.X_DT);
  const Vector6d slip = target.V_DT - V_DH;
  return {
      impedance.stiffness * error.head<3>() + impedance.damping * slip.head<3>(),
      impedance.angular_stiffness * error.tail<3>() + impedance.angular_damping * slip.tail<3>()};
}

HandMotion HoldAt(const Posed& X_DT) {
  return [X_DT](double) { return HandTargetMotion{X_DT, Vector6d::Zero()}; };
}

HandMotion ReachTo(const Posed& from, const Posed& to, double start, double duration) {
  const Vector6d way = HandError(from, to);
  const double angle = way.tail<3>().norm();
  const Vector3d axis = angle > 0 ? Vector3d(way.tail<3>() / angle) : Vector3d::UnitZ();
  return [=](double time) {
    const double r = std::clamp((time - start) / duration, 0.0, 1.0);
    const double s = r * r * r * (10 + r * (-15 + 6 * r));
    const double rate = 30 * r * r * (1 - r) * (1 - r) / duration;
    return HandTargetMotion{{Rotation(s * angle, axis) * from.R, from.p + s * way.head<3>()},
                            rate * way};
  };
}

HandMotion Wander(const Posed& about, double reach, double turn, unsigned seed) {
  std::mt19937 random(seed);
  std::array<Wave, 4> waves;
  for (int i = 0; i < 4; ++i) waves[i] = RandomWave(i < 3 ? reach : turn, &random);
  const Vector3d axis = Vector3d(std::normal_distribution<double>()(random),
                                 std::normal_distribution<double>()(random), 1)
                            .normalized();
  return [=](double t) {
    HandTargetMotion target;
    target.X_DT.R = Rotation(waves[3].Value(t), axis) * about.R;
    for (int i = 0; i < 3; ++i) {
      target.X_DT.p[i] = about.p[i] + waves[i].Value(t);
      target.V_DT[i] = waves[i].Rate(t);
    }
    target.V_DT.tail<3>() = waves[3].Rate(t) * axis;
    return target;
  };
}

}  // namespace vmech
