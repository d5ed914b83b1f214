#include "vmech/hw_interface/rendering/paper_choice.h"

#include <algorithm>
#include <limits>

#include "vmech/hw_interface/rendering/coupling_choice.h"
#include "vmech/hw_interface/safety/stability.h"

namespace vmech {
namespace {

constexpr double kBandwidth = 250;  // of the observer [1/s]
constexpr double kFine = 5e-4;  // [m]: coarser steps of a device are heard, the more the heavier

/// r, by how the acceleration is found.
double RatioFactor(EstimatorKind kind, bool observed) {
  switch (kind) {
    case EstimatorKind::kObserver:
      return observed ? 0.15 : 0.06;
    case EstimatorKind::kAdaptiveWindow:
      return 0.1;
    default:
      return 0.05;
  }
}

/// What the device's largest force does along a step of its encoders [J], and its moment.
double QuantisationEnergy(const DeviceInfo& device) {
  return device.linear.peak * device.linear.resolution +
         device.angular.peak * device.angular.resolution;
}

SafetyOptions SafetyFor(const DeviceInfo& device) {
  constexpr double kLeast = 1e-3, kMost = 0.2;  // [J]
  constexpr double kForgetting = 0.2;           // [s]
  SafetyOptions safety;
  safety.carried_start = true;
  safety.passivity.grace = std::clamp(QuantisationEnergy(device), kLeast, kMost);
  safety.passivity.forgiven = safety.passivity.grace / kForgetting;
  safety.energy_trip = std::max(safety.energy_trip, 3 * safety.passivity.grace);
  // What the passivity controller takes away must go soon; the tick keeps to a slew of its own.
  safety.force_slew = 5e4;
  safety.moment_slew = 2500;
  return WithoutBlows(safety, device);
}

/// Half of what the device can exert carries the weight, and a mechanism of which it renders less
/// than a quarter of the inertia is made lighter: with its whole weight it would fall like nothing.
double ScaleFor(const PaperChoice& choice, const DeviceInfo& device) {
  constexpr double kLeastShare = 0.25, kOfPeak = 0.5;
  double scale = 1;
  const auto bear = [&](double weight, double peak) {
    if (peak > 0 && scale * weight > kOfPeak * peak) scale = kOfPeak * peak / weight;
  };
  bear(choice.weight.head<3>().norm(), device.linear.peak);
  bear(choice.weight.tail<3>().norm(), device.angular.peak);
  const double most = choice.tick.inertia_ratio / kLeastShare;
  return scale * choice.inertia_ratio > most ? most / choice.inertia_ratio : scale;
}

}  // namespace

PaperChoice ChoosePaper(const PaperRequest& request, const KinematicTree& tree, int grasp,
                        const VectorXd& q, const DeviceInfo& device) {
  PaperChoice choice;
  const GraspFrame frame = GraspFrameOf(tree, grasp);
  choice.observer = {.bandwidth = kBandwidth, .lighter = 1};
  choice.safety = SafetyFor(device);
  MechanismTickOptions& tick = choice.tick;
  tick.law = ContactLawFor(device, request.stiffness, request.contact);
  tick.wrench = request.wrench;
  tick.estimator.kind = request.estimator;
  choice.inertia_ratio = InertiaRatio(tree, frame, q, device);
  if (request.inertia > 0) {
    tick.inertia = request.inertia;
  } else {
    tick.handle_masses = HandleMasses(frame, device);
    tick.inertia_ratio =
        RatioFactor(request.estimator, HandObserver::Suits(device) || device.observed) *
        tick.roll_off / (0.5 * device.period + device.delay);
    if (device.linear.resolution > kFine) tick.inertia_ratio *= kFine / device.linear.resolution;
  }
  HandDynamics dynamics(tree, frame, tick.law.stiffness, q);
  if (dynamics.Evaluate(Vector6d::Zero(), Vector6d::Zero())) choice.weight = dynamics.w_d();
  tick.scale = request.scale > 0 ? request.scale : ScaleFor(choice, device);
  if (device.linear.peak > 0) tick.max_force = device.linear.peak;
  if (device.angular.peak > 0) tick.max_moment = device.angular.peak;
  tick.max_speed = 0.5 * device.linear.max_speed;
  tick.max_angular_speed = 0.5 * device.angular.max_speed;
  return choice;
}

ContactLaw ContactLawFor(const DeviceInfo& device, double stiffness, ContactKind kind) {
  constexpr double kNoForce = 1000;     // [N/m]
  constexpr double kLever = 0.05;       // [m], of a hand
  constexpr double kShare = 1.0 / 3.0;  // of the device's damping that a viscoelastic law renders
  ContactLaw law;
  law.kind = kind;
  if (!device.takes_wrench && !device.takes_torque) {
    law.stiffness.head<3>().setConstant(kNoForce);
    law.stiffness.tail<3>().setConstant(kNoForce * kLever * kLever);
    return law;
  }
  RenderingGains wanted;
  wanted.stiffness.setConstant(std::numeric_limits<double>::max());
  if (kind == ContactKind::kViscoelastic) {
    wanted.damping << Vector3d::Constant(kShare * device.linear.damping),
        Vector3d::Constant(kShare * device.angular.damping);
  }
  const RenderingGains gains = LimitedGains(device, wanted);
  law.stiffness = gains.stiffness;
  law.damping = gains.damping;
  // A device that does not state its damping: soft, and watched by the passivity controller.
  if (device.linear.damping == 0) law.stiffness.head<3>().setConstant(kNoForce / 4);
  if (device.angular.damping == 0) {
    law.stiffness.tail<3>() = kLever * kLever * law.stiffness.head<3>();
  }
  if (stiffness > 0 && stiffness < law.stiffness[0]) {
    law.stiffness.tail<3>() *= stiffness / law.stiffness[0];
    law.stiffness.head<3>().setConstant(stiffness);
  }
  return law;
}

}  // namespace vmech
