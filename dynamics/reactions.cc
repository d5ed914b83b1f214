#include "vmech/dynamics/reactions.h"

#include <algorithm>

#include "vmech/kinematics/forward_kinematics.h"
#include "vmech/kinematics/loops.h"

namespace vmech {
namespace {

/// Directions that a joint type leaves free, axes of F.
struct Freedoms {
  bool force[3];
  bool moment[3];
};
constexpr Freedoms kFree[] = {
    {{false, false, false}, {false, false, true}},   // revolute
    {{false, false, true}, {false, false, false}},   // prismatic
    {{false, false, true}, {false, false, true}},    // cylindrical
    {{false, false, false}, {false, false, true}},   // screw: holds the travel, not the turn
    {{false, false, false}, {true, true, false}},    // universal
    {{false, false, false}, {true, true, true}},     // spherical
    {{true, true, false}, {false, false, true}},     // planar
    {{false, false, false}, {false, false, false}},  // weld
};

/// R diag(d) R' = d_x 1 + (d_y - d_x) y y' + (d_z - d_x) z z'.
Matrix3d InWorld(const Matrix3d& R, const Vector3d& d) {
  Matrix3d D = ((d.z() - d.x()) * R.col(2)) * R.col(2).transpose();
  if (d.y() != d.x()) D += ((d.y() - d.x()) * R.col(1)) * R.col(1).transpose();
  D.diagonal().array() += d.x();
  return D;
}

/// S(d) A: the columns of A crossed by d.
Matrix3d CrossColumns(const Vector3d& d, const Matrix3d& A) {
  Matrix3d crossed;
  for (int k = 0; k < 3; ++k) crossed.col(k) = d.cross(A.col(k));
  return crossed;
}

}  // namespace

std::vector<JointCompliance> CompliancesForRule(const KinematicTree& tree, ReactionRule rule,
                                                double length) {
  std::vector<JointCompliance> compliances;
  for (const Joint& joint : tree.mechanism.joints) {
    Vector6d stiffness;
    stiffness.head<3>().setConstant(kDefaultStiffness);
    stiffness.tail<3>().setConstant(kDefaultStiffness * length * length);
    if (rule == ReactionRule::kStiffness && joint.stiffness) stiffness = *joint.stiffness;
    const Freedoms& free = kFree[static_cast<int>(joint.type)];
    JointCompliance compliance;
    for (int k = 0; k < 3; ++k) {
      if (!free.force[k]) compliance.force[k] = 1 / stiffness[k];
      if (!free.moment[k]) compliance.moment[k] = 1 / stiffness[3 + k];
    }
    compliances.push_back(compliance);
  }
  return compliances;
}

void JointFrames(const KinematicTree& tree, const TreeWorkspace<double>& ws,
                 std::vector<JointState>* joints) {
  for (size_t j = 0; j < joints->size(); ++j) {
    const JointPlacement& place = tree.placements[j];
    const int a = place.first_node, b = place.second_node;
    (*joints)[j].R_WF = a < 0 ? place.X_AF.R : Matrix3d(ws.nodes[a].X_WB.R * place.X_AF.R);
    (*joints)[j].p_WM = b < 0 ? place.X_BM.p : ws.nodes[b].X_WB * place.X_BM.p;
    if (tree.mechanism.joints[j].type != JointType::kUniversal) continue;
    const Vector3d y_M_W = PoseInWorld(ws, b, place.X_BM).R.col(1);
    (*joints)[j].n_W = y_M_W.cross((*joints)[j].R_WF.col(0)).normalized();
  }
}

void TreeJointWrenches(const KinematicTree& tree, const TreeWorkspace<double>& ws,
                       std::vector<JointState>* joints) {
  for (size_t j = 0; j < joints->size(); ++j) {
    const int index = tree.placements[j].tree_node;
    if (index < 0) continue;
    JointState& joint = (*joints)[j];
    const NodeState<double>& node = ws.nodes[index];
    const Wrenchd W = node.F_Bo.ShiftedBy(node.X_WB.p - joint.p_WM);
    joint.W_M = tree.nodes[index].reversed ? -W : W;
  }
}

void AddMultiplierWrenches(const KinematicTree& tree, const double* mu, TreeWorkspace<double>* ws) {
  for (size_t l = 0; l < tree.loops.size(); ++l) {
    const Loop& loop = tree.loops[l];
    const LoopState<double>& s = ws->loops[l];
    const Wrenchd W_F = WrenchOfMultipliers(loop, s, mu + loop.row);
    const Wrenchd W{s.R_WF * W_F.force, s.R_WF * W_F.moment};
    for (const LoopNode& n : loop.path) {
      NodeState<double>& node = ws->nodes[n.node];
      const Wrenchd share = W.ShiftedBy(s.p_WM - node.X_WB.p);
      node.F_Bo.force -= n.sign * share.force;
      node.F_Bo.moment -= n.sign * share.moment;
    }
  }
}

ReactionSolver::ReactionSolver(const KinematicTree& tree, const CoordinatePartition& partition,
                               std::vector<JointCompliance> compliances)
    : tree_(tree),
      partition_(partition),
      compliances_(std::move(compliances)),
      loads_(tree.mechanism.joints.size()),
      soft_force_W_(tree.mechanism.joints.size()),
      soft_moment_W_(tree.mechanism.joints.size()),
      strain_W_(tree.loops.size()) {
  FindLoads();
  OrderUnknowns();
}

void ReactionSolver::FindLoads() {
  for (size_t l = 0; l < tree_.loops.size(); ++l) {
    const Loop& loop = tree_.loops[l];
    const int index = static_cast<int>(l);
    loads_[loop.joint].push_back({index, 1.0});
    for (const LoopNode& n : loop.path) {
      const TreeNode& node = tree_.nodes[n.node];
      if (tree_.placements[node.joint].tree_node != n.node) continue;
      loads_[node.joint].push_back({index, node.reversed ? n.sign : -n.sign});
    }
  }
  for (size_t j = 0; j < loads_.size(); ++j) {
    for (size_t a = 0; a < loads_[j].size(); ++a) {
      for (size_t b = 0; b < loads_[j].size(); ++b) {
        if (loads_[j][a].loop < loads_[j][b].loop) continue;
        contributions_.push_back({static_cast<int>(j), static_cast<int>(a), static_cast<int>(b),
                                  BlockIndex(loads_[j][a].loop, loads_[j][b].loop)});
      }
    }
  }
}

int ReactionSolver::BlockIndex(int k, int l) {
  for (size_t i = 0; i < blocks_.size(); ++i) {
    if (blocks_[i].k == k && blocks_[i].l == l) return static_cast<int>(i);
  }
  blocks_.push_back({k, l, Matrix6d::Zero()});
  return static_cast<int>(blocks_.size()) - 1;
}

void ReactionSolver::OrderUnknowns() {
  const size_t dependents = partition_.dependent.size();
  std::vector<int> first_loop(dependents, -1), last_loop(dependents, -1);
  for (size_t l = 0; l < tree_.loops.size(); ++l) {
    for (const LoopColumn& c : tree_.loops[l].columns) {
      const int slot = partition_.dependent_slot[c.v];
      if (slot < 0) continue;
      last_loop[slot] = static_cast<int>(l);
      if (first_loop[slot] < 0) first_loop[slot] = static_cast<int>(l);
    }
  }
  std::vector<int> coupled_from(tree_.loops.size());
  for (size_t l = 0; l < coupled_from.size(); ++l) coupled_from[l] = static_cast<int>(l);
  for (const Block& block : blocks_)
    coupled_from[block.k] = std::min(coupled_from[block.k], block.l);

  std::vector<int> first;
  dependent_position_.assign(dependents, -1);
  for (size_t l = 0; l < tree_.loops.size(); ++l) {
    row_position_.push_back(static_cast<int>(first.size()));
    first.insert(first.end(), tree_.loops[l].rows, row_position_[coupled_from[l]]);
    // A row also meets the dependents placed before it that move its loop: they come after the
    // rows of their own last loop, which is this one or a later one, so there are none.
    for (size_t u = 0; u < dependents; ++u) {
      if (last_loop[u] != static_cast<int>(l)) continue;
      dependent_position_[u] = static_cast<int>(first.size());
      first.push_back(row_position_[first_loop[u]]);
    }
  }
  unknowns_.assign(first.size(), 0.0);
  matrix_ = EnvelopeLdlt(first);
}

void ReactionSolver::Factor(const TreeWorkspace<double>& ws,
                            const std::vector<JointState>& joints) {
  for (size_t j = 0; j < joints.size(); ++j) {
    if (loads_[j].empty()) continue;
    soft_force_W_[j] = InWorld(joints[j].R_WF, compliances_[j].force);
    soft_moment_W_[j] =
        tree_.mechanism.joints[j].type == JointType::kUniversal
            ? Matrix3d(compliances_[j].moment.z() * joints[j].n_W * joints[j].n_W.transpose())
            : InWorld(joints[j].R_WF, compliances_[j].moment);
  }
  for (Block& block : blocks_) block.A_W.setZero();
  for (const Contribution& c : contributions_) {
    // W_j = sign (f, m + d x f) for a wrench (f, m) at the cut, d from M of joint j to the cut:
    //   A_ff = D_f - S_k D_m S_l,  A_fm = -S_k D_m,  A_mf = D_m S_l,  A_mm = D_m,  S = S(d).
    const Load& k = loads_[c.joint][c.load_k];
    const Load& l = loads_[c.joint][c.load_l];
    const double sign = k.sign * l.sign;
    const Vector3d d_k = ws.loops[k.loop].p_WM - joints[c.joint].p_WM;
    const Vector3d d_l = ws.loops[l.loop].p_WM - joints[c.joint].p_WM;
    const Matrix3d& D_m = soft_moment_W_[c.joint];
    const Matrix3d D_m_S_l = -CrossColumns(d_l, D_m).transpose();
    Matrix6d& A = blocks_[c.block].A_W;
    A.topLeftCorner<3, 3>() += sign * (soft_force_W_[c.joint] - CrossColumns(d_k, D_m_S_l));
    A.topRightCorner<3, 3>() -= sign * CrossColumns(d_k, D_m);
    A.bottomLeftCorner<3, 3>() += sign * D_m_S_l;
    A.bottomRightCorner<3, 3>() += sign * D_m;
  }
  matrix_.SetZero();
  for (const Block& block : blocks_) AddBlockToMatrix(ws, block);
  AddJacobianToMatrix(ws);
  matrix_.Factor();
}

void ReactionSolver::AddBlockToMatrix(const TreeWorkspace<double>& ws, const Block& block) {
  const Loop& loop_k = tree_.loops[block.k];
  const Loop& loop_l = tree_.loops[block.l];
  const Matrix3d& R_k = ws.loops[block.k].R_WF;
  const Matrix3d& R_l = ws.loops[block.l].R_WF;
  // T_k' (R_k' A_W R_l) T_l, column by column and then row by row.
  Matrix6d A_F;
  for (int i = 0; i < 6; i += 3) {
    for (int j = 0; j < 6; j += 3) {
      A_F.block<3, 3>(i, j) = R_k.transpose() * block.A_W.block<3, 3>(i, j) * R_l;
    }
  }
  Matrix6d half;
  for (int j = 0; j < 6; ++j) {
    half.row(j) = ProjectOnRows<double>(loop_k, ws.loops[block.k], A_F.col(j).head<3>(),
                                        A_F.col(j).tail<3>());
  }
  for (int i = 0; i < loop_k.rows; ++i) {
    const Vector6d row = ProjectOnRows<double>(loop_l, ws.loops[block.l], half.col(i).head<3>(),
                                               half.col(i).tail<3>());
    const int columns = block.k == block.l ? i + 1 : loop_l.rows;
    for (int j = 0; j < columns; ++j) {
      matrix_(row_position_[block.k] + i, row_position_[block.l] + j) += row[j];
    }
  }
}

void ReactionSolver::AddJacobianToMatrix(const TreeWorkspace<double>& ws) {
  for (size_t l = 0; l < tree_.loops.size(); ++l) {
    const Vector6d* C = &ws.loop_columns[ws.first_column[l]];
    for (const LoopColumn& c : tree_.loops[l].columns) {
      const int slot = partition_.dependent_slot[c.v];
      if (slot >= 0) {
        for (int i = 0; i < tree_.loops[l].rows; ++i) {
          matrix_(dependent_position_[slot], row_position_[l] + i) = (*C)[i];
        }
      }
      ++C;
    }
  }
}

void ReactionSolver::Solve(const TreeWorkspace<double>& ws, const std::vector<JointState>& joints,
                           const double* r, double* mu) {
  for (Wrenchd& strain : strain_W_) strain = {};
  for (size_t j = 0; j < joints.size(); ++j) {
    if (loads_[j].empty()) continue;
    const Vector3d give = soft_force_W_[j] * joints[j].W_M.force;
    const Vector3d turn = soft_moment_W_[j] * joints[j].W_M.moment;
    for (const Load& load : loads_[j]) {
      const Vector3d d = ws.loops[load.loop].p_WM - joints[j].p_WM;
      strain_W_[load.loop].force += load.sign * (give - d.cross(turn));
      strain_W_[load.loop].moment += load.sign * turn;
    }
  }
  for (size_t l = 0; l < tree_.loops.size(); ++l) {
    const Wrenchd strain_F = strain_W_[l].In(ws.loops[l].R_WF);
    const Vector6d b = ProjectOnRows(tree_.loops[l], ws.loops[l], strain_F.force, strain_F.moment);
    for (int i = 0; i < tree_.loops[l].rows; ++i) unknowns_[row_position_[l] + i] = -b[i];
  }
  for (size_t u = 0; u < dependent_position_.size(); ++u) {
    unknowns_[dependent_position_[u]] = r[partition_.dependent[u]];
  }
  matrix_.Solve(unknowns_.data());
  for (size_t l = 0; l < tree_.loops.size(); ++l) {
    for (int i = 0; i < tree_.loops[l].rows; ++i) {
      mu[tree_.loops[l].row + i] = unknowns_[row_position_[l] + i];
    }
  }
}

}  // namespace vmech
