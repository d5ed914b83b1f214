#include "vmech/hw_interface/tick.h"

#include "vmech/kinematics/screw_algebra.h"

namespace vmech {

Posed Registration::HandInWorld(const Posed& X_DH) const noexcept {
  const Axes X_WK = AxesOf(X_WD) * X_DH;
  return PoseOf(Turned(X_WK, R_HK, X_WK.p));
}

ObservedHand Registration::Observed(const Posed& X_DH, const Vector6d& V_DH) const noexcept {
  const Vector3d v = V_DH.head<3>(), w = V_DH.tail<3>();
  return {HandInWorld(X_DH), Stacked<double>(X_WD.R * v, X_WD.R * w)};
}

Registration GraspedAt(const Matrix3d& R_WD, const Posed& X_DH, const Posed& X_WG) noexcept {
  Registration registration;
  registration.X_WD = {R_WD, X_WG.p - R_WD * X_DH.p};
  registration.R_HK = (R_WD * X_DH.R).transpose() * X_WG.R;
  return registration;
}

}  // namespace vmech
