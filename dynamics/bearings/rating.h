#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "vmech/dynamics/bearings/arrangement.h"
#include "vmech/dynamics/bearings/bearing.h"
#include "vmech/dynamics/bearings/duty_cycle.h"

namespace vmech {

/// How bearings are lubricated, which decides which limiting speed holds.
enum class Lubrication { kGrease, kOil };

/// What is asked of each bearing of a joint, and of two of them together.
struct BearingRequirements {
  double shaft_min = 0;                                        ///< least bore [m], >= 0
  double shaft_max = std::numeric_limits<double>::infinity();  ///< greatest bore [m], >= shaft_min
  double housing_max = std::numeric_limits<double>::infinity();  ///< greatest D [m], > shaft_min
  double life_hours = 10000;  ///< L_nh at the given reliability [h], >= 0
  double reliability = 90;    ///< [%], 90 .. 99.95; raising it lengthens the L10 that is needed
  double static_safety = 1;   ///< least C0 / P0 [-], > 0; 2 for quiet running, 1.5 for shocks (SKF)
  Lubrication lubrication = Lubrication::kGrease;  ///< decides which limiting speed holds
  /// Of two bearings together, L_nh at the same reliability [h], >= 0; without it `life_hours`.
  std::optional<double> pair_life_hours = std::nullopt;

  /// The life asked of two bearings together, at the same reliability [h].
  double LifeOfPair() const { return pair_life_hours.value_or(life_hours); }

  /// @throws std::invalid_argument with name, value and range.
  void Validate() const;
};

/// Loads, lives and static safety of a bearing in a duty cycle.
struct BearingRating {
  double mean_load = 0;            ///< P_m, mean effective load over the revolutions [N]
  double peak_load = 0;            ///< greatest equivalent dynamic load P [N]
  double peak_axial = 0;           ///< greatest Fa [N]
  double peak_static = 0;          ///< greatest equivalent static load P0 [N]
  double life = 0;                 ///< L10 [10^6 revolutions]; infinite without load or rotation
  double life_hours = 0;           ///< L10h [h]
  double modified_life_hours = 0;  ///< L_nh = a1 L10h at the required reliability [h]
  double static_safety = 0;        ///< C0 / max P0; infinite without load
};

/// Rates a bearing under the force of every pose. The life follows ISO 281 with a1 alone: no
/// credit or penalty for lubrication and cleanliness (aISO = 1).
BearingRating RateBearing(const Bearing& bearing, std::span<const BearingForce> forces,
                          const RotationSummary& rotation, double reliability);

/// P of every pose [N], for plots.
std::vector<double> EquivalentLoads(const Bearing& bearing, std::span<const BearingForce> forces);

/// What a bearing may fail to meet.
enum class Criterion {
  kShaft,         ///< the bore is outside shaft_min .. shaft_max
  kHousing,       ///< D > housing_max
  kLife,          ///< L_nh < life_hours
  kStaticSafety,  ///< C0 / P0 < static_safety
  kSpeed,         ///< max |speed| above the limiting speed
  kValidity,      ///< P > 0.5 C in rotation: ISO 281 does not hold there
  kAxialLoad,     ///< Fa above the axial limit, or any on a cylindrical roller bearing
};

/// A requirement that a bearing does not meet.
struct Shortfall {
  Criterion criterion;  ///< the requirement that is not met
  double ratio = 0;     ///< what there is / what is asked, < 1; the nearer to 1 the closer
  std::string text;     ///< "life 3 200 h of 10 000 h"
};

/// Shortfalls that dimensions alone show. Empty if the bearing has room.
std::vector<Shortfall> DimensionShortfalls(const Bearing& bearing,
                                           const BearingRequirements& requirements);

/// Shortfalls under load. None of them can vanish when the load grows.
std::vector<Shortfall> LoadShortfalls(const Bearing& bearing, const BearingRating& rating,
                                      const RotationSummary& rotation,
                                      const BearingRequirements& requirements);

/// What does not forbid the bearing but should be known: minimum load (SKF: 0.01 C for ball, 0.02 C
/// for roller bearings), oscillation of less than 10 degrees, an unknown limiting speed.
std::vector<std::string> RatingWarnings(const Bearing& bearing, const BearingRating& rating,
                                        const RotationSummary& rotation,
                                        const BearingRequirements& requirements);

/// "26 900 h": three digits, as FormatNumber writes them; "unlimited" if infinite.
std::string FormatHours(double hours);

}  // namespace vmech
