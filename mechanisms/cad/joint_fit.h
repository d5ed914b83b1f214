#pragma once

#include <vector>

#include "vmech/mechanisms/mechanism.h"

namespace vmech {

/// How two anchors as drawn lie to each other, seen by a joint between them.
struct JointFit {
  double distance = 0;        ///< of the origins [m]
  double angle = 0;           ///< between the z axes [rad]
  std::vector<double> start;  ///< coordinates of the joint that come nearest (Joint::start)
  double gap = 0;             ///< distance that is left at these [m]
  double skew = 0;            ///< rotation that is left [rad]
};

/// X_FM is the pose of the second anchor in the first. Not for screws.
JointFit FitJoint(JointType type, const Posed& X_FM);

}  // namespace vmech
