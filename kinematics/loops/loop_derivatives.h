#pragma once

#include "vmech/kinematics/loops/loops.h"

namespace vmech {

/// Derivatives of the loop errors that are exact at open loops too, where LoopJacobian, which is
/// exact at closed ones, misses the change of the forbidden rotation with the rotation itself. The
/// cut joint's anchor M moves in F by a small displacement and turns by eta: R_FM becomes
/// exp([eta]) R_FM. All in axes of F; they need LoopErrors.

/// D [3, 3], the identity at a closed loop, so that
///   -de2 = ProjectOnRows(loop, state, dp_FM, D eta).
Matrix3d LoopRotationJacobian(const Loop& loop, const LoopState<double>& state);

/// - sum_i mu_i d2e2_i/deta2, symmetric. (Positions are linear in dp_FM.)
Matrix3d LoopRotationCurvature(const Loop& loop, const LoopState<double>& state, const double* mu);

}  // namespace vmech
