#include "vmech/kinematics/loops/closure.h"

#include <algorithm>
#include <cmath>

#include "vmech/base/dual.h"
#include "vmech/base/lanes4.h"
#include "vmech/base/tape/taped4.h"
#include "vmech/kinematics/loops/loops.h"
#include "vmech/kinematics/tree/forward_kinematics.h"

namespace vmech {
namespace {

constexpr double kWellConditioned = 1e-2;  // pivot ratio: at most two digits are lost
constexpr double kFastShare = 1e-3;        // of the error before: chord steps gain no less

template <typename T>
Vector6<T> Weighted(const Vector6d& weight, const Vector6<T>& x) {
  Vector6<T> product;
  for (int i = 0; i < 6; ++i) product[i] = weight[i] * x[i];
  return product;
}

/// First dependent slot that shares a loop with each slot: the envelope of C_u' C_u.
std::vector<int> NormalEnvelope(const KinematicTree& tree, const CoordinatePartition& partition) {
  std::vector<int> first(partition.dependent.size());
  for (size_t i = 0; i < first.size(); ++i) first[i] = static_cast<int>(i);
  for (const Loop& loop : tree.loops) {
    int lowest = static_cast<int>(first.size());
    for (const LoopColumn& c : loop.columns) {
      const int slot = partition.dependent_slot[c.v];
      if (slot >= 0) lowest = std::min(lowest, slot);
    }
    for (const LoopColumn& c : loop.columns) {
      const int slot = partition.dependent_slot[c.v];
      if (slot >= 0) first[slot] = std::min(first[slot], lowest);
    }
  }
  return first;
}

}  // namespace

template <typename T>
DependentSolver<T>::DependentSolver(const KinematicTree& tree, CoordinatePartition partition)
    : tree_(tree),
      partition_(std::move(partition)),
      residual_(tree.loops.size(), Vector6<T>::Zero()),
      solution_(partition_.dependent.size(), T(0)),
      step_(tree.nv, T(0)),
      normal_(NormalEnvelope(tree, partition_)) {
  const VectorXd scale = LoopRowScale(tree);
  for (const Loop& loop : tree.loops) {
    Vector6d weight = Vector6d::Zero();
    weight.head(loop.rows) = scale.segment(loop.row, loop.rows).cwiseAbs2();
    weight_.push_back(weight);
  }
}

template <typename T>
void DependentSolver<T>::Factor(const TreeWorkspace<T>& ws) {
  normal_.SetZero();
  for (size_t l = 0; l < tree_.loops.size(); ++l) {
    const std::vector<LoopColumn>& columns = tree_.loops[l].columns;
    const Vector6<T>* C = &ws.loop_columns[ws.first_column[l]];
    for (size_t i = 0; i < columns.size(); ++i) {
      const int slot_i = partition_.dependent_slot[columns[i].v];
      if (slot_i < 0) continue;
      const Vector6<T> weighted = Weighted(weight_[l], C[i]);
      for (size_t j = 0; j <= i; ++j) {
        const int slot_j = partition_.dependent_slot[columns[j].v];
        if (slot_j >= 0) normal_.Add(slot_i, slot_j, weighted.dot(C[j]));
      }
    }
  }
  normal_.Factor();
}

template <typename T>
T DependentSolver<T>::PivotBeside(const VectorXd& sizes) const {
  using std::max;
  T largest(0);
  for (size_t i = 0; i < partition_.dependent.size(); ++i) {
    largest =
        max(largest, normal_.inverse_pivot(static_cast<int>(i)) * sizes[partition_.dependent[i]]);
  }
  return Select(smallest_pivot() > T(0), 1.0 / max(largest, T(1)), T(0));
}

template <typename T>
void DependentSolver<T>::StartResidual(const TreeWorkspace<T>& ws, Target target) {
  for (size_t l = 0; l < residual_.size(); ++l) {
    switch (target) {
      case Target::kErrors:
        residual_[l] = ws.loops[l].e2;
        break;
      case Target::kZero:
        residual_[l].setZero();
        break;
      case Target::kMinusBias:
        residual_[l] = -ws.loops[l].bias;
        break;
    }
  }
}

template <typename T>
void DependentSolver<T>::SubtractColumns(const TreeWorkspace<T>& ws, const T* x) {
  for (size_t l = 0; l < tree_.loops.size(); ++l) {
    const Vector6<T>* C = &ws.loop_columns[ws.first_column[l]];
    for (const LoopColumn& c : tree_.loops[l].columns) residual_[l] -= *C++ * x[c.v];
  }
}

template <typename T>
void DependentSolver<T>::SolveInto(const TreeWorkspace<T>& ws, T* x) {
  std::fill(solution_.begin(), solution_.end(), T(0));
  for (size_t l = 0; l < tree_.loops.size(); ++l) {
    const Vector6<T> weighted = Weighted(weight_[l], residual_[l]);
    const Vector6<T>* C = &ws.loop_columns[ws.first_column[l]];
    for (const LoopColumn& c : tree_.loops[l].columns) {
      const int slot = partition_.dependent_slot[c.v];
      if (slot >= 0) solution_[slot] += C->dot(weighted);
      ++C;
    }
  }
  normal_.Solve(solution_.data());
  for (size_t i = 0; i < solution_.size(); ++i) x[partition_.dependent[i]] += solution_[i];
}

template <typename T>
void DependentSolver<T>::StepCoordinates(const TreeWorkspace<T>& ws, T* q) {
  StartResidual(ws, Target::kErrors);
  std::fill(step_.begin(), step_.end(), T(0));
  SolveInto(ws, step_.data());
  MoveCoordinates(tree_, step_.data(), q);
}

template <typename T>
void DependentSolver<T>::Complete(const TreeWorkspace<T>& ws, Target target, T* x) {
  for (int v : partition_.dependent) x[v] = T(0);
  // A second pass refines what the squared condition of the normal equations costs near a dead
  // centre.
  const int passes = AllLanes(normal_.smallest_pivot() > T(kWellConditioned)) ? 1 : 2;
  for (int pass = 0; pass < passes; ++pass) {
    StartResidual(ws, target);
    SubtractColumns(ws, x);
    SolveInto(ws, x);
  }
}

template <typename T>
void DependentSolver<T>::CompleteVelocities(const TreeWorkspace<T>& ws, T* v) {
  Complete(ws, Target::kZero, v);
}

template <typename T>
void DependentSolver<T>::CompleteAccelerations(const TreeWorkspace<T>& ws, T* vdot) {
  Complete(ws, Target::kMinusBias, vdot);
}

template <typename T>
void FreeMotions(const TreeWorkspace<T>& ws, DependentSolver<T>* dependents, MatrixX<T>* N) {
  const CoordinatePartition& partition = dependents->partition();
  N->setZero();
  Eigen::Index column = 0;
  for (const std::vector<int>* group : {&partition.driven, &partition.idle}) {
    for (int v : *group) {
      (*N)(v, column) = T(1);
      dependents->CompleteVelocities(ws, N->col(column).data());
      ++column;
    }
  }
}

template <typename T>
void EvaluatePose(const KinematicTree& tree, const T* q, TreeWorkspace<T>* ws, bool with_jacobian) {
  ForwardKinematics(tree, q, ws);
  LoopErrors(tree, ws);
  if (with_jacobian) LoopJacobian(tree, ws);
}

void EvaluatePose(const KinematicTree& tree, const VectorXd& q, TreeWorkspace<double>* ws,
                  bool with_jacobian) {
  EvaluatePose(tree, q.data(), ws, with_jacobian);
}

template <typename T>
T CloseByNewton(const KinematicTree& tree, double tolerance, int max_steps,
                DependentSolver<T>* solver, TreeWorkspace<T>* ws, T* q) {
  EvaluatePose(tree, q, ws, false);
  T error = LargestLoopError(tree, *ws), before = error;
  for (int step = 0; step < max_steps && !AllLanes(error <= T(tolerance)); ++step) {
    if (step == 0 || !AllLanes(error <= kFastShare * before)) {
      LoopJacobian(tree, ws);
      solver->Factor(*ws);
    }
    before = error;
    solver->StepCoordinates(*ws, q);
    EvaluatePose(tree, q, ws, false);
    error = LargestLoopError(tree, *ws);
  }
  return error;
}

// NOLINTBEGIN(bugprone-macro-parentheses): T is a type
#define VMECH_INSTANTIATE(T)                                                               \
  template class DependentSolver<T>;                                                       \
  template void FreeMotions<T>(const TreeWorkspace<T>&, DependentSolver<T>*, MatrixX<T>*); \
  template void EvaluatePose<T>(const KinematicTree&, const T*, TreeWorkspace<T>*, bool);  \
  template T CloseByNewton<T>(const KinematicTree&, double, int, DependentSolver<T>*,      \
                              TreeWorkspace<T>*, T*);
VMECH_INSTANTIATE(double)
VMECH_INSTANTIATE(Dual)
VMECH_INSTANTIATE(Taped4)
VMECH_INSTANTIATE(Lanes4)
#undef VMECH_INSTANTIATE
// NOLINTEND(bugprone-macro-parentheses)

}  // namespace vmech
