#pragma once

#include <Eigen/Cholesky>
#include <limits>

#include "vmech/base/pose.h"

namespace vmech {

/// Tells on which side of its singular poses a mechanism in a hand is. With A = [J; C] of hand
/// error and loops, det(A'A_ref) is, but for a positive factor, the product of the determinants of
/// the reduced Jacobian J N (N the free motions) here and at a good pose shortly before, the
/// reference. It keeps its sign while poses follow each other on one branch, and vanishes where the
/// hand cannot move the mechanism or the loops do not determine it. Motions that neither hand nor
/// loops see at any pose (unseen_motions.h) have no part in it. No allocation after
/// Begin.
class BranchDeterminant {
 public:
  /// Of A.
  BranchDeterminant(Eigen::Index rows, Eigen::Index tangents);
  /// The first reference, J [residuals, nv] above C [constraints, nv]. `unseen`: velocities that
  /// they do not see, orthonormal [nv, count].
  void Begin(const MatrixXd& J, const MatrixXd& C, const MatrixXd& unseen);

  /// A of a pose; finite.
  void Take(const MatrixXd& J, const MatrixXd& C) noexcept;
  /// det(A'A_ref) over det(A_ref'A_ref), of what was taken last.
  double value() const noexcept { return value_; }
  /// The pose becomes the reference.
  void SetReference() noexcept;
  /// Does the hand move the mechanism 30 times less here than at the best reference?
  bool IsNearDeadCentre() const noexcept;

  /// The motion that hand and loops resist least at the pose, but for those that they do not see:
  /// *motion [nv], the largest of its entries 1.
  void FindSoftMotion(VectorXd* motion) noexcept;
  /// What is not seen at the pose, orthonormal [nv, count].
  const MatrixXd& unseen() const noexcept { return unseen_; }

 private:
  void Stack(const MatrixXd& J, const MatrixXd& C) noexcept;
  double Evaluate() noexcept;
  void AddUnseen(const MatrixXd& N) noexcept;

  MatrixXd A_, A_reference_;  // [J; C; 0], whole registers
  MatrixXd product_;          // A'A_ref
  MatrixXd unseen_, unseen_reference_;
  double unseen_weight_ = 0;                                    // of N N' beside A'A
  double log_reference_ = 0;                                    // log det(A_ref'A_ref)
  double log_best_ = -std::numeric_limits<double>::infinity();  // the largest so far
  double value_ = 1;
  Eigen::LDLT<MatrixXd> normal_;
};

}  // namespace vmech
