#include "vmech/hw_interface/hand_observer.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "vmech/hw_interface/estimators.h"
#include "vmech/kinematics/rotation_error.h"
#include "vmech/solvers/stopping_rule.h"

namespace vmech {
namespace {

constexpr double kLighter = 1.5;                   // c
constexpr double kMobilityTime = 0.2;              // [s]
constexpr double kLosing = 0.01, kGaining = 0.05;  // [s]: of trust
constexpr double kSmoothing = 2e-3;                // [s]
constexpr double kFinest = 1e-5;                   // [m], [rad]
constexpr int kMostPeriods = 16;                   // a longer gap counts as this

const DeviceInfo& Checked(const DeviceInfo& info) {
  if (HandObserver::Suits(info)) return info;
  throw std::invalid_argument("HandObserver: '" + info.name +
                              "' states no arm, or senses no joints");
}

/// They depend on bandwidth times period alone, (q_j T / R)^(1/6) T with R the sensor's variance.
std::array<double, 3> GainsFor(double bandwidth, double period) {
  constexpr double kStep = 1e-3;
  const double jerk_density = std::pow(bandwidth, 6) * period * kStep * kStep / 12;
  return KalmanGains(period, kStep, jerk_density);
}

}  // namespace

void HandObserverOptions::Validate() const {
  if (bandwidth != 0) CheckRange("HandObserverOptions", "bandwidth", bandwidth, 30, 1e3);
}

bool HandObserver::Suits(const DeviceInfo& info) {
  return info.arm && (info.senses & kSensesJoints) && (info.takes_torque || info.takes_wrench);
}

HandObserver::HandObserver(const HandObserverOptions& options, const DeviceInfo& info)
    : period_(info.period),
      arm_(Checked(info).arm),
      lower_(arm_.joints()),
      upper_(arm_.joints()),
      factor_(arm_.joints()),
      yielding_(MatrixXd::Zero(arm_.joints(), 6)) {
  options.Validate();
  const KinematicTree& tree = arm_.description().tree;
  for (const TreeNode& node : tree.nodes) {
    if (node.v < 0) continue;
    lower_[node.v] = tree.mechanism.joints[node.joint].lower[node.freedom];
    upper_[node.v] = tree.mechanism.joints[node.joint].upper[node.freedom];
  }
  gain_ = GainsFor(options.bandwidth, period_);
  resolution_ << Vector3d::Constant(info.linear.resolution),
      Vector3d::Constant(info.angular.resolution);
  resolution_ = resolution_.cwiseMax(kFinest);
}

void HandObserver::Update(const MasterState& state, const Vector6d& F_Ho_D, int periods) noexcept {
  if (!started_) {
    way_.setZero();
    x_.setZero();
    v_.setZero();
    d_.setZero();
    X_last_ = state.X_DH;
    differences_.setZero();
    until_mobility_ = 0;
    trust_ = 1;
  }
  started_ = true;
  if (until_mobility_-- <= 0) FindMobility(state);
  const double elapsed = std::clamp(periods, 1, kMostPeriods) * period_;
  const double change = AtStop(state) ? -elapsed / kLosing : elapsed / kGaining;
  trust_ = std::clamp(trust_ + change, 0.0, 1.0);
  const Vector6d step = HandError(X_last_, state.X_DH);
  way_ += step;
  X_last_ = state.X_DH;
  differences_ += (1 - std::exp(-elapsed / kSmoothing)) * (step / elapsed - differences_);
  const Vector6d own = kLighter * (mobility_ * F_Ho_D);
  for (int k = std::clamp(periods, 1, kMostPeriods); k > 0; --k) {
    const Vector6d a = own + d_;
    x_ += period_ * (v_ + 0.5 * period_ * a);
    v_ += period_ * a;
  }
  const Vector6d innovation = way_ - x_;
  x_ += gain_[0] * innovation;
  v_ += gain_[1] * innovation;
  d_ += gain_[2] * innovation;
  x_ = way_ + (x_ - way_).cwiseMax(-resolution_).cwiseMin(resolution_);
  X_DH_ = Displaced(state.X_DH, trust_ * (x_ - way_));
  V_DH_ = trust_ * v_ + (1 - trust_) * differences_;
}

bool HandObserver::AtStop(const MasterState& state) const noexcept {
  for (int i = 0; i < arm_.joints(); ++i) {
    if (state.q[i] > upper_[i] || state.q[i] < lower_[i]) return true;
  }
  return false;
}

/// Y at the measured posture; none where the model has no inverse.
void HandObserver::FindMobility(const MasterState& state) noexcept {
  until_mobility_ = static_cast<int>(kMobilityTime / period_);
  arm_.SetPosture(state.q.data());
  factor_.compute(arm_.MassMatrix());
  yielding_ = arm_.J().transpose();
  factor_.solveInPlace(yielding_);
  mobility_ = arm_.J().lazyProduct(yielding_);
  if (factor_.info() != Eigen::Success || !mobility_.allFinite()) mobility_.setZero();
}

}  // namespace vmech
