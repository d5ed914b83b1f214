#include "vmech/comparison/closed_walk.h"

#include <cmath>
#include <utility>

#include "vmech/base/linear_algebra/linear_algebra.h"
#include "vmech/kinematics/inverse/configuration_distance.h"
#include "vmech/kinematics/loops/assembly.h"
#include "vmech/kinematics/loops/dimensionless_loops.h"
#include "vmech/kinematics/loops/mobility.h"
#include "vmech/kinematics/tree/forward_kinematics.h"

namespace vmech {
MatrixXd FreeMotionBasis(const KinematicTree& tree, const VectorXd& q) {
  if (tree.loops.empty()) return MatrixXd::Identity(tree.nv, tree.nv);
  return FindNullSpace(DimensionlessLoopJacobian(tree, q), kRankTolerance).basis;
}

ClosedWalk::ClosedWalk(const KinematicTree& tree, const std::vector<Bound>& bounds, int rank,
                       VectorXd q, PortableRandom* random)
    : tree_(tree),
      bounds_(bounds),
      rank_(rank),
      scale_(VelocityScale(tree)),
      q_(std::move(q)),
      direction_(random->NormalVector(tree.nv)),
      random_(random) {}

bool ClosedWalk::Step(double size, double turn) {
  constexpr int kAttempts = 16;
  const double share = turn / std::sqrt(static_cast<double>(tree_.nv));
  if (TryStep(size, direction_ + share * random_->NormalVector(tree_.nv))) return true;
  for (int attempt = 1; attempt < kAttempts; ++attempt) {
    if (TryStep(size, random_->NormalVector(tree_.nv))) return true;
  }
  return false;
}

bool ClosedWalk::TryStep(double size, const VectorXd& wish) {
  constexpr double kNoMotion = 1e-3;               // of the wish: it points where nothing moves
  constexpr double kShortest = 0.3, kLongest = 2;  // of the size; else it is another branch
  const MatrixXd Z = FreeMotionBasis(tree_, q_);
  const VectorXd along = Z * (Z.transpose() * wish);
  if (along.norm() <= kNoMotion * wish.norm()) return false;
  VectorXd next = q_;
  MoveCoordinates(tree_, size * scale_.cwiseProduct(along.normalized()), &next);
  if (!Assemble(tree_, AssemblyOptions::Nearby(), &next).closed || !WithinLimits(next))
    return false;
  const double distance = ConfigurationDistance(tree_, q_, next);
  if (distance < kShortest * size || distance > kLongest * size) return false;
  if (!LoopsKeepRank(next) && LoopsKeepRank(q_)) return false;
  direction_ = along.normalized();
  q_ = next;
  return true;
}

bool ClosedWalk::LoopsKeepRank(const VectorXd& q) const {
  constexpr double kNearlyLost = 0.02;  // pivot of the dimensionless C, over the largest
  if (tree_.loops.empty()) return true;
  return FindNullSpace(DimensionlessLoopJacobian(tree_, q), kNearlyLost).rank >= rank_;
}

bool ClosedWalk::WithinLimits(const VectorXd& q) const {
  for (const Bound& bound : bounds_) {
    if (q[bound.coordinate] < bound.lower || q[bound.coordinate] > bound.upper) return false;
  }
  return true;
}

}  // namespace vmech
