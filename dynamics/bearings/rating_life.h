#pragma once

#include <span>

#include "vmech/base/tape/tape.h"
#include "vmech/dynamics/bearings/bearing.h"

namespace vmech {

/// The formulas of ISO 281 (rating life) and ISO 76 (static load rating). Forces in N, lives in
/// millions of revolutions unless the name says hours. Of duals with their derivatives.

/// Factors of the equivalent dynamic load of a single-row deep groove ball bearing.
struct AxialFactors {
  double e = 0;  ///< Fa / Fr up to which the axial load does not count
  double X = 0;  ///< weight of the radial load above e
  double Y = 0;  ///< weight of the axial load above e
};

/// e and Y for the relative axial load f0 Fa / C0, linear between the rows of the table for normal
/// clearance (ISO 281:2007, table 3; the same in the catalogues of SKF, NSK, NTN and FAG).
/// Outside 0.172 .. 6.89 the nearest row is kept: above, Y is then too great (safe); below, too
/// small, which matters only for P < 0.07 C0, where fatigue does not decide.
AxialFactors DeepGrooveFactors(double relative_axial_load);

/// P = max(Fr, X Fr + Y Fa) for deep groove ball bearings; P = Fr for cylindrical rollers. The
/// maximum in place of the printed case distinction (Fa / Fr <= e) makes P continuous, and differs
/// from it by at most 0.7 % upwards. Never decreases with Fr or Fa. [N]
double EquivalentDynamicLoad(const Bearing& bearing, double radial, double axial);
/// The same with its derivatives.
Taped EquivalentDynamicLoad(const Bearing& bearing, const Taped& radial, const Taped& axial);

/// P0 = max(Fr, 0.6 Fr + 0.5 Fa) for deep groove ball bearings; P0 = Fr for cylindrical rollers.
/// ISO 76:2006. [N]
double EquivalentStaticLoad(const Bearing& bearing, double radial, double axial);

/// P_m = (sum w P^p / sum w)^(1/p): the constant load that is as harmful as the loads P_i over
/// revolutions w_i. Zero if nothing turns. [N]
/// @throws std::invalid_argument if the lengths differ.
double MeanEffectiveLoad(std::span<const double> loads, std::span<const double> revolutions,
                         double exponent);
/// The same with its derivatives.
Taped MeanEffectiveLoad(std::span<const Taped> loads, std::span<const Taped> revolutions,
                        double exponent);

/// L10 = (C / P)^p in 10^6 revolutions; infinite without load. ISO 281:2007, 5.3.
double BasicRatingLife(double rating, double load, BearingKind kind);
/// The same with its derivatives.
Taped BasicRatingLife(double rating, const Taped& load, BearingKind kind);

/// C = P L^(1/p): the rating that gives the load P the life L [10^6 revolutions].
double RequiredDynamicRating(double load, double life, BearingKind kind);

/// Hours of a life in 10^6 revolutions at `speed` [rad/s]; infinite at rest.
double HoursOf(double life, double speed);
/// The same with its derivatives.
Taped HoursOf(const Taped& life, const Taped& speed);

/// a1 for a reliability of 90 .. 99.95 %, ISO 281:2007, table 12. Linear between the rows, which is
/// safe because a1 falls ever faster (up to the rounding of the table).
/// @throws std::invalid_argument outside the range.
double ReliabilityFactor(double reliability);
/// The same with its derivatives.
Taped ReliabilityFactor(const Taped& reliability);

/// L = (sum L_i^-e)^(-1/e): the life of several bearings that must all survive, at the reliability
/// at which the L_i are given; e is the Weibull slope.
double SystemLife(std::span<const double> lives, double weibull_slope);
/// The same with its derivatives.
Taped SystemLife(std::span<const Taped> lives, double weibull_slope);

}  // namespace vmech
