#include "vmech/mechanisms/plausibility.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>

#include "vmech/mechanisms/freedoms.h"
#include "vmech/mechanisms/mass_properties.h"

namespace vmech {
namespace {

using Doubts = std::vector<std::string>;

std::string LengthText(const DisplayUnits& units, double metres) {
  return fmt::format("{:.4g} {}", metres / units.metres, units.length);
}

/// The largest distance among a link's anchors and centre of gravity [m].
double Reach(const Link& link) {
  std::vector<Vector3d> points;
  for (const Anchor& anchor : link.anchors) points.push_back(anchor.X_LA.p);
  if (link.mass_properties.mass > 0) points.push_back(link.mass_properties.p_LoLcm);
  double reach = 0;
  for (size_t a = 0; a < points.size(); ++a) {
    for (size_t b = 0; b < a; ++b) reach = std::max(reach, (points[a] - points[b]).norm());
  }
  return reach;
}

/// Inertias in the wrong unit are off by 1e3 (g, t) or 1e6 (mm^2), radii of gyration by their
/// roots. A moment of zero is a point mass, and meant.
void DoubtGyration(const DisplayUnits& units, const Link& link, Doubts* doubts) {
  constexpr double kFar = 4, kNear = 1e-2;
  const MassProperties& body = link.mass_properties;
  const double reach = Reach(link);
  const double largest = PrincipalMoments(body.I_Lcm)[2];
  if (!(body.mass > 0) || !(largest > 0) || reach == 0) return;
  const double radius = std::sqrt(largest / body.mass);
  if (radius > kNear * reach && radius < kFar * reach) return;
  doubts->push_back(fmt::format(
      "link '{}': its radius of gyration is {}, its anchors and centre of gravity lie within {}; "
      "check the units of `inertia` and `mass`",
      link.name, LengthText(units, radius), LengthText(units, reach)));
}

/// Of the longest link, and of the shortest that has a length.
void DoubtSize(const Mechanism& mechanism, Doubts* doubts) {
  constexpr double kLong = 10, kShort = 1e-4;  // [m]
  const auto doubt = [&](const Link& link, double reach, std::string_view which) {
    doubts->push_back(fmt::format(
        "the {} link, '{}', is {:.4g} m long (its figures are read in {}); check `units: {{length: "
        "...}}`",
        which, link.name, reach, mechanism.units.length));
  };
  const Link *longest = nullptr, *shortest = nullptr;
  double most = 0, least = 0;
  for (const Link& link : mechanism.links) {
    const double reach = Reach(link);
    if (reach == 0) continue;
    if (!longest || reach > most) longest = &link, most = reach;
    if (!shortest || reach < least) shortest = &link, least = reach;
  }
  if (longest && most > kLong) doubt(*longest, most, "longest");
  if (shortest && least < kShort) doubt(*shortest, least, "shortest");
}

void DoubtGravity(const Mechanism& mechanism, Doubts* doubts) {
  constexpr double kStrong = 30, kWeak = 0.1;  // [m/s^2]
  const double g = mechanism.gravity_W.norm();
  if (g == 0 || (g > kWeak && g < kStrong)) return;
  doubts->push_back(fmt::format(
      "gravity is {:.6g} m/s^2, on earth it is 9.81; `gravity` is in m/s^2 whatever the unit of "
      "lengths, unless `units: {{acceleration: ...}}` says otherwise",
      g));
}

bool HasMass(const Mechanism& mechanism) {
  for (size_t i = 0; i < mechanism.links.size(); ++i) {
    if (static_cast<int>(i) == mechanism.ground) continue;
    if (mechanism.links[i].mass_properties.mass > 0) return true;
  }
  return false;
}

/// Spherical joints start at a quaternion, which has no turns.
void DoubtStart(const DisplayUnits& units, const Joint& joint, Doubts* doubts) {
  constexpr double kTurn = 2 * std::numbers::pi * (1 + 1e-9);
  if (joint.type == JointType::kSpherical) return;
  const Freedoms& freedoms = FreedomsOfType(joint.type);
  for (int k = 0; k < FreedomsOf(joint.type); ++k) {
    if (!freedoms.rotates[k] || std::abs(joint.start[k]) <= kTurn) continue;
    doubts->push_back(
        fmt::format("joint '{}' starts at {}, {:.3g} turns; check `units: {{angle: "
                    "...}}`, or take the whole turns off",
                    joint.name, FormatCoordinate(units, joint, k, joint.start[k]),
                    joint.start[k] / (2 * std::numbers::pi)));
  }
}

}  // namespace

std::vector<std::string> DoubtsOf(const Mechanism& mechanism, bool loaded) {
  Doubts doubts;
  for (size_t i = 0; i < mechanism.links.size(); ++i) {
    if (static_cast<int>(i) == mechanism.ground) continue;
    DoubtGyration(mechanism.units, mechanism.links[i], &doubts);
  }
  DoubtSize(mechanism, &doubts);
  DoubtGravity(mechanism, &doubts);
  if (!loaded && !HasMass(mechanism)) {
    doubts.push_back(
        "no link that moves has a mass: there are no weights and no inertia forces; give `mass` "
        "and `inertia`");
  }
  for (const Joint& joint : mechanism.joints) DoubtStart(mechanism.units, joint, &doubts);
  return doubts;
}

std::vector<std::string> DoubtsOfDensity(const std::string& part, double density) {
  constexpr double kFoam = 10, kOsmium = 22600;  // [kg/m^3]
  if (density >= kFoam && density <= kOsmium) return {};
  return {fmt::format(
      "{}: its density is {:.6g} kg/m^3; steel has 7850, aluminium 2700, plastics about 1000. "
      "Densities are in kg/m^3, 1000 times those in g/cm^3",
      part, density)};
}

}  // namespace vmech
