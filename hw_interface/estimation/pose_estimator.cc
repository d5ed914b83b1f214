#include "vmech/hw_interface/estimation/pose_estimator.h"

#include <algorithm>

#include "vmech/base/rotation_error.h"

namespace vmech {

PoseEstimator::Estimator PoseEstimator::Make(const PoseEstimatorOptions& options, double period,
                                             double resolution, double jerk_density) {
  switch (options.kind) {
    case EstimatorKind::kKalman:
      return KalmanEstimator<>(period, resolution, jerk_density);
    case EstimatorKind::kQuadraticFit:
      return QuadraticFit(period, options.window);
    case EstimatorKind::kFiniteDifferences:
      return FiniteDifferences(period);
    case EstimatorKind::kAdaptiveWindow:
      break;
  }
  return AdaptiveWindow(period, 0.5 * resolution, options.window);
}

PoseEstimator::PoseEstimator(const PoseEstimatorOptions& options, double period, double resolution,
                             double angular_resolution)
    : estimators_{Make(options, period, resolution, options.jerk_density),
                  Make(options, period, resolution, options.jerk_density),
                  Make(options, period, resolution, options.jerk_density),
                  Make(options, period, angular_resolution, options.angular_jerk_density),
                  Make(options, period, angular_resolution, options.angular_jerk_density),
                  Make(options, period, angular_resolution, options.angular_jerk_density)} {}

void PoseEstimator::Reset() noexcept {
  for (Estimator& e : estimators_) std::visit([](auto& filter) { filter.Reset(); }, e);
  started_ = false;
  V_.setZero();
  A_.setZero();
}

void PoseEstimator::Update(const Posed& X_WB, int periods) noexcept {
  constexpr int kMostSteps = 16;  // a longer gap counts as this
  const int steps = std::clamp(started_ ? periods : 1, 1, kMostSteps);
  Vector6d step = Vector6d::Zero();
  if (started_) {
    step = HandError(X_last_, X_WB) / steps;
  } else {
    displacement_ << X_WB.p, Vector3d::Zero();
  }
  X_last_ = X_WB;
  started_ = true;
  for (int k = 0; k < steps; ++k) {
    displacement_ += step;
    for (int i = 0; i < 6; ++i) {
      const MotionEstimate e =
          std::visit([&](auto& filter) { return filter.Update(displacement_[i]); }, estimators_[i]);
      V_[i] = e.v;
      A_[i] = e.a;
    }
  }
}

}  // namespace vmech
