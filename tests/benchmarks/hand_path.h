#pragma once

#include <vector>

#include "vmech/kinematics/inverse/inverse_kinematics.h"

namespace vmech {

/// A hand that leads a mechanism to and fro along a path that the mechanism can follow: what a
/// solver is asked for tick after tick.
class HandPath {
 public:
  /// The grasp's poses while the first joint turns `ticks` times by `step` [rad]. The hand holds
  /// them, moved by `pull` [m] along the world's y: out of reach if that is not zero.
  HandPath(const Mechanism& mechanism, const Grasp& grasp, double step, int ticks, double pull = 0);

  const KinematicTree& tree() const { return tree_; }
  InverseKinematics Problem() const { return {tree_, grasp_}; }
  const VectorXd& start() const { return start_; }
  /// The target of the next tick; after the last it goes back again.
  const Posed& Next();

 private:
  KinematicTree tree_;
  GraspFrame grasp_;
  VectorXd start_;
  std::vector<Posed> targets_;
  int next_ = 0, direction_ = 1;
};

/// The slider-crank of the examples, its coupler led as the crank turns by 1/3 of a degree a tick:
/// one turn a second at 1 kHz.
HandPath SliderCrankPath(double pull = 0);

/// The four-bar with N windows (benchmark_studies.h), its last beam led by posts that turn by 6
/// mrad a tick.
HandPath WindowPath(int windows);

}  // namespace vmech
