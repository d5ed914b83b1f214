#include "vmech/kinematics/loops/reconcile.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "vmech/base/rotation_error.h"
#include "vmech/base/screw_algebra.h"
#include "vmech/kinematics/loops/closure.h"
#include "vmech/kinematics/loops/loop_walk.h"
#include "vmech/kinematics/loops/loops.h"
#include "vmech/kinematics/loops/mechanism_parts.h"
#include "vmech/kinematics/tree/forward_kinematics.h"

namespace vmech {
namespace {

constexpr double kClosed = 2e-15;     // rounding of the machine
constexpr double kMade = 1e-12;       // that a mechanism moves through all its poses
constexpr double kLeastPivot = 1e-8;  // smaller ones are those of second order
constexpr int kMaxIterations = 12;

/// The anchors at the joints of all loops, and how their movements open the loops.
class AnchorMoves {
 public:
  AnchorMoves(const KinematicTree& tree) : tree_(tree) {
    for (const Loop& loop : tree.loops) {
      AddJoint(loop.joint);
      for (const LoopNode& n : loop.path) AddJoint(tree.nodes[n.node].joint);
    }
  }

  Eigen::Index size() const { return 6 * static_cast<Eigen::Index>(index_.size()); }

  /// P [rows, size]: e(p) = e - P p, dimensionless.
  MatrixXd Jacobian(const VectorXd& q) const {
    TreeWorkspace<double> ws(tree_);
    EvaluatePose(tree_, q, &ws, false);
    const VectorXd row_scale = LoopRowScale(tree_);
    MatrixXd P = MatrixXd::Zero(tree_.rows, size());
    for (size_t l = 0; l < tree_.loops.size(); ++l) {
      const Loop& loop = tree_.loops[l];
      AddTo(ws, static_cast<int>(l), loop.joint, -1, row_scale, &P);
      for (const LoopNode& n : loop.path) {
        const TreeNode& node = tree_.nodes[n.node];
        if (tree_.placements[node.joint].tree_node != n.node) continue;
        AddTo(ws, static_cast<int>(l), node.joint, node.reversed ? -n.sign : n.sign, row_scale, &P);
      }
    }
    return P;
  }

  void Apply(const VectorXd& p, Mechanism* mechanism) const {
    for (const auto& [id, index] : index_) {
      Posed& X_LA = mechanism->links[id.first].anchors[id.second].X_LA;
      const Vector6d twist = p.segment<6>(6 * index);
      X_LA = {X_LA.R * RotationBy(twist.tail<3>()),
              X_LA.p + tree_.length * (X_LA.R * twist.head<3>())};
    }
  }

 private:
  using Id = std::pair<int, int>;

  void AddJoint(int j) {
    const Joint& joint = tree_.mechanism.joints[j];
    for (const AnchorId& id : {joint.first, joint.second}) {
      index_.emplace(Id(id.link, id.anchor), static_cast<int>(index_.size()));
    }
  }

  /// The share of a joint's anchors: moving the one on its first link moves what is beyond it.
  void AddTo(const TreeWorkspace<double>& ws, int l, int j, double sign, const VectorXd& row_scale,
             MatrixXd* P) const {
    const Joint& joint = tree_.mechanism.joints[j];
    const JointPlacement& place = tree_.placements[j];
    AddAnchor(ws, l, joint.first, ws.at(place.first_node).X * place.X_AF, sign, row_scale, P);
    AddAnchor(ws, l, joint.second, ws.at(place.second_node).X * place.X_BM, -sign, row_scale, P);
  }

  void AddAnchor(const TreeWorkspace<double>& ws, int l, AnchorId id, const Frame& A, double sign,
                 const VectorXd& row_scale, MatrixXd* P) const {
    const Loop& loop = tree_.loops[l];
    const LoopState<double>& s = ws.loops[l];
    const int column = 6 * index_.at(Id(id.link, id.anchor));
    for (int k = 0; k < 6; ++k) {
      const Double4 axis = k % 3 == 0 ? A.x : k % 3 == 1 ? A.y : A.z;
      const Double4 linear = k < 3 ? tree_.length * axis : Cross(axis, s.F.p - A.p);
      const Double4 angular = k < 3 ? Double4{} : axis;
      const Vector6d opened =
          sign * ProjectOnRows<double>(loop, s, Vector3Of(InverseRotate(s.F, linear)),
                                       Vector3Of(InverseRotate(s.F, angular)));
      for (int i = 0; i < loop.rows; ++i) {
        (*P)(loop.row + i, column + k) += row_scale[loop.row + i] * opened[i];
      }
    }
  }

  const KinematicTree& tree_;
  std::map<Id, int> index_;
};

SpanningTreeOptions SameCuts(const KinematicTree& tree) {
  SpanningTreeOptions options;
  options.cut = tree.spanning.cuts;
  return options;
}

/// Moves anchors until the loops close at all poses of a walk.
class AnchorFit {
 public:
  AnchorFit(const KinematicTree& tree, Walk walk) : tree_(tree), walk_(std::move(walk)) {}

