#include "vmech/hw_interface/arm_torques.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "vmech/solvers/stopping_rule.h"

namespace vmech {
namespace {

/// Row and column of the largest entry from row and column `first` on; columns have six rows.
std::pair<int, int> LargestBeyond(int first, int columns, const double* const* column) noexcept {
  std::pair<int, int> at{first, first};
  double largest = 0;
  for (int j = first; j < columns; ++j) {
    for (int i = first; i < 6; ++i) {
      const double size = std::abs(column[j][i]);
      if (size > largest) largest = size, at = {i, j};
    }
  }
  return at;
}

/// Column k becomes that of the unit matrix, with the pivot from `row`.
void Eliminate(int k, int row, int columns, double* const* column) noexcept {
  std::array<double, 6> factor;
  std::swap(column[k][k], column[k][row]);
  const double inverse = 1 / column[k][k];
  for (int i = 0; i < 6; ++i) factor[i] = i == k ? 0 : column[k][i];
  for (int j = k + 1; j < columns; ++j) {
    std::swap(column[j][k], column[j][row]);
    column[j][k] *= inverse;
    for (int i = 0; i < 6; ++i) column[j][i] -= factor[i] * column[j][k];
  }
}

}  // namespace

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
  std::array<double*, kMaxArmJoints> column;  // those of pivots first
  reduced_ = arm_.J();
  for (int j = 0; j < n; ++j) column[j] = reduced_.col(j).data();
  int rank = 0;
  for (double largest = 0; rank < std::min(6, n); ++rank) {
    const auto [row, at] = LargestBeyond(rank, n, column.data());
    const double pivot = std::abs(column[at][row]);
    largest = std::max(largest, pivot);
    if (!(pivot > kSingular * largest)) break;
    std::swap(column[rank], column[at]);
    Eliminate(rank, row, n, column.data());
  }
  const auto joint = [&](const double* c) { return (c - reduced_.data()) / 6; };
  for (int k = 0; k < n - rank; ++k) {
    free_.col(k).setZero();
    free_(joint(column[rank + k]), k) = 1;
    for (int i = 0; i < rank; ++i) free_(joint(column[i]), k) = -column[rank + k][i];
  }
  return n - rank;
}

}  // namespace vmech
