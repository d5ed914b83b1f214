#include "vmech/kinematics/loops/unseen_motions.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "vmech/base/linear_algebra/linear_algebra.h"
#include "vmech/kinematics/inverse/configuration_distance.h"
#include "vmech/kinematics/loops/assembly.h"
#include "vmech/kinematics/loops/dimensionless_loops.h"
#include "vmech/kinematics/loops/mobility.h"
#include "vmech/kinematics/tree/forward_kinematics.h"
#include "vmech/solvers/optimality.h"

namespace vmech {
namespace {

constexpr double kArrived = 1e-10;  // steps shorter than this [rad, characteristic lengths]

/// The hand's target for as long as this lives, then the one before.
class HandAt {
 public:
  HandAt(InverseKinematics* problem, const Posed& X_WH)
      : problem_(*problem), before_(problem->target()) {
    problem_.SetTarget(X_WH);
  }
  ~HandAt() { problem_.SetTarget(before_); }
  HandAt(const HandAt&) = delete;
  HandAt& operator=(const HandAt&) = delete;

 private:
  InverseKinematics& problem_;
  Posed before_;
};

/// [r; c] and A = [J; C] at one pose, columns per radian and characteristic length.
struct HandAndLoops {
  VectorXd error;
  MatrixXd A;

  HandAndLoops(InverseKinematics* problem, const VectorXd& q) {
    const ProblemSizes& sizes = problem->sizes();
    Linearization at_q(sizes);
    at_q.Evaluate(*problem, q);
    error.resize(sizes.residuals + sizes.constraints);
    error << at_q.r, at_q.c;
    A.resize(error.size(), sizes.tangents);
    A << at_q.J, at_q.C;
    A *= VelocityScale(problem->tree()).asDiagonal();
  }
};

/// Null space of A where the hand is at the grasp.
MatrixXd NullSpaceAt(InverseKinematics* problem, const VectorXd& q) {
  const HandAt hand(problem, problem->GraspPose(q));
  return FindNullSpace(HandAndLoops(problem, q).A, kRankTolerance).basis;
}

/// Closed poses a little way off, in directions that have nothing to do with each other.
std::vector<VectorXd> ClosedNeighbours(const KinematicTree& tree, const VectorXd& q) {
  constexpr int kNeighbours = 3;
  constexpr double kAway = 0.1;  // [rad, characteristic lengths]
  MatrixXd Z = MatrixXd::Identity(tree.nv, tree.nv);
  if (!tree.loops.empty())
    Z = FindNullSpace(DimensionlessLoopJacobian(tree, q), kRankTolerance).basis;
  std::vector<VectorXd> neighbours;
  for (int k = 0; k < kNeighbours && Z.cols() > 0; ++k) {
    VectorXd way(Z.cols());
    for (int i = 0; i < way.size(); ++i) way[i] = std::sin(1.0 + k + 2.3 * i);
    VectorXd near = q;
    MoveCoordinates(tree, kAway * VelocityScale(tree).cwiseProduct(Z * way.normalized()), &near);
    if (Assemble(tree, {}, &near).closed) neighbours.push_back(std::move(near));
  }
  return neighbours;
}

MatrixXd Orthonormal(const MatrixXd& B) {
  const Eigen::HouseholderQR<MatrixXd> qr(B);
  MatrixXd Q = qr.householderQ() * MatrixXd::Identity(B.rows(), B.cols());
  for (Eigen::Index k = 0; k < B.cols(); ++k) {
    if (qr.matrixQR()(k, k) < 0) Q.col(k) *= -1;  // the same way as B
  }
  return Q;
}

/// What `before` goes on as at q: its part in the null space there.
MatrixXd Continue(InverseKinematics* problem, const VectorXd& q, const MatrixXd& before) {
  const MatrixXd Z = NullSpaceAt(problem, q);
  return Z.cols() < before.cols() ? Z : Orthonormal(Z * (Z.transpose() * before));
}

/// Moves a pose along its unseen motions.
class UnseenWalk {
 public:
  UnseenWalk(InverseKinematics* problem, const UnseenMotions& unseen, const VectorXd& q)
      : problem_(*problem), hand_(problem, problem->GraspPose(q)), basis_(unseen.basis), q_(q) {}

  const VectorXd& q() const { return q_; }
  const MatrixXd& basis() const { return basis_; }

  /// Goes by `way`, a combination of the motions; stays and returns false where that does not lead
  /// back to closed loops and the hand.
  bool Step(const VectorXd& way) {
    VectorXd next = q_;
    Move(basis_ * way, &next);
    if (!Close(&next)) return false;
    q_ = next;
    basis_ = Continue(&problem_, q_, basis_);
    return basis_.cols() == way.size();
  }

