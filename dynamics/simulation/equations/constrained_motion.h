#pragma once

#include <vector>

#include "vmech/base/linear_algebra/envelope_ldlt.h"
#include "vmech/dynamics/loads/pose/load_workspace.h"
#include "vmech/dynamics/simulation/simulation.h"

namespace vmech {

/// The rate of one freedom of a joint as a linear function of v: an entry of it for a joint in the
/// tree, CutJointRates for one that is cut.
struct RateRow {
  int v = -1;       ///< index in v, or
  int loop = -1;    ///< index of a loop
  int freedom = 0;  ///< of that loop's cut joint
};
/// The row of the rate of a freedom.
RateRow RateRowOf(const KinematicTree& tree, FreedomId at);

/// The largest force along free motions that have no inertia: nothing answers it.
struct UnresistedForce {
  double force = 0;  ///< along a motion one of whose freedoms moves at 1 [N], [N m]
  double share = 0;  ///< of the largest force in the mechanism; rounding leaves 1e-7 at most
  int motion = -1;   ///< which of the motions without inertia; -1: none
};

/// How a tree with loops can move at one pose, and how forces accelerate it. N are the free
/// motions, C N = 0, of the independent freedoms (`driven` of the model's partition; it has no idle
/// ones), and some rates b_i v are held:
///
///   v   = N s            (N'M N) s  = N'M v_given - B' m,              B s  = held rates
///   v'  = a + N s'       (N'M N) s' = N'(forces - h - M a) - B' m,     B s' = held slopes - b a
///
/// with C a + bias = 0 and B = b N. The first is the projection of given velocities in the metric
/// of M. Redundant loop equations need no care (DependentSolver), nor do redundant rows of B, nor
/// rows that no free motion moves, which nothing holds.
/// Free motions without inertia (below LoadModel::no_inertia), be it of one freedom or of several
/// that move together, stand still, and so do their accelerations: Unresisted() is the force along
/// them that nothing answers. Everything is about a point near the mechanism, wherever it goes.
/// Time is linear in the links and loops, times the number of freedoms. Nothing
/// allocates but the constructor and Hold.
class ConstrainedMotion {
 public:
  /// Keeps a reference to the model.
  explicit ConstrainedMotion(const LoadModel& model);

  /// Rates that are held from now on; they need not be independent.
  void Hold(std::vector<RateRow> rows);
  const std::vector<RateRow>& held() const noexcept { return rows_; }  ///< as Hold was given them

  /// Takes coordinates [nq], whose quaternions are brought to unit length.
  void SetPose(const double* q) noexcept;
  /// Of the loops there, dimensionless.
  double closure() const noexcept;
  /// As DependentSolver::PivotBeside the largest columns that there were: 0 where loops lose rank,
  /// be it that a velocity moves nothing there; 1 far from there.
  double smallest_pivot() const noexcept { return ws_.dependents.PivotBeside(column_sizes_); }
  /// Remembers how large the loops' columns are at the pose, if larger than before.
  void MeasureColumns() noexcept;
  /// Goes on from what another one has measured.
  void TakeColumnSizes(const ConstrainedMotion& other) { column_sizes_ = other.column_sizes_; }

  /// Takes v [nv] as far as loops and held rows allow: the nearest velocities in the metric of M.
  /// `rates`: of the held rows; null: zero.
  void SetVelocities(const double* v, const double* rates) noexcept;
  /// Takes v [nv] as they are.
  void TakeVelocities(const double* v) noexcept;
  /// Accelerations under forces [nv] along the freedoms and ws().applied on the nodes. `slopes`: of
  /// the held rates; null: zero. Writes ws().vdot, and A of the nodes.
  void Accelerate(const VectorXd& forces, const double* slopes) noexcept;
  /// The forces along the held rows that this took.
  const VectorXd& held_forces() const noexcept { return multipliers_; }
  /// What the last Accelerate left out.
  const UnresistedForce& unresisted() const noexcept { return unresisted_; }
  /// How many free motions have no inertia at the pose.
  int without_inertia() const noexcept { return static_cast<int>(inert_.size()); }
  /// [nv] one of them.
  VectorXd MotionWithoutInertia(int motion) const;

