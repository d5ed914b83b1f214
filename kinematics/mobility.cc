#include "vmech/kinematics/mobility.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "vmech/kinematics/assembly.h"
#include "vmech/kinematics/closure.h"
#include "vmech/kinematics/forward_kinematics.h"
#include "vmech/kinematics/linear_algebra.h"
#include "vmech/kinematics/loops.h"
#include "vmech/kinematics/validity.h"

namespace vmech {
namespace {

constexpr double kMoves = 1e-6;  // share of a unit motion that counts as moving

/// Closed poses a little way along every free motion of q, to both sides, and along their sum.
std::vector<VectorXd> Neighbours(const KinematicTree& tree, const VectorXd& q,
                                 const MatrixXd& motions) {
  constexpr double kStep = 0.05;  // [rad]: well clear of a dead centre, well within a branch
  std::vector<VectorXd> neighbours;
  auto add = [&](const VectorXd& direction) {
    VectorXd near = q;
    Integrate(tree, kStep * direction, &near);
    if (Assemble(tree, AssemblyOptions::Nearby(), &near).closed) neighbours.push_back(near);
  };
  for (Eigen::Index k = 0; k < motions.cols(); ++k) {
    add(motions.col(k));
    add(-motions.col(k));
  }
  if (motions.cols() > 1) add(motions.rowwise().sum());
  return neighbours;
}

/// Velocity of every joint in a free motion of the tree: largest of its components, dimensionless.
double JointMotion(const KinematicTree& tree, const TreeWorkspace<double>& ws, int joint) {
  const JointPlacement& place = tree.placements[joint];
  const Posed X_WM = PoseInWorld(ws, place.second_node, place.X_BM);
  auto twist = [&](int node) -> Vector6d {
    if (node < 0) return Vector6d::Zero();
    const NodeState<double>& s = ws.nodes[node];
    Vector6d V;
    V << (s.v + s.w.cross(X_WM.p - s.X_WB.p)) / tree.length, s.w;
    return V;
  };
  return (twist(place.second_node) - twist(place.first_node)).cwiseAbs().maxCoeff();
}

/// Marks the joints that one of the motions at q moves.
void AddMovingJoints(const KinematicTree& tree, const VectorXd& q, const MatrixXd& motions,
                     std::vector<bool>* moves) {
  TreeWorkspace<double> ws(tree);
  EvaluatePose(tree, q, &ws, false);
  for (Eigen::Index k = 0; k < motions.cols(); ++k) {
    const VectorXd v = motions.col(k);
    ForwardVelocities(tree, v.data(), &ws);
    for (size_t j = 0; j < moves->size(); ++j) {
      (*moves)[j] = (*moves)[j] || JointMotion(tree, ws, static_cast<int>(j)) > kMoves;
    }
  }
}

/// Free motions at q as velocities [nv, mobility].
MatrixXd FreeMotions(const KinematicTree& tree, const NullSpace& space) {
  return VelocityScale(tree).asDiagonal() * space.basis;
}

NullSpace SpaceAt(const KinematicTree& tree, const VectorXd& q) {
  return FindNullSpace(DimensionlessLoopJacobian(tree, q), kRankTolerance);
}

size_t IndexOfLargestRank(const std::vector<NullSpace>& spaces) {
  const auto largest =
      std::max_element(spaces.begin(), spaces.end(),
                       [](const NullSpace& a, const NullSpace& b) { return a.rank < b.rank; });
  return static_cast<size_t>(largest - spaces.begin());
}

MatrixXd Columns(const MatrixXd& A, const std::vector<int>& columns) {
  MatrixXd B(A.rows(), static_cast<Eigen::Index>(columns.size()));
  for (size_t k = 0; k < columns.size(); ++k) B.col(k) = A.col(columns[k]);
  return B;
}

}  // namespace

VectorXd VelocityScale(const KinematicTree& tree) {
  VectorXd scale = VectorXd::Ones(tree.nv);
  for (const TreeNode& node : tree.nodes) {
    if (node.motion == NodeMotion::kPrismatic) scale[node.v] = tree.length;
  }
  return scale;
}

MatrixXd DimensionlessLoopJacobian(const KinematicTree& tree, const VectorXd& q) {
  TreeWorkspace<double> ws(tree);
  EvaluatePose(tree, q, &ws);
  return LoopRowScale(tree).asDiagonal() * DenseLoopJacobian(tree, ws) *
         VelocityScale(tree).asDiagonal();
}

Mobility AnalyseMobility(const KinematicTree& tree, const VectorXd& q) {
  RequireCoordinates("AnalyseMobility: q", tree, q);
  Mobility result;
  result.gruebler = tree.nv - tree.rows;
  std::vector<VectorXd> poses{q};
  std::vector<NullSpace> spaces{SpaceAt(tree, q)};
  for (VectorXd& near : Neighbours(tree, q, FreeMotions(tree, spaces[0]))) {
    spaces.push_back(SpaceAt(tree, near));
    poses.push_back(std::move(near));
  }
  const size_t best = IndexOfLargestRank(spaces);
  result.q_general = poses[best];
  result.rank = spaces[best].rank;
  result.singular_here = spaces[0].rank < result.rank;
  result.mobility = tree.nv - result.rank;
  result.redundant = tree.rows - result.rank;
  // At one pose alone a joint may stand still for a moment, as a rocker does where it turns back.
  result.joint_moves.assign(tree.mechanism.joints.size(), false);
  for (size_t i = 0; i < poses.size(); ++i) {
    if (spaces[i].rank < result.rank) continue;
    AddMovingJoints(tree, poses[i], FreeMotions(tree, spaces[i]), &result.joint_moves);
  }
  return result;
}

CoordinatePartition PartitionForDrives(const KinematicTree& tree, const VectorXd& q_general,
                                       const std::vector<int>& driven) {
  RequireCoordinates("PartitionForDrives: q", tree, q_general);
  RequireVelocities("PartitionForDrives: driven", tree, driven);
  const MatrixXd C = DimensionlessLoopJacobian(tree, q_general);
  const NullSpace free = FindNullSpace(C, kRankTolerance);
  MatrixXd driven_rows(driven.size(), free.basis.cols());
  for (size_t k = 0; k < driven.size(); ++k) driven_rows.row(k) = free.basis.row(driven[k]);
  const int controlled = FindNullSpace(driven_rows, kRankTolerance).rank;
  if (controlled < static_cast<int>(driven.size())) {
    std::string names;
    for (int v : driven) names += (names.empty() ? "'" : ", '") + NameOfVelocity(tree, v) + "'";
    throw std::invalid_argument(fmt::format(
        "the drives at {} cannot all move as they like: the mechanism has mobility {} and they "
        "control {} of it; drive fewer joints, or other ones",
        names, free.basis.cols(), controlled));
  }

  const CoordinatePartition first = MakePartition(tree, driven, {});
  const NullSpace loose = FindNullSpace(Columns(C, first.dependent), kRankTolerance);
  if (loose.basis.cols() == 0) return first;
  std::vector<int> idle;
  for (int slot : MostIndependentRows(loose.basis, static_cast<int>(loose.basis.cols()))) {
    idle.push_back(first.dependent[slot]);
  }
  return MakePartition(tree, driven, idle);
}

CoordinatePartition PartitionAtPose(const KinematicTree& tree, const VectorXd& q) {
  RequireCoordinates("PartitionAtPose: q", tree, q);
  const NullSpace free = SpaceAt(tree, q);
  return MakePartition(tree, MostIndependentRows(free.basis, static_cast<int>(free.basis.cols())),
                       {});
}

}  // namespace vmech
