#pragma once

#include "vmech/hw_interface/estimation/hand_observer.h"
#include "vmech/hw_interface/rendering/mechanism_tick.h"
#include "vmech/hw_interface/safety/safety_filter.h"

namespace vmech {

/// What a user may ask of the paper's way; zeros leave it to the device.
struct PaperRequest {
  double scale = 0;      ///< force felt over the mechanism's own
  double stiffness = 0;  ///< of the constraint [N/m]
  double inertia = 0;    ///< share of the inertia, whatever the device can render
  ContactKind contact = ContactKind::kLinear;          ///< the law by which the constraint pulls
  EstimatorKind estimator = EstimatorKind::kObserver;  ///< source of velocities and accelerations
  WrenchRule wrench = WrenchRule::kWorkless;           ///< workless, or as the paper prints it
};

/// The paper's way of rendering for a device and a mechanism.
struct PaperChoice {
  MechanismTickOptions tick;           ///< gains that the device can render
  HandObserverOptions observer;        ///< where the device is an arm
  SafetyOptions safety;                ///< bounds of the device
  Vector6d weight = Vector6d::Zero();  ///< what keeps the mechanism here, not scaled [N, N m]
  double inertia_ratio = 0;            ///< of the mechanism over the handle here; 0: masses unknown
};

/// For a hand that takes hold at the closed pose q. The device renders an inertia of up to R times
/// the handle's own masses: by an acceleration that rolls off with t behind a hold of T/2, a delay
/// t_d and a velocity filter, whose gain at high frequencies is that of a damper M/t on a mass m,
///
///   R = r t / (T/2 + t_d),
///
/// with r = 0.15 where a HandObserver knows what the arm's own force does to the handle, and less
/// where it has to be found in samples, or in steps of more than half a millimetre. Where the
/// weight is more than half of the device's peak force, or a quarter of the inertia more than can
/// be rendered, all forces are scaled down. Passivity is watched with a grace of what the device's
/// peak does along one step of its encoders, between 1 mJ and 0.2 J, and that is forgiven every 0.2
/// s: without it a controller of passivity answers each step of an encoder with a kick. Three times
/// the grace trips, or what is the default.
/// @throws std::invalid_argument as MechanismTick.
PaperChoice ChoosePaper(const PaperRequest& request, const KinematicTree& tree, int grasp,
                        const VectorXd& q, const DeviceInfo& device);

/// Law of the constraint for a device: its own bounds, or the wanted stiffness [N/m] if that is
/// lower; a viscoelastic one takes a third of the device's damping. A device without force gets a
/// stiffness that only weighs positions against rotations.
ContactLaw ContactLawFor(const DeviceInfo& device, double stiffness,
                         ContactKind kind = ContactKind::kLinear);

}  // namespace vmech
