#include "vmech/mechanisms/files/units.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <optional>

namespace vmech {
namespace {

/// A unit as a factor to SI and the powers of metre, kilogram, second and radian.
struct Unit {
  double factor = 1;
  int m = 0, kg = 0, s = 0, rad = 0;

  bool SameKind(const Unit& other) const {
    return m == other.m && kg == other.kg && s == other.s && rad == other.rad;
  }
};

struct Symbol {
  std::string_view name;
  Unit unit;
};

constexpr double kPi = std::numbers::pi;
constexpr double kPound = 0.45359237;         // [kg], exact
constexpr double kStandardGravity = 9.80665;  // [m/s^2], exact

constexpr Symbol kSymbols[] = {
    {"m", {1, 1}},
    {"km", {1e3, 1}},
    {"cm", {1e-2, 1}},
    {"mm", {1e-3, 1}},
    {"um", {1e-6, 1}},
    {"in", {0.0254, 1}},
    {"ft", {0.3048, 1}},
    {"rad", {1, 0, 0, 0, 1}},
    {"mrad", {1e-3, 0, 0, 0, 1}},
    {"deg", {kPi / 180, 0, 0, 0, 1}},
    {"rev", {2 * kPi, 0, 0, 0, 1}},
    {"kg", {1, 0, 1}},
    {"g", {1e-3, 0, 1}},
    {"mg", {1e-6, 0, 1}},
    {"t", {1e3, 0, 1}},
    {"lb", {kPound, 0, 1}},
    {"s", {1, 0, 0, 1}},
    {"ms", {1e-3, 0, 0, 1}},
    {"min", {60, 0, 0, 1}},
    {"h", {3600, 0, 0, 1}},
    {"N", {1, 1, 1, -2}},
    {"kN", {1e3, 1, 1, -2}},
    {"mN", {1e-3, 1, 1, -2}},
    {"lbf", {kPound * kStandardGravity, 1, 1, -2}},
    {"rpm", {2 * kPi / 60, 0, 0, -1, 1}},
};

/// One factor of a unit, as in "mm^2"; nothing if it is not known.
std::optional<Unit> ParseFactor(std::string_view text) {
  int power = 1;
  if (const size_t caret = text.find('^'); caret != text.npos) {
    const std::string_view digits = text.substr(caret + 1);
    if (digits.size() != 1 || digits[0] < '1' || digits[0] > '4') return {};
    power = digits[0] - '0';
    text = text.substr(0, caret);
  }
  for (const auto& [name, unit] : kSymbols) {
    if (name != text) continue;
    return Unit{std::pow(unit.factor, power), unit.m * power, unit.kg * power, unit.s * power,
                unit.rad * power};
  }
  return {};
}

/// A product of factors, kept apart by blanks or '*'.
std::optional<Unit> ParseProduct(std::string_view text) {
  constexpr std::string_view kBetween = " *";
  std::optional<Unit> product;
  while (true) {
    text.remove_prefix(std::min(text.find_first_not_of(kBetween), text.size()));
    if (text.empty()) return product;
    const size_t length = std::min(text.find_first_of(kBetween), text.size());
    const std::optional<Unit> factor = ParseFactor(text.substr(0, length));
    if (!factor) return {};
    const Unit so_far = product.value_or(Unit{});
    product = Unit{so_far.factor * factor->factor, so_far.m + factor->m, so_far.kg + factor->kg,
                   so_far.s + factor->s, so_far.rad + factor->rad};
    text.remove_prefix(length);
  }
}

/// "numerator" or "numerator/denominator".
std::optional<Unit> ParseUnit(std::string_view text) {
  const size_t slash = text.find('/');
  const std::optional<Unit> over = ParseProduct(text.substr(0, slash));
  if (!over || slash == text.npos) return over;
  const std::optional<Unit> under = ParseProduct(text.substr(slash + 1));
  if (!under) return {};
  return Unit{over->factor / under->factor, over->m - under->m, over->kg - under->kg,
              over->s - under->s, over->rad - under->rad};
}

/// The unit under a key, which must be of the same kind as the example.
double ReadUnit(const Node& units, std::string_view key, double fallback,
                std::string_view example) {
  const Node node = units[key];
  const std::string text = node.Text();
  if (text.empty() && node.kind() != Node::Kind::kScalar) return fallback;
  const std::optional<Unit> unit = ParseUnit(text);
  if (unit && unit->SameKind(*ParseUnit(example))) return unit->factor;
  node.Error(fmt::format("{} is not {} unit of {}; an example is '{}'", Quoted(text),
                         unit ? "a" : "a known", key, example));
  return fallback;
}

}  // namespace

Units ReadUnits(const Node& node) {
  Units units;
  if (!node ||
      !node.CheckKeys({}, {"length", "angle", "mass", "time", "velocity", "angular_velocity",
                           "acceleration", "inertia", "force", "torque", "stiffness",
                           "rotational_stiffness", "damping", "rotational_damping"})) {
    return units;
  }
  const auto read = [&](std::string_view key, double fallback, std::string_view example) {
    return ReadUnit(node, key, fallback, example);
  };
  units.length = read("length", 1, "mm");
  units.angle = read("angle", 1, "deg");
  units.mass = read("mass", 1, "kg");
  units.time = read("time", 1, "s");
  units.velocity = read("velocity", units.length / units.time, "mm/s");
  units.angular_velocity = read("angular_velocity", units.angle / units.time, "rpm");
  units.acceleration = read("acceleration", 1, "m/s^2");
  units.inertia = read("inertia", units.mass * units.length * units.length, "kg mm^2");
  units.force = read("force", 1, "N");
  units.torque = read("torque", 1, "N m");
  units.stiffness = read("stiffness", 1, "N/mm");
  units.rotational_stiffness = read("rotational_stiffness", 1, "N m/rad");
  units.damping = read("damping", 1, "N s/m");
  units.rotational_damping = read("rotational_damping", 1, "N m s/rad");
  return units;
}

DisplayUnits DisplayUnitsOf(const Node& node, const Units& units) {
  return {node["length"].Text("m"), node["angle"].Text("rad"), units.length, units.angle};
}

}  // namespace vmech
