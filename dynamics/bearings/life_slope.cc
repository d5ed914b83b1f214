#include "vmech/dynamics/bearings/life_slope.h"

#include <array>
#include <cmath>
#include <numbers>

#include "vmech/dynamics/bearings/rating_life.h"

namespace vmech {
namespace {

Dual RadialLoad(const Vector3<Dual>& R) {
  return sqrt(R.x() * R.x() + R.y() * R.y());
}

}  // namespace

Dual LifeHours(const Bearing& bearing, const Arrangement& arrangement, size_t position,
               const DutySlopes& duty, double reliability) {
  std::vector<Dual> loads, revolutions;
  Dual path = 0, time = 0;
  for (size_t i = 0; i < duty.wrench.size(); ++i) {
    const Vector3<Dual> R = SharesOf(arrangement, duty.wrench[i])[position];
    loads.push_back(EquivalentDynamicLoad(bearing, RadialLoad(R), abs(R.z())));
    revolutions.push_back(abs(duty.speed[i]) * duty.duration[i] / (2 * std::numbers::pi));
    path += abs(duty.speed[i]) * duty.duration[i];
    time += duty.duration[i];
  }
  const Dual mean = MeanEffectiveLoad(
      std::span<const Dual>(loads), std::span<const Dual>(revolutions), LifeExponent(bearing.kind));
  const Dual life = BasicRatingLife(bearing.dynamic_rating, mean, bearing.kind);
  return ReliabilityFactor(reliability) * HoursOf(life, path / time);
}

}  // namespace vmech
