#include "vmech/kinematics/loops/dimensionless_loops.h"

#include <iterator>

#include "vmech/kinematics/loops/closure.h"
#include "vmech/kinematics/loops/loops.h"

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
