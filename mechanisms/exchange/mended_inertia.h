#pragma once

#include <string>

#include "vmech/mechanisms/mechanism.h"

namespace vmech {

/// The inertia nearest to a given one that some distribution of mass has. [kg m^2]
///
///   S = tr(I)/2 1 - I           the second moments of mass, integral of r r' dm,
///   I = tr(S) 1 - S             and back
///
/// are positive semidefinite exactly if no principal moment is negative or above the sum of the two
/// others [Wensing, Kim, Slotine 2018]. The nearest such S in the Frobenius norm has the
/// eigenvectors of the given one and its eigenvalues, those below zero put to zero.
Matrix3d NearestInertia(const Matrix3d& I_cm);

/// What was wrong and what was done about it, in words with the figures before and after; empty if
/// there was nothing to mend.
struct Mending {
  std::string defect, change;  ///< in words, with figures
};

/// Mends what no body has by as little as can be: an inertia that is wrong beyond rounding
/// (InertiaDefect) becomes the nearest, and one without mass is dropped. The judgement is about the
/// centre of gravity, wherever the frame of the link is.
Mending MendInertia(MassProperties* properties);

}  // namespace vmech
