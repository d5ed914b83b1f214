#pragma once

#include <cstdlib>

#include "vmech/hw_interface/rendering/tick.h"
#include "vmech/kinematics/loops/assembly.h"

namespace vmech {

/// The closed pose at the file's start values.
inline VectorXd ClosedStart(const KinematicTree& tree) {
  VectorXd q = StartCoordinates(tree);
  if (!Assemble(tree, {}, &q).closed) std::abort();
  return q;
}

/// A hand that holds on, sampled one period after the last time.
inline TickInput FreshInput(const Posed& X_WH, double period) {
  TickInput input;
  input.X_WH = X_WH;
  input.fresh = true;
  input.elapsed = period;
  return input;
}

}  // namespace vmech
