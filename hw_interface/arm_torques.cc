#include "vmech/hw_interface/arm_torques.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "vmech/solvers/stopping_rule.h"

namespace vmech {

void PostureOptions::Validate() const {
  CheckRange("PostureOptions", "stiffness", stiffness, 0, 100);
  CheckRange("PostureOptions", "damping", damping, 0, 10);
}

ArmTorques::ArmTorques(const PostureOptions& options, std::shared_ptr<const ArmDescription> arm,
                       double period, double resolution)
    : options_(options),
      arm_(std::move(arm)),
      velocity_(arm_.joints(), KalmanEstimator(period, std::max(resolution, 1e-9))),
      posture_torque_(VectorXd::Zero(arm_.joints())),
      torque_(posture_torque_),
      reduced_(arm_.J()),
      free_(MatrixXd::Zero(arm_.joints(), arm_.joints())),
      momenta_(free_) {
  options.Validate();
}

void ArmTorques::Reset() noexcept {
  for (KalmanEstimator& filter : velocity_) filter.Reset();
  posture_torque_.setZero();
}

void ArmTorques::Resolve(const MasterState& state, bool fresh,
                         MasterCommand* command) noexcept VMECH_NONBLOCKING {
  arm_.SetPosture(state.q.data());
  const VectorXd& q_0 = arm_.description().posture;
  for (int i = 0; fresh && i < arm_.joints(); ++i) {
    const double v = velocity_[i].Update(state.q[i]).v;
    posture_torque_[i] = options_.stiffness * (q_0[i] - state.q[i]) - options_.damping * v;
  }
  torque_.noalias() = arm_.J().transpose() * command->F_Ho_D;
  const int count = FindFreeMotions();
  for (int k = 0; k < count; ++k) {
    auto n_k = free_.col(k);
    auto p_k = momenta_.col(k);
    for (int i = 0; i < k; ++i) {
      n_k -= free_.col(i) * (momenta_.col(i).dot(n_k) / momenta_.col(i).dot(free_.col(i)));
    }
    arm_.Momenta(n_k.data(), p_k.data());
    torque_ += p_k * (n_k.dot(posture_torque_) / n_k.dot(p_k));
  }
  for (int i = 0; i < arm_.joints(); ++i) command->torque[i] = torque_[i];
}

/// Motions that leave the handle where it is, by Gauss-Jordan elimination with full pivoting;
/// writes them to free_ and returns how many there are.
int ArmTorques::FindFreeMotions() noexcept {
  constexpr double kSingular = 1e-9;  // pivot over the largest: the handle cannot go that way
  const int n = arm_.joints();
  reduced_ = arm_.J();
  std::array<int, kMaxArmJoints> order;  // pivots' columns first
  std::iota(order.begin(), order.begin() + n, 0);
  int rank = 0;
  for (double largest = 0; rank < std::min(6, n); ++rank) {
    int row = rank, column = rank;
    double pivot = 0;
    for (int j = rank; j < n; ++j) {
      for (int i = rank; i < 6; ++i) {
        const double size = std::abs(reduced_(i, order[j]));
        if (size > pivot) pivot = size, row = i, column = j;
      }
    }
    largest = std::max(largest, pivot);
    if (!(pivot > kSingular * largest)) break;
    std::swap(order[rank], order[column]);
    reduced_.row(rank).swap(reduced_.row(row));
    const double inverse = 1 / reduced_(rank, order[rank]);
    for (int j = rank; j < n; ++j) {
      double* const a = &reduced_(0, order[j]);
      a[rank] *= inverse;
      if (j == rank) continue;
      for (int i = 0; i < 6; ++i) {
        if (i != rank) a[i] -= reduced_(i, order[rank]) * a[rank];
      }
    }
  }
  for (int k = 0; k < n - rank; ++k) {
    free_.col(k).setZero();
    free_(order[rank + k], k) = 1;
    for (int i = 0; i < rank; ++i) free_(order[i], k) = -reduced_(i, order[rank + k]);
  }
  return n - rank;
}

}  // namespace vmech
