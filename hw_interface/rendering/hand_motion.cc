#include "vmech/hw_interface/rendering/hand_motion.h"

#include <algorithm>

namespace vmech {

HandMotion HandMotionOf(const HandLaw& law, double end, const Registration& registration) {
  return [law, end, registration](double time) {
    const HandSample hand = law.At(std::min(time, end));
    const Matrix3d R_DW = registration.X_WD.R.transpose();
    HandTargetMotion target;
    target.X_DT = registration.X_WD.inverse() * hand.X_WH;
    target.X_DT.R *= registration.R_HK.transpose();
    target.V_DT = Stacked<double>(R_DW * hand.V_WH.head<3>(), R_DW * hand.V_WH.tail<3>());
    if (time > end) target.V_DT.setZero();
    return target;
  };
}

}  // namespace vmech
