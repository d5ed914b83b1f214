#pragma once

#include "vmech/base/four.h"

namespace vmech {

// Vectors in whole registers: a vector of three is a Four whose last number is zero. World axes. In
// screws about the world's origin Wo twists of a chain add up, and wrenches are handed on without
// being shifted; screw_algebra.h computes with them. Functions that return them by value are for
// the sources of the library alone: without AVX g++ puts such temporaries where they are not
// aligned.

/// The axes of a frame B and its origin Bo in the world: X_WB in four columns.
struct Axes {
  Four x = {1, 0, 0, 0}, y = {0, 1, 0, 0}, z = {0, 0, 1, 0}, p = {0, 0, 0, 0};
};

/// A twist: the velocity of what passes Wo, and the angular velocity. Or a wrench: the force, and
/// its moment about Wo. Or either about another point, if its description says so.
struct Screw {
  Four linear{}, angular{};
};

/// A frame in motion: its axes, and its twist about its own origin.
struct MovingFrame {
  Axes X;
  Screw V;
};

/// The inertia of a rigid body or of several as one, about Wo.
struct ScrewInertia {
  double mass = 0;
  Four moment{};          ///< mass times centre of gravity [kg m]
  Four Ix{}, Iy{}, Iz{};  ///< columns of the inertia [kg m^2]
};

}  // namespace vmech
