#include "vmech/kinematics/loops/mobility.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "vmech/base/linear_algebra/linear_algebra.h"
#include "vmech/base/screw_algebra.h"
#include "vmech/kinematics/loops/assembly.h"
#include "vmech/kinematics/loops/closure.h"
#include "vmech/kinematics/loops/dimensionless_loops.h"
#include "vmech/kinematics/loops/loop_clusters.h"
#include "vmech/kinematics/loops/loops.h"
#include "vmech/kinematics/tree/forward_kinematics.h"
#include "vmech/kinematics/tree/validity.h"

namespace vmech {
namespace {

constexpr double kMoves = 1e-6;  // share of a unit motion that counts as moving

/// Free motions of a cluster as velocities [nv, some of them and the sum of all].
MatrixXd SomeFreeMotions(const KinematicTree& tree, const BlockNullSpace& free) {
  constexpr int kMost = 12;
  const int all = free.dimension(), some = std::min(all, kMost);
  MatrixXd coordinates = MatrixXd::Identity(all, some + (all > 1));
  if (all > 1) coordinates.col(some).setOnes();
  return VelocityScale(tree).asDiagonal() * free.FromCoordinates(coordinates);
}

/// Closed poses a little way along free motions of q, to both sides, and along their sum.
std::vector<VectorXd> Neighbours(const KinematicTree& tree, const VectorXd& q,
                                 const MatrixXd& motions) {
  constexpr double kStep = 0.05;  // [rad]: well clear of a dead centre, well within a branch
  std::vector<VectorXd> neighbours;
  auto add = [&](const VectorXd& direction) {
    VectorXd near = q;
    MoveCoordinates(tree, kStep * direction, &near);
    if (Assemble(tree, AssemblyOptions::Nearby(), &near).closed) neighbours.push_back(near);
  };
  const Eigen::Index single = motions.cols() > 1 ? motions.cols() - 1 : motions.cols();
  for (Eigen::Index k = 0; k < single; ++k) {
    add(motions.col(k));
    add(-motions.col(k));
  }
  if (motions.cols() > 1) add(motions.col(single));
  return neighbours;
}

/// Relative twists [v; w] of the anchors of a cut joint by the velocities of its loop,
/// dimensionless [6, columns].
MatrixXd AnchorTwists(const KinematicTree& tree, const TreeWorkspace<double>& ws, size_t loop) {
  const std::vector<LoopColumn>& columns = tree.loops[loop].columns;
  MatrixXd twists(6, std::ssize(columns));
  for (size_t k = 0; k < columns.size(); ++k) {
    const Screw S = columns[k].sign * ws.S[columns[k].v];
    const Screw at_anchor{VelocityAt(ws.loops[loop].F.p, S), S.angular};
    const bool slides = tree.nodes[columns[k].node].motion == NodeMotion::kPrismatic;
    twists.col(k) = (slides ? tree.length : 1) * Vector6Of(at_anchor);
  }
  twists.topRows<3>() /= tree.length;
  return twists;
}

/// How a cluster can move.
struct ClusterMobility {
  int rank = 0;
  bool singular_here = false;
  VectorXd q_general;
  std::vector<bool> node_moves, cut_moves;  ///< by node and by loop, against the neighbours
};

/// Marks what the motions that are free at q move: a vector that one of them has a share in.
void AddMoving(const KinematicTree& tree, const VectorXd& q, const BlockNullSpace& free,
               ClusterMobility* result) {
  TreeWorkspace<double> ws(tree);
  EvaluatePose(tree, q, &ws, false);
  for (size_t l = 0; l < tree.loops.size(); ++l) {
    const std::vector<LoopColumn>& columns = tree.loops[l].columns;
    const Eigen::Index count = std::ssize(columns);
    const VectorXd share = free.LargestOf(l, MatrixXd::Identity(count, count));
    for (size_t k = 0; k < columns.size(); ++k) {
      if (share[static_cast<Eigen::Index>(k)] > kMoves) result->node_moves[columns[k].node] = true;
    }
    const VectorXd between = free.LargestOf(l, AnchorTwists(tree, ws, l));
    if (between.maxCoeff() > kMoves) result->cut_moves[l] = true;
  }
}

ClusterMobility AnalyseCluster(const KinematicTree& tree, const VectorXd& q) {
  std::vector<VectorXd> poses{q};
  std::vector<int> ranks;
  {
    const BlockNullSpace here = LoopNullSpace(tree, q);
    ranks.push_back(here.rank());
    for (VectorXd& near : Neighbours(tree, q, SomeFreeMotions(tree, here))) {
      ranks.push_back(LoopNullSpace(tree, near).rank());
      poses.push_back(std::move(near));
    }
  }
  const auto best = std::max_element(ranks.begin(), ranks.end());
  ClusterMobility result;
  result.rank = *best;
  result.singular_here = ranks[0] < *best;
  result.q_general = poses[static_cast<size_t>(best - ranks.begin())];
  result.node_moves.assign(tree.nodes.size(), false);
  result.cut_moves.assign(tree.loops.size(), false);
  // At one pose alone a joint may stand still for a moment, as a rocker does where it turns back.
  for (size_t i = 0; i < poses.size(); ++i) {
    if (ranks[i] == *best) AddMoving(tree, poses[i], LoopNullSpace(tree, poses[i]), &result);
  }
  return result;
}

/// Enters what a cluster can do into that of the whole.
void Enter(const KinematicTree& tree, const LoopCluster& cluster, const ClusterMobility& part,
           Mobility* whole) {
  whole->rank += part.rank;
  whole->singular_here = whole->singular_here || part.singular_here;
  whole->q_general(cluster.q) = part.q_general;
  for (size_t n = 0; n < cluster.nodes.size(); ++n) {
    if (part.node_moves[n]) whole->joint_moves[tree.nodes[cluster.nodes[n]].joint] = true;
  }
  for (size_t l = 0; l < cluster.joints.size(); ++l) {
    if (part.cut_moves[l]) whole->joint_moves[cluster.joints[l]] = true;
  }
}

/// Joints that turn or slide and close no loop.
std::vector<bool> LooseJoints(const KinematicTree& tree, const std::vector<LoopCluster>& clusters) {
  std::vector<bool> loose(tree.mechanism.joints.size(), false);
  for (const TreeNode& node : tree.nodes) {
    if (node.v >= 0) loose[node.joint] = true;
  }
  for (const LoopCluster& cluster : clusters) {
    for (const int node : cluster.nodes) loose[tree.nodes[node].joint] = false;
  }
  return loose;
}

}  // namespace

Mobility AnalyseMobility(const KinematicTree& tree, const VectorXd& q) {
  RequireCoordinates("AnalyseMobility: q", tree, q);
  const std::vector<LoopCluster> clusters = SplitLoops(tree);
  Mobility result;
  result.gruebler = tree.nv - tree.rows;
  result.q_general = q;
  result.joint_moves = LooseJoints(tree, clusters);
  for (const LoopCluster& cluster : clusters) {
    Enter(tree, cluster, AnalyseCluster(cluster.tree, q(cluster.q)), &result);
  }
  result.mobility = tree.nv - result.rank;
  result.redundant = tree.rows - result.rank;
  return result;
}

CoordinatePartition PartitionForDrives(const KinematicTree& tree, const VectorXd& q_general,
                                       const std::vector<int>& driven) {
  RequireCoordinates("PartitionForDrives: q", tree, q_general);
  RequireVelocities("PartitionForDrives: driven", tree, driven);
  const MatrixXd free = LoopNullSpace(tree, q_general).Basis();
  const int controlled = FindNullSpace(free(driven, Eigen::all), kRankTolerance).rank;
  if (controlled < static_cast<int>(driven.size())) {
    std::string names;
    for (int v : driven) names += (names.empty() ? "'" : ", '") + NameOfVelocity(tree, v) + "'";
    throw std::invalid_argument(fmt::format(
        "the drives at {} cannot all move as they like: the mechanism has mobility {} and they "
        "control {} of it; drive fewer joints, or other ones",
        names, free.cols(), controlled));
  }

  std::vector<bool> held(tree.nv, false);
  for (const int v : driven) held[v] = true;
  const MatrixXd loose = LoopNullSpace(tree, q_general, held).Basis();
  return MakePartition(tree, driven, MostIndependentRows(loose, static_cast<int>(loose.cols())));
}

CoordinatePartition PartitionAtPose(const KinematicTree& tree, const VectorXd& q) {
  RequireCoordinates("PartitionAtPose: q", tree, q);
  const MatrixXd free = LoopNullSpace(tree, q).Basis();
  return MakePartition(tree, MostIndependentRows(free, static_cast<int>(free.cols())), {});
}

}  // namespace vmech
