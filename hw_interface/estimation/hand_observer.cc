#include "vmech/hw_interface/estimation/hand_observer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "vmech/base/check_range.h"
#include "vmech/base/rotation_error.h"
#include "vmech/base/screw_algebra.h"
#include "vmech/hw_interface/estimation/estimators.h"

namespace vmech {
namespace {

constexpr double kMobilityTime = 0.2;              // [s]
constexpr double kLosing = 0.01, kGaining = 0.05;  // [s]: of trust
constexpr double kSmoothing = 2;                   // [periods]: of differences
constexpr double kFinest = 1e-5;                   // [m], [rad]

constexpr double kNoStop = std::numeric_limits<double>::infinity();

/// Into [-most, most].
Double4 Clamped(const Double4& a, const Double4& most) {
  const Double4 below = a < most ? a : most;
  return below > -most ? below : -most;
}

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
  CheckRange("HandObserverOptions", "lighter", lighter, 0, 4);
}

bool HandObserver::Suits(const DeviceInfo& info) {
  return info.arm && (info.senses & kSensesJoints) && (info.takes_torque || info.takes_wrench);
}

HandObserver::HandObserver(const HandObserverOptions& options, const DeviceInfo& info)
    : period_(info.period),
      lighter_(options.lighter),
      arm_(Checked(info).arm),
      lower_(JointArray::Constant(-kNoStop)),
      upper_(JointArray::Constant(kNoStop)),
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
  for (int k = 0; k <= kMostPeriods; ++k) new_share_[k] = 1 - std::exp(-k / kSmoothing);
  resolution_ = {Double4Of(Vector3d::Constant(std::max(info.linear.resolution, kFinest))),
                 Double4Of(Vector3d::Constant(std::max(info.angular.resolution, kFinest)))};
}

void HandObserver::Update(const MasterState& state, const Vector6d& F_Ho_D, int periods) noexcept {
  const Frame X = FrameOf(state.X_DH);
  if (!started_) {
    displacement_ = x_ = v_ = d_ = differences_ = {};
    X_last_ = X;
    until_mobility_ = 0;
    trust_ = 1;
  }
  started_ = true;
  if (until_mobility_-- <= 0) FindMobility(state);
  periods = std::clamp(periods, 1, kMostPeriods);
  const double elapsed = periods * period_;
  const Screw step = HandError(X_last_, X);
  displacement_ += step;
  X_last_ = X;
  differences_ += new_share_[periods] * ((1 / elapsed) * step - differences_);
  Screw a = d_;
  for (int i = 0; i < 6; ++i) a += F_Ho_D[i] * mobility_[i];
  for (int k = periods; k > 0; --k) {
    x_ += period_ * (v_ + (0.5 * period_) * a);
    v_ += period_ * a;
  }
  const Screw innovation = displacement_ - x_;
  x_ += gain_[0] * innovation;
  v_ += gain_[1] * innovation;
  d_ += gain_[2] * innovation;
  const Screw ahead = x_ - displacement_;
  const Screw within{Clamped(ahead.linear, resolution_.linear),
                     Clamped(ahead.angular, resolution_.angular)};
  x_ = displacement_ + within;
  const Screw beyond = ahead - within;
  const bool strays = Power(beyond, beyond) > 0;
  const double change = strays || AtStop(state) ? -elapsed / kLosing : elapsed / kGaining;
  trust_ = std::clamp(trust_ + change, 0.0, 1.0);
  hand_ = {Displaced(X, trust_ * within), trust_ * v_ + (1 - trust_) * differences_};
}

Posed HandObserver::X_DH() const noexcept {
  return PoseOf(hand_.X);
}

Vector6d HandObserver::V_DH() const noexcept {
  return Vector6Of(hand_.V);
}

bool HandObserver::AtStop(const MasterState& state) const noexcept {
  const auto q = Eigen::Map<const JointArray>(state.q.data());
  return (q - upper_).max(lower_ - q).maxCoeff() > 0;
}

/// Y at the measured posture; none where the model has no inverse.
void HandObserver::FindMobility(const MasterState& state) noexcept {
  until_mobility_ = static_cast<int>(kMobilityTime / period_);
  arm_.SetPosture(state.q.data());
  factor_.compute(arm_.MassMatrix());
  yielding_ = arm_.J().transpose();
  factor_.solveInPlace(yielding_);
  const Matrix6d Y = arm_.J().lazyProduct(yielding_);
  const bool sound = factor_.info() == Eigen::Success && Y.allFinite();
  for (int i = 0; i < 6; ++i) mobility_[i] = sound ? lighter_ * ScrewOf(Y.col(i)) : Screw{};
}

}  // namespace vmech