  /// Closes the loops of q [nq] to `tolerance` by the nearest step in the metric of M that leaves
  /// the held rows alone. Leaves the pose set. Returns what is left.
  double Close(double tolerance, double* q) noexcept;

  /// Independent velocities.
  int freedoms() const noexcept { return static_cast<int>(free_.size()); }
  /// [nv, freedoms] the motions that loops and drives leave free
  const MatrixXd& N() const noexcept { return N_; }
  const MatrixXd& inertia() const noexcept { return A_; }       ///< N'M N [freedoms, freedoms]
  const MatrixXd& held_motions() const noexcept { return B_; }  ///< B [held, freedoms]
  // Of the last Accelerate: N'(forces - h - M a) [freedoms], and what B s' is to be [held].
  const VectorXd& driving() const noexcept { return driving_; }   ///< [freedoms]
  const VectorXd& held_slopes() const noexcept { return held_; }  ///< [held]
  /// The slope of a rate there.
  double SlopeOf(const RateRow& row) const noexcept;
  /// A rate at the velocities that there are.
  double RateOf(const RateRow& row) const noexcept;

  /// q, v, v', tree, inertias: as the functions above leave them.
  LoadWorkspace<double>& ws() noexcept { return ws_; }
  const LoadWorkspace<double>& ws() const noexcept { return ws_; }  ///< the same, to read

 private:
  void FindVelocityTerms() noexcept;
  void FindInertia() noexcept;
  void FindMovingLinks(int k) noexcept;
  void DropRowsThatStand() noexcept;
  void FactorInertia() noexcept;
  void FactorHeld() noexcept;
  void FindMotionsWithoutInertia() noexcept;
  void FollowMechanism() noexcept;
  void LeaveOutUnresisted() noexcept;
  void JudgeUnresisted(const VectorXd& forces) noexcept;
  void SolveFree(VectorXd* s) noexcept;

  const KinematicTree& tree_;
  LoadWorkspace<double> ws_;
  std::vector<int> free_;                    ///< the independent velocities
  VectorXd least_inertia_;                   ///< of each
  VectorXd unit_;                            ///< [nv] 1 rad/s, or a characteristic length a second
  VectorXd free_unit_;                       ///< of the independent velocities
  VectorXd row_unit_;                        ///< the same of the held rates
  VectorXd column_sizes_;                    ///< [nv] squares, dimensionless but for the velocity
  VectorXd columns_here_, largest_columns_;  ///< the same at a pose; as far as they count
  std::vector<bool> massless_;
  MatrixXd M_, N_, MN_, A_;
  EnvelopeLdlt<double> inertia_factors_;  ///< of A, last freedoms first
  std::vector<RateRow> rows_;
  MatrixXd B_, Y_;                     ///< Y = A^-1 B'
  EnvelopeLdlt<double> held_factors_;  ///< of B A^-1 B'
  VectorXd driving_, right_, s_, held_, multipliers_, weight_, step_, reversed_, momenta_;
  std::vector<int> inert_;  ///< pivots of inertia_factors_ of motions without inertia
  UnresistedForce left_out_, unresisted_;  ///< by SolveFree; by Accelerate
};

/// Brings the quaternions of q [nq] to unit length.
void NormaliseQuaternions(const KinematicTree& tree, double* q) noexcept;
/// dq/dt [nq] at rates v [nv].
void CoordinateRates(const KinematicTree& tree, const double* q, const double* v,
                     double* qdot) noexcept;
/// d [nv] with q1 = q0 (+) d, for small steps.
void SmallStep(const KinematicTree& tree, const double* q0, const double* q1, double* d) noexcept;

}  // namespace vmech
