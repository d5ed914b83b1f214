#include "vmech/kinematics/closure.h"

#include <algorithm>
#include <cmath>

#include "vmech/kinematics/forward_kinematics.h"
#include "vmech/kinematics/loops.h"

namespace vmech {
namespace {

constexpr double kWellConditioned = 1e-2;  // pivot ratio: at most two digits are lost

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

DependentSolver::DependentSolver(const KinematicTree& tree, CoordinatePartition partition)
    : tree_(tree),
      partition_(std::move(partition)),
      residual_(tree.loops.size(), Vector6d::Zero()),
      solution_(partition_.dependent.size(), 0.0),
      step_(tree.nv),
      normal_(NormalEnvelope(tree, partition_)) {
  const VectorXd scale = LoopRowScale(tree);
  for (const Loop& loop : tree.loops) {
    Vector6d weight = Vector6d::Zero();
    weight.head(loop.rows) = scale.segment(loop.row, loop.rows).cwiseAbs2();
    weight_.push_back(weight);
  }
}

void DependentSolver::Factor(const TreeWorkspace<double>& ws) {
  normal_.SetZero();
  for (size_t l = 0; l < tree_.loops.size(); ++l) {
    const std::vector<LoopColumn>& columns = tree_.loops[l].columns;
    const Vector6d* C = &ws.loop_columns[ws.first_column[l]];
    for (size_t i = 0; i < columns.size(); ++i) {
      const int slot_i = partition_.dependent_slot[columns[i].v];
      if (slot_i < 0) continue;
      const Vector6d weighted = weight_[l].cwiseProduct(C[i]);
      for (size_t j = 0; j <= i; ++j) {
        const int slot_j = partition_.dependent_slot[columns[j].v];
        if (slot_j >= 0) normal_.Add(slot_i, slot_j, weighted.dot(C[j]));
      }
    }
  }
  normal_.Factor();
}

void DependentSolver::StartResidual(const TreeWorkspace<double>& ws, Target target) {
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

void DependentSolver::SubtractColumns(const TreeWorkspace<double>& ws, const double* x) {
  for (size_t l = 0; l < tree_.loops.size(); ++l) {
    const Vector6d* C = &ws.loop_columns[ws.first_column[l]];
    for (const LoopColumn& c : tree_.loops[l].columns) residual_[l] -= *C++ * x[c.v];
  }
}

void DependentSolver::SolveInto(const TreeWorkspace<double>& ws, double* x) {
  std::fill(solution_.begin(), solution_.end(), 0.0);
  for (size_t l = 0; l < tree_.loops.size(); ++l) {
    const Vector6d weighted = weight_[l].cwiseProduct(residual_[l]);
    const Vector6d* C = &ws.loop_columns[ws.first_column[l]];
    for (const LoopColumn& c : tree_.loops[l].columns) {
      const int slot = partition_.dependent_slot[c.v];
      if (slot >= 0) solution_[slot] += C->dot(weighted);
      ++C;
    }
  }
  normal_.Solve(solution_.data());
  for (size_t i = 0; i < solution_.size(); ++i) x[partition_.dependent[i]] += solution_[i];
}

void DependentSolver::StepCoordinates(const TreeWorkspace<double>& ws, VectorXd* q) {
  StartResidual(ws, Target::kErrors);
  step_.setZero();
  SolveInto(ws, step_.data());
  Integrate(tree_, step_, q);
}

void DependentSolver::Complete(const TreeWorkspace<double>& ws, Target target, double* x) {
  for (int v : partition_.dependent) x[v] = 0;
  // A second pass refines what the squared condition of the normal equations costs near a dead
  // centre.
  const int passes = normal_.smallest_pivot() > kWellConditioned ? 1 : 2;
  for (int pass = 0; pass < passes; ++pass) {
    StartResidual(ws, target);
    SubtractColumns(ws, x);
    SolveInto(ws, x);
  }
}

void DependentSolver::CompleteVelocities(const TreeWorkspace<double>& ws, double* v) {
  Complete(ws, Target::kZero, v);
}

void DependentSolver::CompleteAccelerations(const TreeWorkspace<double>& ws, double* vdot) {
  Complete(ws, Target::kMinusBias, vdot);
}

double LargestLoopError(const KinematicTree& tree, const TreeWorkspace<double>& ws) {
  double largest = 0;
  for (size_t l = 0; l < tree.loops.size(); ++l) {
    const Loop& loop = tree.loops[l];
    const double per_length = 1 / tree.length;
    for (int i = 0; i < loop.rows; ++i) {
      const double scale = IsLengthRow(loop.type, i) ? per_length : 1.0;
      largest = std::max(largest, std::abs(ws.loops[l].e2[i]) * scale);
    }
    if (FacesBackwards(loop, ws.loops[l])) largest = std::max(largest, 2.0);
  }
  return largest;
}

void EvaluatePose(const KinematicTree& tree, const VectorXd& q, TreeWorkspace<double>* ws,
                  bool with_jacobian) {
  ForwardKinematics(tree, q.data(), ws);
  LoopErrors(tree, ws);
  if (with_jacobian) LoopJacobian(tree, ws);
}

double CloseByNewton(const KinematicTree& tree, double tolerance, int max_steps,
                     DependentSolver* solver, TreeWorkspace<double>* ws, VectorXd* q) {
  EvaluatePose(tree, *q, ws);
  double error = LargestLoopError(tree, *ws);
  for (int step = 0; step < max_steps && !(error <= tolerance); ++step) {
    solver->Factor(*ws);
    solver->StepCoordinates(*ws, q);
    EvaluatePose(tree, *q, ws, false);
    error = LargestLoopError(tree, *ws);
    if (!(error <= tolerance)) LoopJacobian(tree, ws);
  }
  return error;
}

}  // namespace vmech