  /// Downhill to the nearest pose around.
  void Approach(const VectorXd& goal) {
    constexpr int kSteps = 100;
    constexpr double kLongest = 0.2;
    double size = kLongest;
    for (int i = 0; i < kSteps && size > kArrived; ++i) {
      const double before = Distance(goal);
      VectorXd way = basis_.transpose() * ConfigurationDifference(problem_.tree(), q_, goal);
      if (way.norm() <= kArrived) return;
      way *= std::min(1.0, size / way.norm());
      const UnseenPose here{q_, basis_};
      if (Step(way) && Distance(goal) < before) {
        size = std::min(2 * size, kLongest);
        continue;
      }
      q_ = here.q, basis_ = here.basis;
      size = 0.25 * std::min(size, way.norm());
    }
  }

  double Distance(const VectorXd& goal) const {
    return ConfigurationDistance(problem_.tree(), q_, goal);
  }

 private:
  struct UnseenPose {
    VectorXd q;
    MatrixXd basis;
  };

  void Move(const VectorXd& dimensionless, VectorXd* q) const {
    MoveCoordinates(problem_.tree(), VelocityScale(problem_.tree()).cwiseProduct(dimensionless), q);
  }

  bool Close(VectorXd* q) {
    constexpr int kSteps = 6;
    constexpr double kClosed = 1e-11;
    for (int i = 0; i < kSteps; ++i) {
      const HandAndLoops at_q(&problem_, *q);
      if (!at_q.error.allFinite()) return false;
      if (at_q.error.lpNorm<Eigen::Infinity>() <= kClosed) return true;
      Move(MinimumNormSolution(at_q.A, -at_q.error), q);
    }
    return false;
  }

  InverseKinematics& problem_;
  HandAt hand_;
  MatrixXd basis_;
  VectorXd q_;
};

/// The nearest pose on the way of one of the unseen motions, to one side.
VectorXd NearestOnTheWay(InverseKinematics* problem, const UnseenMotions& unseen, const VectorXd& q,
                         const VectorXd& goal, const VectorXd& stride) {
  constexpr double kLongestWay = 25;  // [rad, characteristic lengths]
  UnseenWalk walk(problem, unseen, q);
  VectorXd nearest = q;
  double least = walk.Distance(goal);
  for (double way = 0; way < kLongestWay; way += stride.norm()) {
    if (!walk.Step(stride)) break;
    if (walk.Distance(goal) < least) least = walk.Distance(goal), nearest = walk.q();
    if (way > stride.norm() && walk.Distance(q) < stride.norm() / 2) break;  // once round
  }
  return nearest;
}

}  // namespace

UnseenMotions FindUnseenMotions(InverseKinematics* problem, const VectorXd& q) {
  const MatrixXd here = NullSpaceAt(problem, q);
  if (here.cols() == 0) return {here};
  MatrixXd general = here;
  for (const VectorXd& near : ClosedNeighbours(problem->tree(), q)) {
    MatrixXd there = NullSpaceAt(problem, near);
    if (there.cols() < general.cols()) general = std::move(there);
  }
  if (general.cols() == here.cols() || general.cols() == 0) return {general};
  return {Orthonormal(here * (here.transpose() * general))};
}

VectorXd NearestAlongUnseen(InverseKinematics* problem, const VectorXd& q, const VectorXd& goal,
                            double enough) {
  constexpr double kStride = 0.1;  // [rad, characteristic lengths]
  const UnseenMotions unseen = FindUnseenMotions(problem, q);
  if (unseen.count() == 0) return q;
  UnseenWalk walk(problem, unseen, q);
  walk.Approach(goal);
  VectorXd nearest = walk.q();
  double least = walk.Distance(goal);
  for (int k = 0; k < 2 * unseen.count() && least > enough; ++k) {
    const UnseenMotions here = FindUnseenMotions(problem, nearest);
    if (here.count() == 0) break;
    const double side = k % 2 == 0 ? kStride : -kStride;
    const VectorXd stride = side * VectorXd::Unit(here.count(), (k / 2) % here.count());
    const VectorXd start = NearestOnTheWay(problem, here, nearest, goal, stride);
    UnseenWalk from_there(problem, FindUnseenMotions(problem, start), start);
    from_there.Approach(goal);
    if (from_there.Distance(goal) < least) {
      least = from_there.Distance(goal);
      nearest = from_there.q();
    }
  }
  return nearest;
}

}  // namespace vmech
