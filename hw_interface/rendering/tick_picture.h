#pragma once

#include <cstdint>
#include <vector>

#include "vmech/base/pose.h"

namespace vmech {

/// A hand on a mechanism. World axes, SI.
struct HandPicture {
  Posed X_WH, X_WG;                        ///< the hand and the grasp frame
  bool holds = true;                       ///< the hand has not let go
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
  // Of a mechanism whose design is varied (VariedTick):
  VectorXd design;                  ///< values of its parameters; empty: it is not
  std::uint64_t design_number = 0;  ///< of the design that it goes to
  bool design_arrived = true;       ///< there
  bool design_stopped = false;      ///< or where its loops close no further
  double design_work = 0;           ///< of the changes on the mechanism [J]

  HandPicture& hand(int i) noexcept { return i == 0 ? *this : others[i - 1]; }  ///< counted from 0
  /// Counted from 0.
  const HandPicture& hand(int i) const noexcept { return i == 0 ? *this : others[i - 1]; }
};

}  // namespace vmech
