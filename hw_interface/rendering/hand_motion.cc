#include "vmech/hw_interface/rendering/hand_motion.h"

namespace vmech {

HandMotion HandMotionOf(const HandLaw& law, const Registration& registration) {
  return [law, registration](double time) {
    const HandSample hand = law.At(time);
    const Matrix3d R_DW = registration.X_WD.R.transpose();
    HandTargetMotion target;
    target.X_DT = registration.X_WD.inverse() * hand.X_WH;
    target.X_DT.R *= registration.R_HK.transpose();
    target.V_DT = Stacked<double>(R_DW * hand.V_WH.head<3>(), R_DW * hand.V_WH.tail<3>());
    return target;
  };
}

}  // namespace vmech
