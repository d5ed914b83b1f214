#include "vmech/hw_interface/arm_torques.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "vmech/kinematics/screw_algebra.h"
#include "vmech/solvers/small_ldlt.h"
#include "vmech/solvers/stopping_rule.h"

namespace vmech {
namespace {

constexpr int kTwistRows[] = {0, 1, 2, 4, 5, 6};  // that are not padding
constexpr int kPaddedRows = 8;
static_assert(sizeof(Screw) == kPaddedRows * sizeof(double));

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
      reduced_(MatrixXd::Zero(kPaddedRows, arm_.joints())),
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
  const Vector6d& F = command->F_Ho_D;
  const Screw F_Do = WrenchAt(FourOf(arm_.X_DH().p), FourOf(F.head<3>()), FourOf(F.tail<3>()));
  for (int i = 0; i < arm_.joints(); ++i) torque_[i] = Power(F_Do, arm_.S()[i]);
  const int count = FindFreeMotions();
  for (int k = 0; k < count; ++k) {
    auto n_k = free_.col(k);
    auto p_k = momenta_.col(k);
    for (int i = 0; i < k; ++i) {
      n_k -= free_.col(i) * (momenta_.col(i).dot(n_k) / momenta_.col(i).dot(free_.col(i)));
    }
    arm_.Momenta(n_k.data(), p_k.data());
    double power = 0, inertia = 0;
    for (int i = 0; i < arm_.joints(); ++i) {
      power += n_k[i] * posture_torque_[i];
      inertia += n_k[i] * p_k[i];
    }
    for (int i = 0; i < arm_.joints(); ++i) torque_[i] += p_k[i] * (power / inertia);
  }
  for (int i = 0; i < arm_.joints(); ++i) command->torque[i] = torque_[i];
}

/// Motions that leave the handle where it is, by Gauss-Jordan elimination, each row with its
/// largest entry for a pivot; writes them to free_ and returns how many there are.
int ArmTorques::FindFreeMotions() noexcept {
  constexpr double kSingular = 1e-9;  // pivot over the norm of J: the handle cannot go that way
  const int n = arm_.joints();
  std::array<double*, kMaxArmJoints> column;  // those of pivots first
  double square = 0;
  for (int j = 0; j < n; ++j) {
    column[j] = reduced_.col(j).data();
    const Screw& S = arm_.S()[j];
    StoreFour(S.linear, column[j]);
    StoreFour(S.angular, column[j] + 4);
    square += Power(S, S);
  }
  const double singular = kSingular * std::sqrt(square);
  std::array<int, 6> pivot_row;
  int rank = 0;
  for (int row : kTwistRows) {
    if (rank == n) break;
    int at = rank;
    double largest = std::abs(column[rank][row]);
    for (int j = rank + 1; j < n; ++j) {
      const double size = std::abs(column[j][row]);
      at = size > largest ? j : at;
      largest = std::max(largest, size);
    }
    if (!(largest > singular)) continue;
    std::swap(column[rank], column[at]);
    const double inverse = 1 / column[rank][row];
    for (int j = rank + 1; j < n; ++j) {
      const double share = column[j][row] * inverse;
      AddScaled(-share, column[rank], kPaddedRows, column[j]);
      column[j][row] = share;
    }
    pivot_row[rank++] = row;
  }
  const auto joint = [&](const double* c) { return (c - reduced_.data()) / kPaddedRows; };
  for (int k = 0; k < n - rank; ++k) {
    double* motion = free_.col(k).data();
    std::fill_n(motion, n, 0.0);
    motion[joint(column[rank + k])] = 1;
    for (int i = 0; i < rank; ++i) motion[joint(column[i])] = -column[rank + k][pivot_row[i]];
  }
  return n - rank;
}

}  // namespace vmech