  /// False if they do not.
  bool Run() {
    for (int i = 0; i < kMaxIterations && walk_.misfit > kClosed; ++i) {
      const double before = walk_.misfit;
      const VectorXd p = Step();
      Mechanism moved = tree_.mechanism;
      AnchorMoves(tree_).Apply(p, &moved);
      const double length = tree_.length;
      tree_ = BuildKinematicTree(std::move(moved), SameCuts(tree_));
      tree_.length = length;
      walk_.misfit = Close();
      const bool slow = walk_.misfit > 0.5 * before;
      if (slow && (i > 1 || walk_.misfit <= kMade)) break;
    }
    return walk_.misfit <= kMade;
  }

  double misfit() const { return walk_.misfit; }
  const KinematicTree& tree() const { return tree_; }
  const VectorXd& q() const { return walk_.poses.front().q; }

 private:
  /// p of U_k' P_k p = U_k' e_k.
  VectorXd Step() {
    LoopCloser closer(tree_, walk_.tolerance);
    const AnchorMoves moves(tree_);
    std::vector<MatrixXd> blocks;
    std::vector<VectorXd> rights;
    Eigen::Index rows = 0;
    double misfit = 0;
    for (const WalkedPose& pose : walk_.poses) {
      const LoopEquations at = closer.At(pose.q);
      const MatrixXd& U = at.C.left_null_space;
      blocks.push_back(U.transpose() * moves.Jacobian(pose.q));
      rights.push_back(U.transpose() * at.e);
      rows += U.cols();
      misfit = std::max(misfit, at.e.cwiseAbs().maxCoeff());
    }
    MatrixXd A(rows, moves.size());
    VectorXd b(rows);
    for (size_t k = 0, row = 0; k < blocks.size(); row += blocks[k++].rows()) {
      A.middleRows(row, blocks[k].rows()) = blocks[k];
      b.segment(row, blocks[k].rows()) = rights[k];
    }
    // U is known to the misfit: dependent rows contradict each other by its square.
    return MinimumNormSolution(A, b, std::max(kLeastPivot, 3 * misfit));
  }

  double Close() {
    LoopCloser closer(tree_, walk_.tolerance);
    double misfit = 0;
    for (WalkedPose& pose : walk_.poses) {
      if (!closer.Close(1, &pose)) return 1;
      misfit = std::max(misfit, pose.misfit);
    }
    return misfit;
  }

  KinematicTree tree_;
  Walk walk_;
};

/// How far the anchors of two mechanisms are apart.
void MeasureCorrection(const KinematicTree& drawn, Reconciliation* result) {
  double sum = 0, largest = 0;
  int count = 0;
  for (size_t j = 0; j < drawn.mechanism.joints.size(); ++j) {
    const Joint& joint = drawn.mechanism.joints[j];
    for (const AnchorId& id : {joint.first, joint.second}) {
      const Posed& before = drawn.mechanism.anchor(id).X_LA;
      const Posed& after = result->mechanism.anchor(id).X_LA;
      const double turn = Eigen::AngleAxisd(Matrix3d(before.R.transpose() * after.R)).angle();
      const double moved = std::hypot((after.p - before.p).norm() / drawn.length, turn);
      if (moved == 0) continue;
      sum += moved * moved;
      ++count;
      if (moved <= largest) continue;
      largest = moved;
      result->joint = static_cast<int>(j);
    }
  }
  result->correction = count > 0 ? std::sqrt(sum / count) : 0;
}

/// Moves the anchors of a part and enters them, with its pose, into the whole. False if it does not
/// close.
bool ReconcilePart(const MechanismPart& part, const ReconcileOptions& options,
                   Reconciliation* whole) {
  Walk walk = FindWalk(part.tree, whole->q(part.q), options.largest_misfit, options.poses);
  if (walk.poses.empty()) return false;
  AnchorFit fit(part.tree, std::move(walk));
  if (!fit.Run()) return false;
  const Mechanism& moved = fit.tree().mechanism;
  for (size_t k = 0; k < part.joints.size(); ++k) {
    const Joint &here = moved.joints[k], &there = whole->mechanism.joints[part.joints[k]];
    for (const auto& [from, to] :
         {std::pair(here.first, there.first), {here.second, there.second}}) {
      whole->mechanism.links[to.link].anchors[to.anchor].X_LA = moved.anchor(from).X_LA;
    }
  }
  whole->q(part.q) = fit.q();
  whole->misfit = std::max(whole->misfit, fit.misfit());
  return true;
}

}  // namespace

Reconciliation Reconcile(const KinematicTree& tree, const VectorXd& q,
                         const ReconcileOptions& options) {
  Reconciliation drawn;
  drawn.mechanism = tree.mechanism;
  drawn.q = q;
  Reconciliation result = drawn;
  for (const MechanismPart& part : SplitMechanism(tree)) {
    if (!ReconcilePart(part, options, &result)) return drawn;
  }
  result.closes = true;
  MeasureCorrection(tree, &result);
  return result;
}

}  // namespace vmech
