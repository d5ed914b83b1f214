#include "vmech/dynamics/reactions/certainty.h"

#include <algorithm>

#include "vmech/base/linear_algebra/linear_algebra.h"
#include "vmech/base/screw_algebra.h"
#include "vmech/dynamics/reactions/loop_loads.h"
#include "vmech/dynamics/reactions/open_reactions.h"
#include "vmech/dynamics/reactions/reactions.h"
#include "vmech/kinematics/loops/closure.h"
#include "vmech/kinematics/loops/dimensionless_loops.h"
#include "vmech/kinematics/loops/loops.h"
#include "vmech/kinematics/loops/mobility.h"

namespace vmech {
namespace {

constexpr double kTouches = 1e-7;  // share of a unit self-stress that counts as load

MatrixXd DependentColumns(const KinematicTree& tree, const CoordinatePartition& partition,
                          const VectorXd& q) {
  const MatrixXd C = DimensionlessLoopJacobian(tree, q);
  MatrixXd C_u(C.rows(), static_cast<Eigen::Index>(partition.dependent.size()));
  for (size_t k = 0; k < partition.dependent.size(); ++k) {
    C_u.col(static_cast<Eigen::Index>(k)) = C.col(partition.dependent[k]);
  }
  return C_u;
}

/// What the multipliers of a loop, dimensionless, do to a joint [6, rows of the loop]: the wrench
/// on its second link about M in the axes of F, forces times the characteristic length.
MatrixXd LoadOnJoint(const KinematicTree& tree, const TreeWorkspace<double>& ws,
                     const LoopLoad& load, const JointState<double>& joint) {
  const Loop& loop = tree.loops[load.loop];
  MatrixXd T(6, loop.rows);
  for (int i = 0; i < loop.rows; ++i) {
    const double mu = load.sign / (IsLengthRow(loop.type, i) ? tree.length : 1);
    const Wrenchd at_joint = WrenchIn(joint.F, mu * ws.loops[load.loop].wrench[i]);
    T.col(i) << tree.length * at_joint.force, at_joint.moment;
  }
  return T;
}

/// One closed pose, and what multipliers load in it.
class PoseOfLoops {
 public:
  PoseOfLoops(const KinematicTree& tree, const VectorXd& q)
      : tree_(tree), loads_(LoopLoadsOfJoints(tree)), ws_(tree), joints_(loads_.size()) {
    EvaluatePose(tree, q, &ws_);
    JointFrames(tree, ws_, &joints_);
  }

  const TreeWorkspace<double>& ws() const { return ws_; }

  /// By loop; none at a joint that no loop goes through.
  std::vector<OpenReactions::Block> LoadsOn(size_t joint) const {
    std::vector<OpenReactions::Block> blocks;
    for (const LoopLoad& load : loads_[joint]) {
      blocks.push_back(
          {static_cast<size_t>(load.loop), LoadOnJoint(tree_, ws_, load, joints_[joint])});
    }
    return blocks;
  }

  /// By the directions [rows, n] of multipliers: the largest load of any of them [6].
  Vector6d LargestLoad(size_t joint, const MatrixXd& directions) const {
    MatrixXd load = MatrixXd::Zero(6, directions.cols());
    for (const OpenReactions::Block& block : LoadsOn(joint)) {
      const Loop& loop = tree_.loops[block.loop];
      load += block.T * directions.middleRows(loop.row, loop.rows);
    }
    return load.cwiseAbs().rowwise().maxCoeff();
  }

 private:
  const KinematicTree& tree_;
  std::vector<std::vector<LoopLoad>> loads_;
  TreeWorkspace<double> ws_;
  std::vector<JointState<double>> joints_;
};

/// The directions of multipliers that the dependent freedoms hardly feel [rows, n].
MatrixXd SingularDirections(const MatrixXd& C_u) {
  const LeftSingularVectors svd = FindLeftSingularVectors(C_u);
  const VectorXd& sigma = svd.values;
  const auto felt = (sigma.array() > kSingularTolerance * sigma.maxCoeff()).count();
  return svd.vectors.middleCols(felt, sigma.size() - felt);
}

void Mark(const Vector6d& load, double touches, Certainty verdict, JointCertainty* joint) {
  for (int i = 0; i < 6; ++i) {
    if (load[i] > touches) (*joint)[i] = verdict;
  }
}

}  // namespace

std::vector<JointCertainty> JudgeCertainty(const KinematicTree& tree,
                                           const CoordinatePartition& partition, const VectorXd& q,
                                           double rounding) {
  constexpr double kNearlySingular = 10 * kSingularTolerance;
  JointCertainty all_certain;
  all_certain.fill(Certainty::kCertain);
  std::vector<JointCertainty> result(tree.mechanism.joints.size(), all_certain);
  if (tree.rows == 0) return result;

  const PoseOfLoops pose(tree, q);
  const OpenReactions open(tree, partition, pose.ws());
  const double touches = std::max(kTouches, TouchOfRounding(rounding));
  MatrixXd singular(tree.rows, 0);
  if (open.LeastSingularValue() < kNearlySingular) {
    singular = SingularDirections(DependentColumns(tree, partition, q));
  }
  for (size_t j = 0; j < result.size(); ++j) {
    const std::vector<OpenReactions::Block> loads = pose.LoadsOn(j);
    if (loads.empty()) continue;
    // First what grows at a dead centre, then what stays open anywhere.
    if (singular.cols() > 0) {
      Mark(pose.LargestLoad(j, singular), touches, Certainty::kSingular, &result[j]);
    }
    Mark(open.LargestOpen(loads), touches, Certainty::kNotDetermined, &result[j]);
  }
  return result;
}

double DistanceFromDeadCentre(const KinematicTree& tree, const CoordinatePartition& partition,
                              const VectorXd& q) {
  if (partition.dependent.empty() || tree.rows == 0) return 1;
  const VectorXd sigma = FindLeftSingularVectors(DependentColumns(tree, partition, q)).values;
  return sigma.minCoeff() / sigma.maxCoeff();
}

}  // namespace vmech
