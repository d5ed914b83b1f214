#include "vmech/dynamics/bearings/rating.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "vmech/base/text/number_text.h"
#include "vmech/dynamics/bearings/rating_life.h"

namespace vmech {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// ISO 281 takes the deformations in the contacts as elastic: P <= 0.5 C.
constexpr double kValidLoad = 0.5;
/// Dimensions are decimal millimetres converted to metres: roundoff must not refuse 20 for 20.
constexpr double kDimensionRoundoff = 1e-9;
/// Axial share of the peak static load above which a cylindrical roller bearing is refused;
/// roundoff is less.
constexpr double kNoAxialLoad = 1e-6;
/// Half of the swept angle under which the oscillation rule does not hold (SKF) [rad].
constexpr double kLeastAmplitude = 10 * std::numbers::pi / 180;

double Rpm(double speed) {
  return speed * 30 / std::numbers::pi;
}

double LimitingSpeed(const Bearing& bearing, Lubrication lubrication) {
  return lubrication == Lubrication::kGrease ? bearing.speed_grease : bearing.speed_oil;
}

void Require(bool holds, const char* name, double value, const char* range) {
  if (!holds) {
    throw std::invalid_argument(
        fmt::format("bearing requirement {} is {}, but must be {}", name, value, range));
  }
}

}  // namespace

void BearingRequirements::Validate() const {
  Require(shaft_min >= 0 && std::isfinite(shaft_min), "shaft_min [m]", shaft_min, ">= 0");
  Require(shaft_max > 0 && shaft_max >= shaft_min, "shaft_max [m]", shaft_max,
          "> 0 and at least shaft_min");
  Require(housing_max > 0 && housing_max > shaft_min, "housing_max [m]", housing_max,
          "> 0 and above shaft_min");
  Require(life_hours >= 0 && std::isfinite(life_hours), "life_hours [h]", life_hours, ">= 0");
  Require(LifeOfPair() >= 0 && std::isfinite(LifeOfPair()), "pair_life_hours [h]", LifeOfPair(),
          ">= 0");
  Require(static_safety > 0 && std::isfinite(static_safety), "static_safety", static_safety, "> 0");
  ReliabilityFactor(reliability);
}

std::vector<double> EquivalentLoads(const Bearing& bearing, std::span<const BearingForce> forces) {
  std::vector<double> loads(forces.size());
  std::transform(forces.begin(), forces.end(), loads.begin(), [&](const BearingForce& F) {
    return EquivalentDynamicLoad(bearing, F.radial(), F.axial());
  });
  return loads;
}

BearingRating RateBearing(const Bearing& bearing, std::span<const BearingForce> forces,
                          const RotationSummary& rotation, double reliability) {
  BearingRating rating;
  const std::vector<double> loads = EquivalentLoads(bearing, forces);
  for (size_t i = 0; i < forces.size(); ++i) {
    const double Fa = forces[i].axial();
    rating.peak_load = std::max(rating.peak_load, loads[i]);
    rating.peak_axial = std::max(rating.peak_axial, Fa);
    rating.peak_static =
        std::max(rating.peak_static, EquivalentStaticLoad(bearing, forces[i].radial(), Fa));
  }
  rating.static_safety =
      rating.peak_static > 0 ? bearing.static_rating / rating.peak_static : kInfinity;
  if (rotation.rotation == Rotation::kStanding) {
    rating.life = rating.life_hours = rating.modified_life_hours = kInfinity;
    return rating;
  }
  rating.mean_load =
      MeanEffectiveLoad(loads, rotation.revolutions_of_pose, LifeExponent(bearing.kind));
  rating.life = BasicRatingLife(bearing.dynamic_rating, rating.mean_load, bearing.kind);
  rating.life_hours = HoursOf(rating.life, rotation.mean_speed);
  rating.modified_life_hours = ReliabilityFactor(reliability) * rating.life_hours;
  return rating;
}

