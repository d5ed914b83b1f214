#pragma once

#include <vector>

#include "vmech/base/linear_algebra/envelope_ldlt.h"
#include "vmech/kinematics/loops/coordinate_partition.h"
#include "vmech/kinematics/loops/loops.h"
#include "vmech/kinematics/tree/tree_workspace.h"

namespace vmech {

/// The dependent velocities of a closed mechanism, from the loop equations C v = r:
///
///   minimise | W (C_u x - r) |,   H = C_u' W^2 C_u,   W = 1/length for lengths, 1 for rotations.
///
/// Redundant equations need no care: they are consistent, and H has full rank as long as the chosen
/// velocities determine the dependent ones.
template <typename T>
class DependentSolver {
 public:
  /// Keeps a reference to the tree.
  DependentSolver(const KinematicTree& tree, CoordinatePartition partition);

  /// Which velocities are independent.
  const CoordinatePartition& partition() const { return partition_; }

  /// Needs LoopJacobian in ws.
  void Factor(const TreeWorkspace<T>& ws);
  /// How far the pose is from a dead centre: sin^2 of the smallest angle between the column of C of
  /// a dependent velocity and the span of those before it; 0 if the loops do not determine that
  /// velocity here.
  const T& smallest_pivot() const { return normal_.smallest_pivot(); }
  /// The same beside given sizes [nv] in place of the columns' own, which may all but vanish: the
  /// squared distance of a column of W C_u from the span of the others, over its size.
  T PivotBeside(const VectorXd& sizes) const;

  /// One step of loop closure, C dq = e2 (paper eq. 4), on the dependent coordinates of q [nq].
  /// With C of the pose in ws it is Newton's; with C and factor of an earlier pose a chord step.
  void StepCoordinates(const TreeWorkspace<T>& ws, T* q);
  /// Sets the dependent entries of v so that C v = 0, from its driven and idle entries.
  void CompleteVelocities(const TreeWorkspace<T>& ws, T* v);
  /// Sets the dependent entries of vdot so that C vdot + bias = 0 (LoopAccelerationBias).
  void CompleteAccelerations(const TreeWorkspace<T>& ws, T* vdot);

 private:
  enum class Target { kErrors, kZero, kMinusBias };
  void StartResidual(const TreeWorkspace<T>& ws, Target target);
  void SubtractColumns(const TreeWorkspace<T>& ws, const T* x);
  void SolveInto(const TreeWorkspace<T>& ws, T* x);
  void Complete(const TreeWorkspace<T>& ws, Target target, T* x);

  const KinematicTree& tree_;
  CoordinatePartition partition_;
  std::vector<Vector6d> weight_;      ///< W^2 per loop
  std::vector<Vector6<T>> residual_;  ///< per loop
  std::vector<T> solution_;           ///< per dependent velocity
  std::vector<T> step_;               ///< [nv]
  EnvelopeLdlt<T> normal_;
};

/// The motions that the loops allow, N [nv, independent]: column k moves the k-th of
/// [driven, idle] at unit rate and the other independent velocities not at all, C N = 0. Needs
/// LoopJacobian in ws and a factored `dependents`. `N` must have that size.
template <typename T>
void FreeMotions(const TreeWorkspace<T>& ws, DependentSolver<T>* dependents, MatrixX<T>* N);

/// The poses and loop errors at coordinates q [nq] and, if asked for, C.
template <typename T>
void EvaluatePose(const KinematicTree& tree, const T* q, TreeWorkspace<T>* ws,
                  bool with_jacobian = true);
/// The same for a vector q [nq].
void EvaluatePose(const KinematicTree& tree, const VectorXd& q, TreeWorkspace<double>* ws,
                  bool with_jacobian = true);

/// Newton's iteration on the dependent coordinates, warm-started: q [nq] is moved until the largest
/// loop error is at most `tolerance`, at most `max_steps` times. While it converges fast the
/// factors are kept (chord steps). Leaves poses and loop errors in ws at the last q. Returns the
/// loop error there. For the whole way from a rough guess see Assemble.
template <typename T>
T CloseByNewton(const KinematicTree& tree, double tolerance, int max_steps,
                DependentSolver<T>* solver, TreeWorkspace<T>* ws, T* q);

}  // namespace vmech
