#include "vmech/hw_interface/tick.h"

namespace vmech {

Registration GraspedAt(const Matrix3d& R_WD, const Posed& X_DH, const Posed& X_WG) noexcept {
  Registration registration;
  registration.X_WD = {R_WD, X_WG.p - R_WD * X_DH.p};
  registration.R_HK = (R_WD * X_DH.R).transpose() * X_WG.R;
  return registration;
}

}  // namespace vmech
