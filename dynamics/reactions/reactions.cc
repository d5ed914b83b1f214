#include "vmech/dynamics/reactions/reactions.h"

#include <algorithm>

#include "vmech/base/packet.h"
#include "vmech/kinematics/loops/loops.h"
#include "vmech/kinematics/tree/forward_kinematics.h"

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

/// A compliance D = isotropic 1 + sum over directions of extra a a' is never written out as a
/// matrix: a wrench (f, m) at a cut loads the joint with (f, m + d x f), d from the joint to the
/// cut, and with c = d x a every term of T' D T is a product of two vectors.
template <typename T>
struct Softness {
  Vector3<T> axis;
  double force, moment;
};

/// A += S(a).
template <typename T>
void AddCross(const Vector3<T>& a, Matrix3<T>* A) {
  (*A)(0, 1) -= a.z();
  (*A)(0, 2) += a.y();
  (*A)(1, 0) += a.z();
  (*A)(1, 2) -= a.x();
  (*A)(2, 0) -= a.y();
  (*A)(2, 1) += a.x();
}

/// What a joint is soft about beyond its isotropic part: the y and z axes of F, or the axis that a
/// universal joint holds its moment about.
template <typename T, typename Visit>
void ForEachDirection(const Joint& joint, const JointCompliance& compliance,
                      const JointState<T>& state, const Visit& visit) {
  if (joint.type == JointType::kUniversal) {
    visit(Softness<T>{state.n_W, 0, compliance.moment.z()});
  }
  for (int k = 1; k < 3; ++k) {
    const double force = compliance.force[k] - compliance.force.x();
    const double moment =
        joint.type == JointType::kUniversal ? 0 : compliance.moment[k] - compliance.moment.x();
    if (force != 0 || moment != 0) visit(Softness<T>{state.R_WF.col(k), force, moment});
  }
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

template <typename T>
void JointFrames(const KinematicTree& tree, const TreeWorkspace<T>& ws,
                 std::vector<JointState<T>>* joints) {
  using std::sqrt;
  for (size_t j = 0; j < joints->size(); ++j) {
    const JointPlacement& place = tree.placements[j];
    const int a = place.first_node, b = place.second_node;
    const Matrix3<T> R_AF = place.X_AF.R.cast<T>();
    const Vector3<T> p_BM = place.X_BM.p.cast<T>();
    (*joints)[j].R_WF = a < 0 ? R_AF : Matrix3<T>(ws.nodes[a].X_WB.R * R_AF);
    (*joints)[j].p_WM = b < 0 ? p_BM : ws.nodes[b].X_WB * p_BM;
    if (tree.mechanism.joints[j].type != JointType::kUniversal) continue;
    const Vector3<T> y_M_W = PoseInWorld(ws, b, place.X_BM).R.col(1);
    const Vector3<T> across = y_M_W.cross((*joints)[j].R_WF.col(0));
    (*joints)[j].n_W = across / sqrt(across.squaredNorm());
  }
}

template <typename T>
void TreeJointWrenches(const KinematicTree& tree, const TreeWorkspace<T>& ws,
                       std::vector<JointState<T>>* joints) {
  for (size_t j = 0; j < joints->size(); ++j) {
    const int index = tree.placements[j].tree_node;
    if (index < 0) continue;
    JointState<T>& joint = (*joints)[j];
    const NodeState<T>& node = ws.nodes[index];
    const Wrench<T> W = node.F_Bo.ShiftedBy(node.X_WB.p - joint.p_WM);
    joint.W_M = tree.nodes[index].reversed ? -W : W;
  }
}

template <typename T>
void AddMultiplierWrenches(const KinematicTree& tree, const T* mu, TreeWorkspace<T>* ws) {
  for (size_t l = 0; l < tree.loops.size(); ++l) {
    const Loop& loop = tree.loops[l];
    const LoopState<T>& s = ws->loops[l];
    const Wrench<T> W_F = WrenchOfMultipliers(loop, s, mu + loop.row);
    const Wrench<T> W{s.R_WF * W_F.force, s.R_WF * W_F.moment};
    for (const LoopNode& n : loop.path) {
      NodeState<T>& node = ws->nodes[n.node];
      const Wrench<T> share = W.ShiftedBy(s.p_WM - node.X_WB.p);
      node.F_Bo.force -= n.sign * share.force;
      node.F_Bo.moment -= n.sign * share.moment;
    }
  }
}

template <typename T>
ReactionSolver<T>::ReactionSolver(const KinematicTree& tree, const CoordinatePartition& partition,
                                  std::vector<JointCompliance> compliances)
    : tree_(tree),
      partition_(partition),
      compliances_(std::move(compliances)),
      loads_(LoopLoadsOfJoints(tree)),
      strain_W_(tree.loops.size()) {
  FindLoads();
  OrderUnknowns();
}

template <typename T>
void ReactionSolver<T>::FindLoads() {
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

template <typename T>
int ReactionSolver<T>::BlockIndex(int k, int l) {
  for (size_t i = 0; i < blocks_.size(); ++i) {
    if (blocks_[i].k == k && blocks_[i].l == l) return static_cast<int>(i);
  }
  const Matrix3<T> zero = Matrix3<T>::Zero();
  blocks_.push_back({k, l, zero, zero, zero, zero});
  return static_cast<int>(blocks_.size()) - 1;
}

template <typename T>
void ReactionSolver<T>::OrderUnknowns() {
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
  unknowns_.assign(first.size(), T(0));
  matrix_ = EnvelopeLdlt<T>(first);
}

template <typename T>
void ReactionSolver<T>::Factor(const TreeWorkspace<T>& ws,
                               const std::vector<JointState<T>>& joints) {
  for (Block& block : blocks_) {
    for (Matrix3<T>* A : {&block.A_ff, &block.A_fm, &block.A_mf, &block.A_mm}) A->setZero();
  }
  for (const Contribution& c : contributions_) AddContribution(ws, joints, c);
  matrix_.SetZero();
  for (const Block& block : blocks_) AddBlockToMatrix(ws, block);
  AddJacobianToMatrix(ws);
  matrix_.Factor();
}

template <typename T>
void ReactionSolver<T>::AddContribution(const TreeWorkspace<T>& ws,
                                        const std::vector<JointState<T>>& joints,
                                        const Contribution& contribution) {
  const JointState<T>& joint = joints[contribution.joint];
  const JointCompliance& compliance = compliances_[contribution.joint];
  const LoopLoad& k = loads_[contribution.joint][contribution.load_k];
  const LoopLoad& l = loads_[contribution.joint][contribution.load_l];
  const double sign = k.sign * l.sign;
  const bool symmetric = k.loop == l.loop;
  const Vector3<T> d_k = ws.loops[k.loop].p_WM - joint.p_WM;
  const Vector3<T> d_l = symmetric ? d_k : Vector3<T>(ws.loops[l.loop].p_WM - joint.p_WM);
  Block& block = blocks_[contribution.block];

  // The isotropic part, S(d_k) S(d_l)' = d_k.d_l 1 - d_l d_k'.
  const double force = sign * compliance.force.x();
  const double moment = sign * IsotropicMoment(contribution.joint);
  const T squares = force + moment * d_k.dot(d_l);
  for (int i = 0; i < 3; ++i) {
    block.A_ff(i, i) += squares;
    block.A_mm(i, i) += moment;
  }
  if (moment != 0) {
    const Vector3<T> m_k = moment * d_k, m_l = moment * d_l;
    block.A_ff -= m_l * d_k.transpose();
    AddCross<T>(-m_k, &block.A_fm);
    if (!symmetric) AddCross<T>(m_l, &block.A_mf);
  }
  ForEachDirection(tree_.mechanism.joints[contribution.joint], compliance, joint,
                   [&](const Softness<T>& soft) {
                     const Vector3<T>& a = soft.axis;
                     const Vector3<T> c_k = d_k.cross(a);
                     const Vector3<T> c_l = symmetric ? c_k : d_l.cross(a);
                     const Vector3<T> force_a = (sign * soft.force) * a;
                     const Vector3<T> moment_a = (sign * soft.moment) * a;
                     const Vector3<T> moment_c = (sign * soft.moment) * c_k;
                     block.A_ff += force_a * a.transpose() + moment_c * c_l.transpose();
                     block.A_fm -= moment_c * a.transpose();
                     block.A_mm += moment_a * a.transpose();
                     if (!symmetric) block.A_mf -= moment_a * c_l.transpose();
                   });
}

template <typename T>
double ReactionSolver<T>::IsotropicMoment(int joint) const {
  const bool universal = tree_.mechanism.joints[joint].type == JointType::kUniversal;
  return universal ? 0 : compliances_[joint].moment.x();
}

template <typename T>
void ReactionSolver<T>::AddBlockToMatrix(const TreeWorkspace<T>& ws, const Block& block) {
  const Loop& loop_k = tree_.loops[block.k];
  const Loop& loop_l = tree_.loops[block.l];
  const Matrix3<T>& R_k = ws.loops[block.k].R_WF;
  const Matrix3<T>& R_l = ws.loops[block.l].R_WF;
  // T_k' (R_k' A_W R_l) T_l, column by column and then row by row.
  const Matrix3<T> ff = R_k.transpose() * block.A_ff * R_l;
  const Matrix3<T> fm = R_k.transpose() * block.A_fm * R_l;
  const Matrix3<T> mf = block.k == block.l ? Matrix3<T>(fm.transpose())
                                           : Matrix3<T>(R_k.transpose() * block.A_mf * R_l);
  const Matrix3<T> mm = R_k.transpose() * block.A_mm * R_l;
  Vector6<T> columns[6];
  for (int j = 0; j < 3; ++j) {
    columns[j] = ProjectOnRows<T>(loop_k, ws.loops[block.k], ff.col(j), mf.col(j));
    columns[3 + j] = ProjectOnRows<T>(loop_k, ws.loops[block.k], fm.col(j), mm.col(j));
  }
  for (int i = 0; i < loop_k.rows; ++i) {
    const Vector6<T> row =
        ProjectOnRows<T>(loop_l, ws.loops[block.l], {columns[0][i], columns[1][i], columns[2][i]},
                         {columns[3][i], columns[4][i], columns[5][i]});
    const int count = block.k == block.l ? i + 1 : loop_l.rows;
    for (int j = 0; j < count; ++j) {
      matrix_(row_position_[block.k] + i, row_position_[block.l] + j) += row[j];
    }
  }
}

template <typename T>
void ReactionSolver<T>::AddJacobianToMatrix(const TreeWorkspace<T>& ws) {
  for (size_t l = 0; l < tree_.loops.size(); ++l) {
    const Vector6<T>* C = &ws.loop_columns[ws.first_column[l]];
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

template <typename T>
void ReactionSolver<T>::Solve(const TreeWorkspace<T>& ws, const std::vector<JointState<T>>& joints,
                              const T* r, T* mu) {
  for (Wrench<T>& strain : strain_W_) strain = Wrench<T>{};
  for (size_t j = 0; j < joints.size(); ++j) {
    if (loads_[j].empty()) continue;
    const Wrench<T>& W = joints[j].W_M;
    Vector3<T> give = compliances_[j].force.x() * W.force;
    Vector3<T> turn = IsotropicMoment(static_cast<int>(j)) * W.moment;
    ForEachDirection(tree_.mechanism.joints[j], compliances_[j], joints[j],
                     [&](const Softness<T>& soft) {
                       give += (soft.force * soft.axis.dot(W.force)) * soft.axis;
                       turn += (soft.moment * soft.axis.dot(W.moment)) * soft.axis;
                     });
    for (const LoopLoad& load : loads_[j]) {
      const Vector3<T> d = ws.loops[load.loop].p_WM - joints[j].p_WM;
      strain_W_[load.loop].force += load.sign * (give - d.cross(turn));
      strain_W_[load.loop].moment += load.sign * turn;
    }
  }
  for (size_t l = 0; l < tree_.loops.size(); ++l) {
    const Wrench<T> strain_F = strain_W_[l].In(ws.loops[l].R_WF);
    const Vector6<T> b =
        ProjectOnRows(tree_.loops[l], ws.loops[l], strain_F.force, strain_F.moment);
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

// NOLINTBEGIN(bugprone-macro-parentheses): T is a type
#define VMECH_INSTANTIATE(T)                                                                 \
  template void JointFrames<T>(const KinematicTree&, const TreeWorkspace<T>&,                \
                               std::vector<JointState<T>>*);                                 \
  template void TreeJointWrenches<T>(const KinematicTree&, const TreeWorkspace<T>&,          \
                                     std::vector<JointState<T>>*);                           \
  template void AddMultiplierWrenches<T>(const KinematicTree&, const T*, TreeWorkspace<T>*); \
  template class ReactionSolver<T>;
VMECH_INSTANTIATE(double)
VMECH_INSTANTIATE(Packet)
#undef VMECH_INSTANTIATE
// NOLINTEND(bugprone-macro-parentheses)

}  // namespace vmech
