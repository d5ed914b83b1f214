#include "vmech/hw_interface/arm_torques.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "vmech/kinematics/screw_algebra.h"
#include "vmech/solvers/small_ldlt.h"
#include "vmech/solvers/stopping_rule.h"

namespace vmech {
namespace {

constexpr int kPaddedRows = 8;
static_assert(sizeof(Screw) == kPaddedRows * sizeof(double));
constexpr double kUnits[6][kPaddedRows] = {
    {1}, {0, 1}, {0, 0, 1}, {0, 0, 0, 0, 1}, {0, 0, 0, 0, 0, 1}, {0, 0, 0, 0, 0, 0, 1}};

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
  std::iota(joint_.begin(), joint_.end(), 0);
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

/// Motions that leave the handle where it is; writes them to free_ and returns how many there are.
int ArmTorques::FindFreeMotions() noexcept {
  constexpr double kMostGrowth = 4;
  const int n = arm_.joints(), full = std::min(n, 6);
  // The pivots of the last posture mostly do.
  const bool done = rank_ == full && Eliminate(false) < kMostGrowth && rank_ == full;
  if (!done) Eliminate(true);
  for (int k = 0; k < n - rank_; ++k) {
    double* motion = free_.col(k).data();
    const double* const shares = reduced_.col(rank_ + k).data();
    std::fill_n(motion, n, 0.0);
    motion[joint_[rank_ + k]] = 1;
    for (int i = 0; i < rank_; ++i) motion[joint_[i]] = -shares[pivot_row_[i]];
  }
  return n - rank_;
}

/// Gauss-Jordan elimination of S, joint by joint in the order of joint_; if `search`, in that in
/// which every row has its largest entry for a pivot. Leaves each column's shares of the pivots' in
/// the pivots' rows, and returns the largest.
double ArmTorques::Eliminate(bool search) noexcept {
  constexpr double kSingular = 1e-9;  // pivot over the norm of S: the handle cannot go that way
  const int n = arm_.joints();
  double* const columns = reduced_.data();
  double* const end = columns + kPaddedRows * n;
  double square = 0, largest_share = 0;
  for (int j = 0; j < n; ++j) {
    const Screw& S = arm_.S()[joint_[j]];
    StoreFour(S.linear, columns + kPaddedRows * j);
    StoreFour(S.angular, columns + kPaddedRows * j + 4);
    square += Power(S, S);
  }
  const double singular = kSingular * std::sqrt(square);
  rank_ = 0;
  for (int i = 0; i < 6 && rank_ < n; ++i) {
    const int row = i < 3 ? i : i + 1;  // the fourth is padding
    if (search) BringLargestForward(row);
    const double* const pivot = columns + kPaddedRows * rank_;
    if (!(std::abs(pivot[row]) > singular)) continue;
    // A pivot less one leaves the share where it eliminates: no second store, which would hold up
    // the next load.
    const double inverse = 1 / pivot[row];
    const Four linear = LoadFour(pivot) - LoadFour(kUnits[i]);
    const Four angular = LoadFour(pivot + 4) - LoadFour(kUnits[i] + 4);
    for (double* c = columns + kPaddedRows * (rank_ + 1); c < end; c += kPaddedRows) {
      const double share = c[row] * inverse;
      StoreFour(LoadFour(c) - share * linear, c);
      StoreFour(LoadFour(c + 4) - share * angular, c + 4);
      largest_share = std::max(largest_share, std::abs(share));
    }
    pivot_row_[rank_++] = row;
  }
  return largest_share;
}

/// Of the columns that are no pivots yet.
void ArmTorques::BringLargestForward(int row) noexcept {
  Eigen::Index largest = 0;
  reduced_.row(row).tail(arm_.joints() - rank_).cwiseAbs().maxCoeff(&largest);
  std::swap(joint_[rank_], joint_[rank_ + largest]);
  reduced_.col(rank_).swap(reduced_.col(rank_ + largest));
}

}  // namespace vmech
