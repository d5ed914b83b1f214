#include "vmech/kinematics/loops/dimensionless_loops.h"

#include <iterator>

#include "vmech/kinematics/loops/closure.h"
#include "vmech/kinematics/loops/loops.h"
#include "vmech/kinematics/tree/forward_kinematics.h"

namespace vmech {

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
  MatrixXd C = MatrixXd::Zero(tree.rows, tree.nv);
  for (size_t l = 0; l < tree.loops.size(); ++l) {
    const RowBlock rows = DimensionlessLoopRows(tree, ws, l);
    C.middleRows(tree.loops[l].row, tree.loops[l].rows)(Eigen::all, rows.columns) = rows.A;
  }
  return C;
}

VectorXd BindingRowScale(const KinematicTree& tree) {
  VectorXd scale = LoopRowScale(tree), q = StartCoordinates(tree);
  const VectorXd way = VelocityScale(tree).cwiseProduct(VectorXd::LinSpaced(tree.nv, 0.3, 0.7));
  VectorXd size = VectorXd::Zero(tree.rows);
  TreeWorkspace<double> ws(tree);
  for (const double moved : {0.0, 1.0}) {
    MoveCoordinates(tree, moved * way, &q);
    EvaluatePose(tree, q, &ws, false);
    size = size.cwiseMax(scale.cwiseProduct(StackedLoopErrors(tree, ws)).cwiseAbs())
               .cwiseMax(DimensionlessLoopJacobian(tree, q).rowwise().lpNorm<1>());
  }
  for (const Loop& loop : tree.loops) {
    const auto rows = Eigen::seqN(loop.row, loop.rows);
    if (size(rows).maxCoeff() < kRankTolerance) scale(rows).setZero();
  }
  return scale;
}

RowBlock DimensionlessLoopRows(const KinematicTree& tree, const TreeWorkspace<double>& ws,
                               size_t loop) {
  const std::vector<LoopColumn>& columns = tree.loops[loop].columns;
  const int rows = tree.loops[loop].rows;
  RowBlock block{{}, MatrixXd(rows, std::ssize(columns))};
  for (size_t k = 0; k < columns.size(); ++k) {
    const TreeNode& node = tree.nodes[columns[k].node];
    const double per_velocity = node.motion == NodeMotion::kPrismatic ? tree.length : 1;
    for (int i = 0; i < rows; ++i) {
      const double per_row = IsLengthRow(tree.loops[loop].type, i) ? 1 / tree.length : 1;
      block.A(i, static_cast<Eigen::Index>(k)) = per_row * ws.columns(loop)[k][i] * per_velocity;
    }
    block.columns.push_back(columns[k].v);
  }
  return block;
}

BlockNullSpace LoopNullSpace(const KinematicTree& tree, const VectorXd& q,
                             const std::vector<bool>& held) {
  TreeWorkspace<double> ws(tree);
  EvaluatePose(tree, q, &ws);
  std::vector<RowBlock> blocks;
  for (size_t l = 0; l < tree.loops.size(); ++l) {
    blocks.push_back(DimensionlessLoopRows(tree, ws, l));
  }
  return {tree.nv, blocks, kRankTolerance, held};
}

}  // namespace vmech
