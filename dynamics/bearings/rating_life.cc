#include "vmech/dynamics/bearings/rating_life.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace vmech {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Columns f0 Fa / C0, e, Y: normal internal clearance.
constexpr std::array kRelativeAxialLoad{0.172, 0.345, 0.689, 1.03, 1.38, 2.07, 3.45, 5.17, 6.89};
constexpr std::array kE{0.19, 0.22, 0.26, 0.28, 0.30, 0.34, 0.38, 0.42, 0.44};
constexpr std::array kY{2.30, 1.99, 1.71, 1.55, 1.45, 1.31, 1.15, 1.04, 1.00};
constexpr double kX = 0.56;

// Reliability [%] and a1.
constexpr std::array kReliability{90.0, 95.0, 96.0, 97.0, 98.0,  99.0,  99.2,
                                  99.4, 99.6, 99.8, 99.9, 99.92, 99.94, 99.95};
constexpr std::array kA1{1.0,  0.64, 0.55, 0.47,  0.37,  0.25, 0.22,
                         0.19, 0.16, 0.12, 0.093, 0.087, 0.08, 0.077};

/// Where x lies among the ascending nodes: x = nodes[index] + fraction (nodes[index + 1] - ...),
/// held at the ends.
template <typename T>
struct TablePosition {
  size_t index;
  T fraction;
};

template <typename T, size_t N>
TablePosition<T> Locate(const std::array<double, N>& nodes, const T& x) {
  using std::max, std::min;
  const auto above = std::upper_bound(nodes.begin() + 1, nodes.end() - 1, x,
                                      [](const T& at, double node) { return at < T(node); });
  const size_t i = above - nodes.begin() - 1;
  const T fraction = (x - nodes[i]) / (nodes[i + 1] - nodes[i]);
  return {i, min(max(fraction, T(0)), T(1))};
}

template <typename T, size_t N>
T Interpolate(const std::array<double, N>& values, const TablePosition<T>& at) {
  return values[at.index] + at.fraction * (values[at.index + 1] - values[at.index]);
}

// The formulas, on numbers or duals.

template <typename T>
T DynamicLoad(const Bearing& bearing, const T& radial, const T& axial) {
  using std::max;
  if (bearing.kind == BearingKind::kCylindricalRoller) return radial;
  const TablePosition<T> at =
      Locate<T>(kRelativeAxialLoad, bearing.f0 * axial / bearing.static_rating);
  return max(radial, kX * radial + Interpolate(kY, at) * axial);
}

template <typename T>
T MeanLoad(std::span<const T> loads, std::span<const T> revolutions, double exponent) {
  using std::pow;
  if (loads.size() != revolutions.size()) {
    throw std::invalid_argument(
        fmt::format("mean load: {} loads but {} revolutions", loads.size(), revolutions.size()));
  }
  const T zero(0);
  T harm(0), sum(0);
  for (size_t i = 0; i < loads.size(); ++i) {
    const T& P = loads[i];
    harm += revolutions[i] * (exponent == 3.0 ? P * P * P : pow(P, exponent));
    sum += revolutions[i];
  }
  return sum > zero && harm > zero ? T(pow(T(harm / sum), 1 / exponent)) : zero;
}

template <typename T>
T RatingLife(double rating, const T& load, BearingKind kind) {
  using std::pow;
  return load > T(0) ? T(pow(T(rating / load), LifeExponent(kind))) : T(kInfinity);
}

template <typename T>
T Hours(const T& life, const T& speed) {
  constexpr double kRevolutionsPerMillion = 1e6;
  constexpr double kSecondsPerHour = 3600;
  if (!(speed > T(0))) return kInfinity;
  return life * kRevolutionsPerMillion * 2 * std::numbers::pi / speed / kSecondsPerHour;
}

template <typename T>
T LifeTogether(std::span<const T> lives, double weibull_slope) {
  using std::pow;
  T sum(0);
  for (const T& L : lives) sum += pow(L, -weibull_slope);
  return sum > T(0) ? T(pow(sum, -1 / weibull_slope)) : T(kInfinity);
}

}  // namespace

AxialFactors DeepGrooveFactors(double relative_axial_load) {
  const TablePosition<double> at = Locate(kRelativeAxialLoad, relative_axial_load);
  return {Interpolate(kE, at), kX, Interpolate(kY, at)};
}

double EquivalentDynamicLoad(const Bearing& bearing, double radial, double axial) {
  return DynamicLoad(bearing, radial, axial);
}

Taped EquivalentDynamicLoad(const Bearing& bearing, const Taped& radial, const Taped& axial) {
  return DynamicLoad(bearing, radial, axial);
}

double EquivalentStaticLoad(const Bearing& bearing, double radial, double axial) {
  if (bearing.kind == BearingKind::kCylindricalRoller) return radial;
  return std::max(radial, 0.6 * radial + 0.5 * axial);
}

double MeanEffectiveLoad(std::span<const double> loads, std::span<const double> revolutions,
                         double exponent) {
  return MeanLoad(loads, revolutions, exponent);
}

Taped MeanEffectiveLoad(std::span<const Taped> loads, std::span<const Taped> revolutions,
                        double exponent) {
  return MeanLoad(loads, revolutions, exponent);
}

double BasicRatingLife(double rating, double load, BearingKind kind) {
  return RatingLife(rating, load, kind);
}

Taped BasicRatingLife(double rating, const Taped& load, BearingKind kind) {
  return RatingLife(rating, load, kind);
}

double RequiredDynamicRating(double load, double life, BearingKind kind) {
  return load * std::pow(life, 1 / LifeExponent(kind));
}

double HoursOf(double life, double speed) {
  return Hours(life, speed);
}

Taped HoursOf(const Taped& life, const Taped& speed) {
  return Hours(life, speed);
}

double ReliabilityFactor(double reliability) {
  if (!(reliability >= kReliability.front() && reliability <= kReliability.back())) {
    throw std::invalid_argument(fmt::format("reliability is {} %, but must be {} .. {} %",
                                            reliability, kReliability.front(),
                                            kReliability.back()));
  }
  return Interpolate(kA1, Locate(kReliability, reliability));
}

Taped ReliabilityFactor(const Taped& reliability) {
  ReliabilityFactor(reliability.value);  // throws
  return Interpolate(kA1, Locate(kReliability, reliability));
}

double SystemLife(std::span<const double> lives, double weibull_slope) {
  return LifeTogether(lives, weibull_slope);
}

Taped SystemLife(std::span<const Taped> lives, double weibull_slope) {
  return LifeTogether(lives, weibull_slope);
}

}  // namespace vmech
