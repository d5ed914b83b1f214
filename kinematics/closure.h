#pragma once

#include <vector>

#include "vmech/kinematics/coordinate_partition.h"
#include "vmech/kinematics/envelope_ldlt.h"
#include "vmech/kinematics/tree_workspace.h"

namespace vmech {

/// The dependent velocities of a closed mechanism, from the loop equations C v = r:
///
///   minimise | W (C_u x - r) |,   H = C_u' W^2 C_u,   W = 1/length for lengths, 1 for rotations.
///
/// Redundant equations need no care: they are consistent, and H has full rank as long as the chosen
/// velocities determine the dependent ones.
class DependentSolver {
 public:
  DependentSolver(const KinematicTree& tree, CoordinatePartition partition);

  const CoordinatePartition& partition() const { return partition_; }

  /// Needs LoopJacobian in ws.
  void Factor(const TreeWorkspace<double>& ws);
  /// Dead centre: sin^2 of the angle by which the least independent dependent velocity is
  /// independent of the others; 0 if the loops do not determine it here.
  double smallest_pivot() const { return normal_.smallest_pivot(); }
  int undetermined() const { return normal_.zero_pivots(); }

  /// One Newton step of loop closure, C dq = e2 (paper eq. 4), on the dependent coordinates of q.
  void StepCoordinates(const TreeWorkspace<double>& ws, VectorXd* q);
  /// Sets the dependent entries of v so that C v = 0, from its driven and idle entries.
  void CompleteVelocities(const TreeWorkspace<double>& ws, double* v);
  /// Sets the dependent entries of vdot so that C vdot + bias = 0 (LoopAccelerationBias).
  void CompleteAccelerations(const TreeWorkspace<double>& ws, double* vdot);

 private:
  enum class Target { kErrors, kZero, kMinusBias };
  void StartResidual(const TreeWorkspace<double>& ws, Target target);
  void SubtractColumns(const TreeWorkspace<double>& ws, const double* x);
  void SolveInto(const TreeWorkspace<double>& ws, double* x);
  void Complete(const TreeWorkspace<double>& ws, Target target, double* x);

  const KinematicTree& tree_;
  CoordinatePartition partition_;
  std::vector<Vector6d> weight_;    ///< W^2 per loop
  std::vector<Vector6d> residual_;  ///< per loop
  std::vector<double> solution_;    ///< per dependent velocity
  VectorXd step_;                   ///< [nv]
  EnvelopeLdlt normal_;
};

/// Largest loop error, lengths divided by the characteristic length. A loop assembled half a turn
/// the wrong way counts with its full error. Needs LoopErrors.
double LargestLoopError(const KinematicTree& tree, const TreeWorkspace<double>& ws);

/// Positions: poses, loop errors and, if asked, C.
void EvaluatePose(const KinematicTree& tree, const VectorXd& q, TreeWorkspace<double>* ws,
                  bool with_jacobian = true);

/// Newton's iteration on the dependent coordinates, warm-started: q is moved until the largest loop
/// error is at most `tolerance`, at most `max_steps` times. Leaves ws at the last pose.
/// Returns the loop error there. For the whole way from a rough guess see Assemble.
double CloseByNewton(const KinematicTree& tree, double tolerance, int max_steps,
                     DependentSolver* solver, TreeWorkspace<double>* ws, VectorXd* q);

}  // namespace vmech
