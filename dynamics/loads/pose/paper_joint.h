#pragma once

#include "vmech/dynamics/loads/pose/load_workspace.h"

namespace vmech {

/// Paper eq. (14) as printed: w_d (or the drive forces) and the full cut wrenches, moments about
/// hinges included, in one minimum-norm step,
///
///   [ J'  C' ] [w_d; w_cut] = tau,     newtons and newton metres weighted alike.
///
/// The hand may then carry what belongs to the bearings, and a hinge a moment that it cannot carry;
/// the answer depends on the cut. For comparison with the paper only. C [6 per loop, nv].
VectorXd MinimumNormWrenches(const MatrixXd& J, const MatrixXd& C, const VectorXd& tau);

/// Solves ws->tau - ws->passive for all wrenches of a pose in this way; applies them to F and
/// writes those of the cut joints.
void SolvePaperJoint(const LoadModel& model, LoadWorkspace<double>* ws);

}  // namespace vmech
