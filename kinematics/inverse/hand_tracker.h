#pragma once

#include <string>
#include <string_view>

#include "vmech/kinematics/inverse/branch_determinant.h"
#include "vmech/kinematics/inverse/inverse_kinematics.h"
#include "vmech/solvers/augmented_lagrangian.h"

namespace vmech {

/// What became of one target.
enum class TrackStatus {
  kNotRun,
  kFollowed,    ///< the pose nearest to the hand, on the branch
  kCatchingUp,  ///< closed and on the branch, but the step bound or the iterations were spent
  kDeadCentre,  ///< the nearest pose is a dead centre: close beside it, on its side
  kJump,        ///< held: the solver arrived on another branch
  kLost,        ///< held: the loops did not close, or values are not finite
};

/// The status in words.
std::string_view NameOf(TrackStatus status);

/// How closely a hand is followed, and with how much work a target.
struct TrackOptions {
  InverseKinematicsOptions kinematics;  ///< what the hand's error is measured by
  /// lambda of paper eq. (8) against the dimensionless hand error [-], 1..1e4. The multiplier
  /// update makes the result independent of it; from 1e3 on, rounding begins to count.
  double weight = 5e1;
  /// Most steps for one target, 1..20. More follow a faster hand, one that pulls hard, and one
  /// near a dead centre, where each step only halves what is left.
  int steps = 10;
  /// Iterations with line search for targets that those steps do not reach, 0..100. They are
  /// needed where the hand is off the mechanism's path by more than its radius of curvature.
  int rescue_iterations = 12;
  /// Farthest that any coordinate moves for one target [rad or m], in [1e-6, 1]. Lower it for poses
  /// that follow each other densely; a hand that moves faster is caught up with later.
  double max_move = 0.3;
  /// How well loops have to close [-], in [1e-14, 1e-3]; lengths in characteristic lengths.
  double closure_tolerance = 1e-11;
  /// Steps shorter than this have arrived [rad or m], in [1e-14, 1e-3].
  double step_tolerance = 1e-6;

  void Validate() const;  ///< @throws std::invalid_argument naming field, value and range
};

/// What became of the targets since the tracker began.
struct TrackSummary {
  long targets = 0;          ///< all of them
  long followed = 0;         ///< reached, or as near as the mechanism comes
  long catching_up = 0;      ///< not yet at the nearest pose
  long dead_centre = 0;      ///< targets at which the pose was held, by reason
  long jumps = 0;            ///< the nearest pose was on another branch
  long lost = 0;             ///< no step led nearer
  long rescued = 0;          ///< needed the line search
  double worst_closure = 0;  ///< largest |c_i| of all poses returned

  /// Targets at which the pose stayed as it was.
  long held() const { return dead_centre + jumps + lost; }
  std::string BriefReport() const;  ///< one line
};

/// Follows a hand with a mechanism, target after target, on one branch: the fast path. Each
/// target takes a few steps of the penalty method with multiplier update (augmented_lagrangian.h)
/// from the pose and the multipliers of the last.
///
/// Branch: the sign of BranchDeterminant. Beyond a dead centre that folds the hand's poses, each of
/// them is reached from both sides: the one on this side is taken, and without one the last good
/// pose is held. At a dead centre the mechanism stands 2 mrad beside it, on its side, until the
/// hand comes back. So a parallelogram that is stretched out stays so: both ways on are as good. A
/// singular pose that folds nothing (the outer axes of a wrist in line) is passed straight through.
/// Motions that neither hand nor loops see at any pose (unseen_motions.h: a rod that spins, an
/// elbow that circles) have no part in the determinant, and are left at rest but for rounding.
class HandTracker {
 public:
  /// Keeps a reference to the tree. q is a closed pose (Assemble).
  /// @throws std::invalid_argument as TrackOptions::Validate and InverseKinematics, or if q is
  ///         not closed.
  HandTracker(const KinematicTree& tree, const GraspFrame& grasp, const VectorXd& q,
              const TrackOptions& options = {});

  /// One target: bounded work, no allocation.
  [[nodiscard]] TrackStatus Advance(const Posed& X_WH) noexcept;

  const VectorXd& q() const { return q_; }  ///< the last good pose
  /// Of q(), as Summary::multipliers; InverseKinematics::LoopMultipliers makes wrenches of them.
  const VectorXd& multipliers() const { return workspace_.multipliers; }
  InverseKinematics& kinematics() { return problem_; }      ///< the problem that is solved
  const TrackSummary& summary() const { return summary_; }  ///< since the tracker began
  /// S [nv, nv; J]: the second derivatives of 1/2 e1'K e1 + mu'e2 at q(), for the target that was
  /// followed last; nothing along motions that neither hand nor loops see. They vanish where the
  /// hand is on the mechanism's path.
  void ComputeCurvature(MatrixXd* S) noexcept;

 private:
  /// Moves the shortest way to c = 0: no residual, J = 1.
  class Closing final : public ConstrainedLeastSquares {
   public:
    explicit Closing(InverseKinematics& problem);
    void Evaluate(const VectorXd& q, VectorXd* r, MatrixXd* J, VectorXd* c, MatrixXd* C) override;
    void Plus(const VectorXd& q, const VectorXd& dq, VectorXd* q_plus) const override;

   private:
    InverseKinematics& problem_;
  };

  enum class Progress { kNone, kSome, kArrived };
  enum class Beyond { kUnknown, kTurningBack, kPassable };  ///< what a singular pose was

  Progress TakeSteps() noexcept;
  bool TakeStep(bool with_curvature) noexcept;
  bool TakeChordStep(double last_step) noexcept;
  bool Linearize() noexcept;
  void TakeClosureStep(double last_step) noexcept;
  Progress Rescue() noexcept;
  TrackStatus Judge() noexcept;
  bool IsClosed() const noexcept;
  void Close() noexcept;
  bool TryBeside(double size) noexcept;
  bool OffsetFromSingularity() noexcept;
  Beyond FindMirrorImage() noexcept;
  bool WithinLimits() const noexcept;
  TrackStatus Accept(Progress progress) noexcept;
  TrackStatus Hold(TrackStatus why) noexcept;
  void MoveToTrial() noexcept;

  InverseKinematics problem_;
  Closing closing_;
  AugmentedLagrangianOptions rescue_options_, closing_options_;
  AugmentedLagrangianWorkspace workspace_, closing_workspace_;
  TrackOptions options_;
  VectorXd q_, trial_, good_multipliers_;
  Linearization at_trial_;
  bool at_q_ = false;  // at_trial_ is of the last good pose
  BranchDeterminant branch_;
  VectorXd q_reference_;  // its reference, an earlier good pose at a distance from dead centres
  VectorXd soft_, dq_, origin_;  // the soft motion, a multiple of it, and where that starts
  TrackSummary summary_;
};

}  // namespace vmech
