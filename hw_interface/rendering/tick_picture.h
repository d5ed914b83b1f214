#pragma once

#include <vector>

#include "vmech/base/pose.h"

namespace vmech {

/// What a screen shows and a recording keeps of a mechanism in a hand. World axes, SI.
struct TickPicture {
  VectorXd q, v;                ///< of the mechanism's tree [nq], [nv]
  std::vector<Wrenchd> joints;  ///< every joint's wrench, as JointSample
  Posed X_WH, X_WG;             ///< the hand and the grasp frame
  bool holds = true;
  Vector6d F_Ho_W = Vector6d::Zero();      ///< what the hand is to feel, about Ho
  Vector6d dynamic = Vector6d::Zero();     ///< w_d: moves the mechanism, about Go
  Vector6d constraint = Vector6d::Zero();  ///< w_c: what the mechanism does not allow, about Go
};

}  // namespace vmech
