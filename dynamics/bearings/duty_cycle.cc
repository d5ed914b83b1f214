#include "vmech/dynamics/bearings/duty_cycle.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace vmech {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
/// Path per cycle [rad] under which a joint stands: roundoff of a joint that does not turn.
constexpr double kStandingPath = 1e-9;
/// Share of the path that must run backwards for a reversal: roundoff is below it.
constexpr double kReversal = 1e-6;

void RequireSize(const char* list, size_t size, size_t poses) {
  if (size != poses) {
    throw std::invalid_argument(
        fmt::format("duty cycle: {} has {} values, but there are {} wrenches", list, size, poses));
  }
}

void RequireFinite(const char* list, size_t pose, double value) {
  if (!std::isfinite(value)) {
    throw std::invalid_argument(
        fmt::format("duty cycle: {} of pose {} is {}; it must be finite", list, pose, value));
  }
}

}  // namespace

void DutyCycle::Validate() const {
  const size_t poses = wrench.size();
  if (poses == 0) throw std::invalid_argument("duty cycle: it has no poses");
  RequireSize("duration", duration.size(), poses);
  RequireSize("angle", angle.size(), poses);
  RequireSize("speed", speed.size(), poses);
  double total = 0;
  for (size_t i = 0; i < poses; ++i) {
    RequireFinite("duration", i, duration[i]);
    RequireFinite("angle", i, angle[i]);
    RequireFinite("speed", i, speed[i]);
    for (double component : wrench[i].Stacked()) RequireFinite("wrench", i, component);
    if (duration[i] < 0) {
      throw std::invalid_argument(fmt::format(
          "duty cycle: duration of pose {} is {} s; it must not be negative", i, duration[i]));
    }
    total += duration[i];
  }
  if (!(total > 0)) throw std::invalid_argument("duty cycle: all durations are zero");
}

std::vector<double> DurationsFromTimes(std::span<const double> times, double cycle) {
  const size_t poses = times.size();
  if (poses == 1) return {cycle > 0 ? cycle : 1.0};
  std::vector<double> duration(poses, 0.0);
  for (size_t i = 1; i < poses; ++i) {
    const double step = times[i] - times[i - 1];
    if (!(step > 0)) {
      throw std::invalid_argument(fmt::format("times must ascend, but {} s follows {} s (pose {})",
                                              times[i], times[i - 1], i));
    }
    duration[i - 1] += step / 2;
    duration[i] += step / 2;
  }
  if (cycle > 0 && poses > 0) {
    const double step = std::max(0.0, cycle - (times.back() - times.front()));
    duration.front() += step / 2;
    duration.back() += step / 2;
  }
  return duration;
}

RotationSummary SummariseRotation(const DutyCycle& cycle) {
  RotationSummary summary;
  double forward = 0, backward = 0;
  for (size_t i = 0; i < cycle.wrench.size(); ++i) {
    const double path = std::abs(cycle.speed[i]) * cycle.duration[i];
    (cycle.speed[i] > 0 ? forward : backward) += path;
    summary.revolutions_of_pose.push_back(path / kTurn);
    summary.cycle_time += cycle.duration[i];
    summary.peak_speed = std::max(summary.peak_speed, std::abs(cycle.speed[i]));
  }
  const double path = forward + backward;
  const auto [low, high] = std::minmax_element(cycle.angle.begin(), cycle.angle.end());
  summary.revolutions = path / kTurn;
  summary.mean_speed = path / summary.cycle_time;
  summary.amplitude = (*high - *low) / 2;
  if (path <= kStandingPath) {
    summary.rotation = Rotation::kStanding;
  } else if (std::min(forward, backward) <= kReversal * path) {
    summary.rotation = Rotation::kTurning;
  } else {
    summary.rotation = *high - *low < kTurn ? Rotation::kOscillating : Rotation::kReversing;
  }
  return summary;
}

}  // namespace vmech
