#pragma once

#include <vector>

#include "vmech/base/pose.h"

namespace vmech {

/// A hand on a mechanism. World axes, SI.
struct HandPicture {
  Posed X_WH, X_WG;  ///< the hand and the grasp frame
  bool holds = true;
  Vector6d F_Ho_W = Vector6d::Zero();      ///< what the hand is to feel, about Ho
  Vector6d dynamic = Vector6d::Zero();     ///< w_d: moves the mechanism, about Go
  Vector6d constraint = Vector6d::Zero();  ///< w_c: what the mechanism does not allow, about Go
};

/// What a screen shows and a recording keeps of a mechanism in a hand, or in several: the first is
/// the picture itself. World axes, SI.
struct TickPicture : HandPicture {
  VectorXd q, v;                    ///< of the mechanism's tree [nq], [nv]
  std::vector<Wrenchd> joints;      ///< every joint's wrench, as JointSample
  std::vector<HandPicture> others;  ///< hands beside the first

  HandPicture& hand(int i) noexcept { return i == 0 ? *this : others[i - 1]; }
  const HandPicture& hand(int i) const noexcept { return i == 0 ? *this : others[i - 1]; }
};

}  // namespace vmech
