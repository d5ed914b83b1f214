#include "vmech/kinematics/loops/loop_walk.h"

#include <algorithm>
#include <utility>

#include "vmech/kinematics/loops/closure.h"
#include "vmech/kinematics/loops/dimensionless_loops.h"
#include "vmech/kinematics/loops/loop_clusters.h"
#include "vmech/kinematics/loops/loops.h"
#include "vmech/kinematics/loops/mobility.h"
#include "vmech/kinematics/tree/forward_kinematics.h"

namespace vmech {
namespace {

constexpr double kStride = 0.15;          // of the walk [rad, characteristic lengths]
constexpr double kFurthestClosing = 0.5;  // that a pose is moved to close its loops
constexpr double kWidestRounding = 1e-2;  // of a pivot
constexpr double kSmallestStep = 2e-15;   // rounding of the machine
constexpr int kClosingSteps = 12;

/// How many clusters have velocities that take part in the motions N [nv, motions].
size_t CountMobile(const std::vector<LoopCluster>& clusters, const MatrixXd& N) {
  constexpr double kMoves = 1e-6;
  return static_cast<size_t>(
      std::count_if(clusters.begin(), clusters.end(), [&](const LoopCluster& cluster) {
        return std::any_of(cluster.v.begin(), cluster.v.end(),
                           [&](int v) { return N.cols() > 0 && N.row(v).norm() > kMoves; });
      }));
}

class Walker {
 public:
  Walker(const KinematicTree& tree, double tolerance, double largest_misfit, int poses)
      : tree_(tree), closer_(tree, tolerance), largest_misfit_(largest_misfit), poses_(poses) {
    walk_.tolerance = tolerance;
  }

  Walk From(const VectorXd& q) {
    WalkedPose start{q};
    if (!closer_.Close(largest_misfit_, &start)) return walk_;
    // From a singular pose, where the rank is less, first to one beside it.
    WalkedPose from = start;
    for (int attempt = 0; attempt < 2; ++attempt) {
      walk_.poses = {start};
      Explore(from);
      const WalkedPose& best = *std::max_element(
          walk_.poses.begin(), walk_.poses.end(),
          [](const WalkedPose& a, const WalkedPose& b) { return a.rank < b.rank; });
      walk_.rank = best.rank;
      if (best.rank == from.rank) break;
      from = best;
    }
    std::erase_if(walk_.poses, [this](const WalkedPose& p) { return p.rank < walk_.rank; });
    for (const WalkedPose& p : walk_.poses) walk_.misfit = std::max(walk_.misfit, p.misfit);
    const MatrixXd N = closer_.At(from.q).C.null_space;
    walk_.stuck = N.cols() > 0 && walk_.poses.size() < 3;
    walk_.mobile_clusters = CountMobile(SplitLoops(tree_), N);
    return walk_;
  }

 private:
  void Explore(const WalkedPose& from) {
    const MatrixXd N = closer_.At(from.q).C.null_space;
    std::vector<VectorXd> directions;
    for (Eigen::Index k = 0; k < N.cols(); ++k) directions.push_back(N.col(k));
    if (N.cols() > 1) directions.push_back(N.rowwise().sum().normalized());
    const int steps =
        std::clamp(poses_ / (2 * std::max(1, static_cast<int>(directions.size()))), 2, 24);
    for (const VectorXd& direction : directions) {
      Follow(from, direction, steps);
      Follow(from, -direction, steps);
    }
  }

  void Follow(const WalkedPose& from, VectorXd direction, int steps) {
    WalkedPose pose = from;
    for (int i = 0; i < steps; ++i) {
      const double size = direction.cwiseAbs().maxCoeff();
      if (!(size > 0)) return;
      direction *= kStride / size;
      closer_.Move(direction, &pose.q);
      if (!closer_.Close(largest_misfit_, &pose)) return;
      walk_.poses.push_back(pose);
      const MatrixXd N = closer_.At(pose.q).C.null_space;
      direction = N * (N.transpose() * direction);
    }
  }

  const KinematicTree& tree_;
  LoopCloser closer_;
  double largest_misfit_;
  int poses_;
  Walk walk_;
};

}  // namespace

LoopCloser::LoopCloser(const KinematicTree& tree, double tolerance)
    : tree_(tree), tolerance_(tolerance), ws_(tree), row_scale_(LoopRowScale(tree)) {}

LoopEquations LoopCloser::At(const VectorXd& q) {
  EvaluatePose(tree_, q, &ws_, false);
  return {row_scale_.cwiseProduct(StackedLoopErrors(tree_, ws_)),
          SplitByRank(DimensionlessLoopJacobian(tree_, q), tolerance_)};
}

bool LoopCloser::Close(double largest_misfit, WalkedPose* pose) {
  double way = 0;
  for (int step = 0; step < kClosingSteps; ++step) {
    const LoopEquations at = At(pose->q);
    const VectorXd dq = at.C.pseudo_inverse * at.e;
    const double size = dq.lpNorm<Eigen::Infinity>();
    way += size;
    if (!(way < kFurthestClosing)) return false;
    if (size > kSmallestStep) Move(dq, &pose->q);
    if (size <= 10 * kSmallestStep) break;
  }
  const LoopEquations at = At(pose->q);
  pose->rank = at.C.rank;
  pose->misfit = at.e.cwiseAbs().maxCoeff();
  return pose->misfit <= largest_misfit && LargestLoopError(tree_, ws_) < 1;
}

void LoopCloser::Move(const VectorXd& dq, VectorXd* q) const {
  MoveCoordinates(tree_, VelocityScale(tree_).cwiseProduct(dq), q);
}

Walk FindWalk(const KinematicTree& tree, const VectorXd& q, double largest_misfit, int poses) {
  Walk best;
  for (double tolerance = kRankTolerance; tolerance < 2 * kWidestRounding; tolerance *= 10) {
    const double capped = std::min(tolerance, kWidestRounding);
    Walk walk = Walker(tree, capped, largest_misfit, poses).From(q);
    if (!walk.consistent()) continue;
    if (best.poses.empty() || walk.mobile_clusters > best.mobile_clusters) best = std::move(walk);
  }
  return best;
}

bool EveryLoopMoves(const KinematicTree& tree, const VectorXd& q) {
  const std::vector<LoopCluster> clusters = SplitLoops(tree);
  return std::all_of(clusters.begin(), clusters.end(), [&](const LoopCluster& cluster) {
    return LoopNullSpace(cluster.tree, q(cluster.q)).dimension() > 0;
  });
}

}  // namespace vmech
