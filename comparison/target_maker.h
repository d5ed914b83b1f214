#pragma once

#include <string>
#include <vector>

#include "vmech/comparison/closed_walk.h"
#include "vmech/comparison/random.h"
#include "vmech/comparison/suite.h"
#include "vmech/kinematics/inverse/inverse_kinematics.h"

namespace vmech {

/// A mechanism of a suite, ready for problems to be posed on it.
class Subject {
 public:
  /// @throws std::runtime_error if its loops cannot be closed from the start values.
  explicit Subject(const SuiteMechanism& given);
  Subject(const Subject&) = delete;
  Subject& operator=(const Subject&) = delete;

  const KinematicTree& tree() const { return tree_; }   ///< of the assembled mechanism
  InverseKinematics& problem() { return problem_; }     ///< brings the grasp to a target
  const VectorXd& q_start() const { return q_start_; }  ///< closed
  ClosedWalk WalkFrom(const VectorXd& q, PortableRandom* random) const;  ///< q closed

  /// The grasp's motions, J Z [rows of e1, mobility], in radians and characteristic lengths.
  MatrixXd GraspMotions(const VectorXd& q);
  /// How well the grasp tells the configuration: the smallest singular value of J Z, of one per
  /// freedom. It vanishes where the mechanism is singular as seen from the grasp, a dead centre of
  /// the link that is held among these. Free motions that move the grasp nowhere do not count
  /// (unseen_motions.h); 0 if there are no others.
  double Determination(const VectorXd& q);

 private:
  KinematicTree tree_;
  InverseKinematics problem_;
  VectorXd q_start_;
  int rank_;    // of the loop equations, in general
  int unseen_;  // free motions that the grasp does not see, in general
};

/// A target, or a path of targets, and where to begin.
struct Problem {
  std::vector<Posed> targets;  ///< X_WH
  std::vector<VectorXd> own;   ///< per target the closed configuration that it was made from
  VectorXd start;              ///< closed
  bool determined = true;      ///< the grasp tells the configuration (Subject::Determination)
  std::string defect;          ///< why there is none of this kind on this mechanism; else empty
};

/// Makes one problem of a block; the same seed makes the same problem.
///
/// kUnreachable: the target is off its own configuration by `offset` in a direction u with
/// Z'J'u = 0. The log of the rotation keeps J'r = offset J'u there, so that its own configuration
/// is exactly a stationary point of the problem, at r = offset u.
/// kSingular: of 12 random configurations the least determined one, followed downhill until
/// Determination is at most `closeness`.
/// kDeadCentre: for mechanisms with one freedom; the middle of the path is where the first joint on
/// the way turns back.
Problem MakeProblem(Subject* subject, const TargetBlock& block, uint64_t seed);

}  // namespace vmech
