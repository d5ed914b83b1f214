#include "vmech/dynamics/bearings/bearing.h"

#include <algorithm>

#include <tuple>

namespace vmech {

std::string_view NameOf(BearingKind kind) {
  return kind == BearingKind::kDeepGrooveBall ? "deep_groove_ball" : "cylindrical_roller";
}

double LifeExponent(BearingKind kind) {
  return kind == BearingKind::kDeepGrooveBall ? 3.0 : 10.0 / 3.0;
}

double WeibullSlope(BearingKind kind) {
  return kind == BearingKind::kDeepGrooveBall ? 10.0 / 9.0 : 9.0 / 8.0;
}

double WeibullSlope(std::span<const BearingKind> kinds) {
  double flattest = WeibullSlope(BearingKind::kCylindricalRoller);
  for (BearingKind kind : kinds) flattest = std::min(flattest, WeibullSlope(kind));
  return flattest;
}

bool IsSmaller(const Bearing& a, const Bearing& b) {
  return std::forward_as_tuple(a.outer_diameter, a.width, b.dynamic_rating, a.designation) <
         std::forward_as_tuple(b.outer_diameter, b.width, a.dynamic_rating, b.designation);
}

}  // namespace vmech
