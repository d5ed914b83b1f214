#include "vmech/dynamics/reactions/reactions.h"

#include <algorithm>

#include "vmech/base/dual.h"
#include "vmech/base/lanes4.h"
#include "vmech/base/screw_algebra.h"
#include "vmech/base/tape/taped4.h"
#include "vmech/kinematics/loops/loops.h"
#include "vmech/mechanisms/freedoms.h"

namespace vmech {
namespace {

/// Does a joint hold force (0..2) or moment (3..5) k, axes of F? A screw holds its travel: that
/// goes with the turn.
bool Holds(JointType type, int k) {
  return !FreedomsOfType(type).free[k] || (type == JointType::kScrew && k == 2);
}

}  // namespace

std::vector<JointCompliance> CompliancesForRule(const KinematicTree& tree, ReactionRule rule,
                                                double length) {
  std::vector<JointCompliance> compliances;
  for (const Joint& joint : tree.mechanism.joints) {
    Vector6d stiffness = Stacked<double>(Vector3d::Constant(kDefaultStiffness),
                                         Vector3d::Constant(kDefaultStiffness * length * length));
    if (rule == ReactionRule::kStiffness && joint.stiffness) stiffness = *joint.stiffness;
    JointCompliance compliance;
    for (int k = 0; k < 3; ++k) {
      if (Holds(joint.type, k)) compliance.force[k] = 1 / stiffness[k];
      if (Holds(joint.type, 3 + k)) compliance.moment[k] = 1 / stiffness[3 + k];
    }
    compliances.push_back(compliance);
  }
  return compliances;
}

template <typename T>
ReactionSolver<T>::ReactionSolver(const KinematicTree& tree, const CoordinatePartition& partition,
                                  const std::vector<JointCompliance>& compliances)
    : tree_(tree), partition_(partition), loads_(LoopLoadsOfJoints(tree)) {
  for (const JointCompliance& c : compliances) {
    root_compliances_.push_back(Stacked<double>(c.force, c.moment).cwiseSqrt());
  }
  size_t columns = 0;
  for (const std::vector<LoopLoad>& loads : loads_) {
    for (const LoopLoad& load : loads) columns += static_cast<size_t>(tree_.loops[load.loop].rows);
  }
  columns_.assign(columns, Vector6<T>::Zero());
  OrderUnknowns();
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
  for (const std::vector<LoopLoad>& loads : loads_) {
    for (const LoopLoad& k : loads) {
      for (const LoopLoad& l : loads) coupled_from[k.loop] = std::min(coupled_from[k.loop], l.loop);
    }
  }

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
Vector6<T> ReactionSolver<T>::Strain(size_t joint, const JointState<T>& state,
                                     const ScrewT<T>& W) const {
  const Vector6d& root = root_compliances_[joint];
  const Triple<T> moment = W.angular - Cross(state.F.p, W.linear);
  const Triple<T> f = InverseRotate(state.F, W.linear);
  if (tree_.mechanism.joints[joint].type == JointType::kUniversal) {
    const T held = root[5] * Dot(state.across, moment);
    return {root[0] * f[0], root[1] * f[1], root[2] * f[2], T(0), T(0), held};
  }
  const Triple<T> m = InverseRotate(state.F, moment);
  return {root[0] * f[0], root[1] * f[1], root[2] * f[2],
          root[3] * m[0], root[4] * m[1], root[5] * m[2]};
}

template <typename T>
void ReactionSolver<T>::Factor(const TreeWorkspace<T>& ws,
                               const std::vector<JointState<T>>& joints) {
  matrix_.SetZero();
  Vector6<T>* column = columns_.data();
  for (size_t j = 0; j < joints.size(); ++j) {
    const Vector6<T>* first = column;
    for (const LoopLoad& load : loads_[j]) {
      const LoopState<T>& loop = ws.loops[load.loop];
      for (int k = 0; k < tree_.loops[load.loop].rows; ++k) {
        *column++ = load.sign * Strain(j, joints[j], loop.wrench[k]);
      }
    }
    AddToMatrix(first, loads_[j]);
  }
  AddJacobianToMatrix(ws);
  matrix_.Factor();
}

/// A += (D^1/2 T_j)' D^1/2 T_j, its lower half.
template <typename T>
void ReactionSolver<T>::AddToMatrix(const Vector6<T>* columns, const std::vector<LoopLoad>& loads) {
  const Vector6<T>* of_k = columns;
  for (const LoopLoad& k : loads) {
    const int rows_k = tree_.loops[k.loop].rows;
    const Vector6<T>* of_l = columns;
    for (const LoopLoad& l : loads) {
      const int rows_l = tree_.loops[l.loop].rows;
      for (int i = 0; k.loop >= l.loop && i < rows_k; ++i) {
        const int count = k.loop == l.loop ? i + 1 : rows_l;
        for (int j = 0; j < count; ++j) {
          matrix_(row_position_[k.loop] + i, row_position_[l.loop] + j) += of_k[i].dot(of_l[j]);
        }
      }
      of_l += rows_l;
    }
    of_k += rows_k;
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
void ReactionSolver<T>::Solve(const std::vector<JointState<T>>& joints, const T* r, T* mu) {
  std::fill(unknowns_.begin(), unknowns_.end(), T(0));
  const Vector6<T>* column = columns_.data();
  for (size_t j = 0; j < joints.size(); ++j) {
    if (loads_[j].empty()) continue;
    const Vector6<T> strain = Strain(j, joints[j], joints[j].W);
    for (const LoopLoad& load : loads_[j]) {
      T* b = &unknowns_[row_position_[load.loop]];
      for (int i = 0; i < tree_.loops[load.loop].rows; ++i) *b++ -= (column++)->dot(strain);
    }
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

template class ReactionSolver<double>;
template class ReactionSolver<Dual>;
template class ReactionSolver<Taped4>;
template class ReactionSolver<Lanes4>;

}  // namespace vmech
