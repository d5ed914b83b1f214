#include "vmech/hw_interface/estimation/coordinate_estimator.h"

#include <algorithm>

namespace vmech {
namespace {

using Estimator = std::variant<KalmanEstimator<>, QuadraticFit, FiniteDifferences, AdaptiveWindow>;

Estimator MakeEstimator(const EstimatorOptions& options, double period,
                        const CoordinateEstimator::Coordinate& x) {
  switch (options.kind) {
    case EstimatorKind::kObserver:
    case EstimatorKind::kKalman:
      return KalmanEstimator<>(period, x.resolution,
                               x.is_angle ? options.angular_jerk_density : options.jerk_density);
    case EstimatorKind::kQuadraticFit:
      return QuadraticFit(period, options.window);
    case EstimatorKind::kFiniteDifferences:
      return FiniteDifferences(period);
    case EstimatorKind::kAdaptiveWindow:
      break;
  }
  return AdaptiveWindow(period, 0.5 * x.resolution, options.window);
}

}  // namespace

CoordinateEstimator::CoordinateEstimator(const EstimatorOptions& options, double period,
                                         const std::vector<Coordinate>& coordinates)
    : displacement_(VectorXd::Zero(static_cast<Eigen::Index>(coordinates.size()))),
      v_(displacement_),
      a_(displacement_) {
  for (const Coordinate& x : coordinates) {
    estimators_.push_back(MakeEstimator(options, period, x));
  }
}

void CoordinateEstimator::Reset() noexcept {
  for (Estimator& e : estimators_) std::visit([](auto& filter) { filter.Reset(); }, e);
  displacement_.setZero();
  v_.setZero();
  a_.setZero();
}

void CoordinateEstimator::Update(const VectorXd& step, int periods) noexcept {
  constexpr int kMostSteps = 16;  // a longer gap counts as this
  const int steps = std::clamp(periods, 1, kMostSteps);
  for (size_t i = 0; i < estimators_.size(); ++i) {
    const auto n = static_cast<Eigen::Index>(i);
    for (int k = 0; k < steps; ++k) {
      displacement_[n] += step[n] / steps;
      const MotionEstimate e =
          std::visit([&](auto& filter) { return filter.Update(displacement_[n]); }, estimators_[i]);
      v_[n] = e.v;
      a_[n] = e.a;
    }
  }
}

}  // namespace vmech