std::vector<Shortfall> DimensionShortfalls(const Bearing& bearing,
                                           const BearingRequirements& requirements) {
  std::vector<Shortfall> shortfalls;
  const double d = bearing.bore, D = bearing.outer_diameter;
  const double low = requirements.shaft_min, high = requirements.shaft_max;
  if (d < low * (1 - kDimensionRoundoff)) {
    shortfalls.push_back(
        {Criterion::kShaft, d / low,
         fmt::format("bore {:.4g} mm, shaft at least {:.4g} mm", d * 1e3, low * 1e3)});
  } else if (d > high * (1 + kDimensionRoundoff)) {
    shortfalls.push_back(
        {Criterion::kShaft, high / d,
         fmt::format("bore {:.4g} mm, shaft at most {:.4g} mm", d * 1e3, high * 1e3)});
  }
  if (D > requirements.housing_max * (1 + kDimensionRoundoff)) {
    shortfalls.push_back({Criterion::kHousing, requirements.housing_max / D,
                          fmt::format("outer diameter {:.4g} mm, housing at most {:.4g} mm",
                                      D * 1e3, requirements.housing_max * 1e3)});
  }
  return shortfalls;
}

std::vector<Shortfall> LoadShortfalls(const Bearing& bearing, const BearingRating& rating,
                                      const RotationSummary& rotation,
                                      const BearingRequirements& requirements) {
  std::vector<Shortfall> shortfalls;
  // `there` and `asked` such that there < asked is a shortfall.
  const auto require = [&](Criterion criterion, double there, double asked, auto describe) {
    if (there < asked) shortfalls.push_back({criterion, there / asked, describe()});
  };
  require(Criterion::kLife, rating.modified_life_hours, requirements.life_hours, [&] {
    return fmt::format("life {} of {}", FormatHours(rating.modified_life_hours),
                       FormatHours(requirements.life_hours));
  });
  require(Criterion::kStaticSafety, rating.static_safety, requirements.static_safety, [&] {
    return fmt::format("static safety {:.3g} of {:.3g}", rating.static_safety,
                       requirements.static_safety);
  });
  const double limit = LimitingSpeed(bearing, requirements.lubrication);
  require(Criterion::kSpeed, limit, rotation.peak_speed, [&] {
    return fmt::format("limiting speed {:.0f} rpm of {:.0f} rpm", Rpm(limit),
                       Rpm(rotation.peak_speed));
  });
  if (rotation.rotation != Rotation::kStanding) {
    const double valid = kValidLoad * bearing.dynamic_rating;
    require(Criterion::kValidity, valid, rating.peak_load, [&] {
      return fmt::format("P {:.3g} kN above 0.5 C = {:.3g} kN, where ISO 281 does not hold",
                         rating.peak_load / 1e3, valid / 1e3);
    });
  }
  const double axial = bearing.kind == BearingKind::kCylindricalRoller
                           ? kNoAxialLoad * rating.peak_static
                           : bearing.axial_limit * bearing.static_rating;
  require(Criterion::kAxialLoad, axial, rating.peak_axial, [&] {
    return fmt::format("axial load {:.3g} kN, at most {:.3g} kN", rating.peak_axial / 1e3,
                       bearing.kind == BearingKind::kCylindricalRoller ? 0.0 : axial / 1e3);
  });
  return shortfalls;
}

std::vector<std::string> RatingWarnings(const Bearing& bearing, const BearingRating& rating,
                                        const RotationSummary& rotation,
                                        const BearingRequirements& requirements) {
  if (rotation.rotation == Rotation::kStanding) {
    return {"the joint does not turn: no rating life, static safety alone decides"};
  }
  std::vector<std::string> warnings;
  if (rotation.rotation == Rotation::kOscillating && rotation.amplitude < kLeastAmplitude) {
    warnings.push_back(fmt::format(
        "oscillates by +-{:.3g} deg: under 10 deg the rating life does not hold, and the raceways "
        "wear by false brinelling",
        rotation.amplitude * 180 / std::numbers::pi));
  }
  const double share = bearing.kind == BearingKind::kDeepGrooveBall ? 0.01 : 0.02;
  if (rating.mean_load < share * bearing.dynamic_rating) {
    warnings.push_back(fmt::format(
        "mean load {:.3g} N is below the minimum load of {} C = {:.3g} N: the rolling elements may "
        "slide; preload the bearing",
        rating.mean_load, share, share * bearing.dynamic_rating));
  }
  if (std::isinf(LimitingSpeed(bearing, requirements.lubrication))) {
    warnings.push_back("the catalogue states no limiting speed: the speed was not checked");
  }
  return warnings;
}

std::string FormatHours(double hours) {
  if (std::isinf(hours)) return "unlimited";
  const double scale =
      std::pow(10, std::max(0.0, std::floor(std::log10(std::max(hours, 1.0))) - 2));
  return FormatNumber(std::round(hours / scale) * scale, 0) + " h";
}

}  // namespace vmech
