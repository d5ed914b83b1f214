#include "vmech/hw_interface/rendering/registration.h"

#include "vmech/base/screw_algebra.h"

namespace vmech {

Posed Registration::HandInWorld(const Posed& X_DH) const noexcept {
  const Frame X_WK = FrameOf(X_WD) * FrameOf(X_DH);
  return PoseOf(Rotate(X_WK, R_HK, X_WK.p));
}

void Registration::TakeHandInWorld(const MovingFrame& handle, MovingFrame* hand) const noexcept {
  const Frame D = FrameOf(X_WD), X_WK = D * handle.X;
  hand->X = Rotate(X_WK, R_HK, X_WK.p);
  hand->V = {Rotate(D, handle.V.linear), Rotate(D, handle.V.angular)};
}

Registration GraspedAt(const Matrix3d& R_WD, const Posed& X_DH, const Posed& X_WG) noexcept {
  Registration registration;
  registration.X_WD = {R_WD, X_WG.p - R_WD * X_DH.p};
  registration.R_HK = (R_WD * X_DH.R).transpose() * X_WG.R;
  return registration;
}

}  // namespace vmech
