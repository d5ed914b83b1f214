#pragma once

#include "vmech/dynamics/loads/pose/load_workspace.h"

#include "vmech/kinematics/tree/grasp_frame.h"

namespace vmech {

/// The hand as the drive (paper sections 4-6). N are the free motions, J the Jacobian of the grasp
/// point, K the weights of its pose error.

/// v = N s with (J N)' K (J N) s = (J N)' K V_H: the allowed motion nearest to that of the hand.
/// Needs LoopJacobian and ws->motions; writes ws->v.
void HandVelocities(const LoadModel& model, const HandSample& hand, LoadWorkspace<double>* ws);

/// The same for accelerations, from those that ws holds for vdot with the independent ones at zero.
/// Needs V and A; writes ws->vdot.
void HandAccelerations(const LoadModel& model, const HandSample& hand, LoadWorkspace<double>* ws);

/// w_d, what the hand does to the mechanism at Go (paper eq. 9). Dynamics determine only its part
/// along the free motions, (J N)' w_d = N' (M q'' + h); the smallest wrench in the metric K that
/// has this part is w_d = K J N x. Applies it to F and tau. Needs ws->tau and ws->passive.
void ApplyHandWrench(const LoadModel& model, LoadWorkspace<double>* ws);

/// Takes ws->hand from what the nodes need; brings F and tau up to date.
void ApplyHand(const LoadModel& model, LoadWorkspace<double>* ws);

/// Pose of the grasp frame. Needs X.
Posed GraspPose(const LoadModel& model, const TreeWorkspace<double>& ws);
/// Where the hand holds.
GraspFrame HandGrasp(const LoadModel& model);

/// K^(1/2) J N [6, motions]: how the hand sees motions N.
MatrixXd WeightedGraspMotions(const LoadModel& model, const TreeWorkspace<double>& ws,
                              const MatrixXd& N);

}  // namespace vmech
