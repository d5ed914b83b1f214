#pragma once

#include <limits>
#include <span>
#include <string>
#include <string_view>

namespace vmech {

/// The kinds of bearings whose loads and lives are known here.
enum class BearingKind {
  kDeepGrooveBall,     ///< single row, normal internal clearance: radial and axial load
  kCylindricalRoller,  ///< purely radial load
};

/// The word used in catalogue files, "deep_groove_ball".
std::string_view NameOf(BearingKind kind);

/// A rolling bearing as a catalogue describes it.
struct Bearing {
  std::string designation;                          ///< as the catalogue has it, such as 6205
  BearingKind kind = BearingKind::kDeepGrooveBall;  ///< decides equivalent loads and life exponent
  double bore = 0;                                  ///< d [m]
  double outer_diameter = 0;                        ///< D [m]
  double width = 0;                                 ///< B [m]
  double dynamic_rating = 0;                        ///< basic dynamic load rating C [N], ISO 281
  double static_rating = 0;                         ///< basic static load rating C0 [N], ISO 76
  double f0 = 0;  ///< factor of the relative axial load f0 Fa / C0 [-]; ball bearings
  double speed_grease = std::numeric_limits<double>::infinity();  ///< limiting speed [rad/s]
  double speed_oil = std::numeric_limits<double>::infinity();     ///< limiting speed [rad/s]
  /// Greatest purely axial load as a multiple of C0 [-]; infinite where the maker states none.
  double axial_limit = std::numeric_limits<double>::infinity();
};

/// Exponent p of the life equation: 3 for balls, 10/3 for rollers. ISO 281:2007.
double LifeExponent(BearingKind kind);

/// Slope of the Weibull distribution of lives: 10/9 for balls, 9/8 for rollers. ISO 281, as
/// used for the life of a system in the general catalogue of NTN.
double WeibullSlope(BearingKind kind);
/// The slope for several bearings together: the flattest, which gives the shortest life.
double WeibullSlope(std::span<const BearingKind> kinds);

/// True if `a` comes before `b` in the order of size: the lesser outer diameter; of equals the
/// lesser width; of equals the greater dynamic rating; then by designation.
bool IsSmaller(const Bearing& a, const Bearing& b);

}  // namespace vmech
