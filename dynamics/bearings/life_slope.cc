#include "vmech/dynamics/bearings/life_slope.h"

#include <array>
#include <cmath>
#include <numbers>

#include "vmech/dynamics/bearings/rating_life.h"

namespace vmech {
namespace {

Taped RadialLoad(const Vector3<Taped>& R) {
  return sqrt(R.x() * R.x() + R.y() * R.y());
}

}  // namespace

Taped LifeHours(const Bearing& bearing, const ArrangementSlopes& arrangement, size_t position,
                const DutySlopes& duty) {
  std::vector<Taped> loads, revolutions;
  Taped path = 0, time = 0;
  for (size_t i = 0; i < duty.wrench.size(); ++i) {
    const Vector3<Taped> R =
        SharesOf(arrangement.positions, arrangement.locating, duty.wrench[i])[position];
    loads.push_back(EquivalentDynamicLoad(bearing, RadialLoad(R), abs(R.z())));
    revolutions.push_back(abs(duty.speed[i]) * duty.duration[i] / (2 * std::numbers::pi));
    path += abs(duty.speed[i]) * duty.duration[i];
    time += duty.duration[i];
  }
  const Taped mean =
      MeanEffectiveLoad(std::span<const Taped>(loads), std::span<const Taped>(revolutions),
                        LifeExponent(bearing.kind));
  const Taped life = BasicRatingLife(bearing.dynamic_rating, mean, bearing.kind);
  return ReliabilityFactor(arrangement.reliability) * HoursOf(life, path / time);
}

}  // namespace vmech
