#pragma once

#include "vmech/dynamics/in_hand/coupled_dynamics.h"
#include "vmech/hw_interface/safety/safety_filter.h"

namespace vmech {

/// What a device that holds a mechanism can render of it.
struct CouplingChoice {
  HandCoupling coupling;     ///< at the hand
  double scale = 1;          ///< s, force at the hand over force at the mechanism
  double inertia_ratio = 0;  ///< lambda: largest inertia of the mechanism over the handle's own
  double weight = 0;         ///< force of the mechanism on a hand that keeps it here [N]
  /// The work that a sample cannot tell: that of the largest wrench along a step of the encoders,
  /// between 0.02 and 0.5 [J].
  double unseen_work = 0.02;
  DeviceInfo device;  ///< that it was chosen for

  /// Safety for a stiff coupling behind encoders: work that they cannot tell is forgiven, ten times
  /// as much trips, and the force may change as fast as the coupling's, WithoutBlows.
  SafetyOptions Safety() const;
};

/// Spring and damper between a mechanism at the closed pose q and the hand at a device, such that
/// inertia is felt within 5 % below 3 Hz and the device stays stable with nobody holding it. A mass
/// m_v on a spring of stiffness K is felt as m_v / (1 - w^2 m_v/K), which asks for w_v =
/// (K/m_v)^1/2 of 100/s; a handle of mass m behind a hold of T/2, a delay t_d and a velocity filter
/// of time constant t_f bears w_d = (K/m)^1/2 of 0.7 / (T/2 + t_d + t_f), less where its encoders
/// are coarse, or where a hand of 0.15 m/s would change the force by more than a tenth of the
/// device's peak in a period. So
///
///   K = D w^2,  B = 2 z D w,  w = min(1.2 w_v (s lambda)^1/2, w_d),  z = 0.4,
///
/// D the handle's masses, s the scale, lambda the largest of N' M N x = lambda (J N)' D J N x, N
/// the free motions; near a dead centre of the hand, where it has no bound, four times the least of
/// the poses about. s is what is asked for; if that is 0: 1, but less where lambda asks for more
/// than w_d, or the weight for more than half of the device's peak force. A spring that is stiffer
/// than s needs would pass on the steps of the encoders and nothing else. But w is not below the
/// less of 1.2 w_v lambda^1/2 and w_q, at which such a step pulls with 2 % of the peak, so that
/// constraints stay firm. A device that states no masses gets a soft spring, watched by the
/// passivity controller. @throws std::invalid_argument if the mechanism has no freedom at q.
CouplingChoice ChooseCoupling(const KinematicTree& tree, const GraspFrame& grasp, const VectorXd& q,
                              const DeviceInfo& device, double smoothing, double scale = 0);

/// lambda above. 0 for a device that states no masses.
double InertiaRatio(const KinematicTree& tree, const GraspFrame& grasp, const VectorXd& q,
                    const DeviceInfo& device);

/// The handle's masses [kg, kg m^2] on the diagonal; without rotations for a point grasp.
Vector6d HandleMasses(const GraspFrame& grasp, const DeviceInfo& device);

}  // namespace vmech
