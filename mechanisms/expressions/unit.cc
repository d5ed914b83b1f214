#include "vmech/mechanisms/expressions/unit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>
#include <vector>

namespace vmech {
namespace {

struct Symbol {
  std::string_view name;
  Unit unit;
};

constexpr double kPi = std::numbers::pi;
constexpr double kPound = 0.45359237;         // [kg], exact
constexpr double kStandardGravity = 9.80665;  // [m/s^2], exact

constexpr Dimension kLength{1}, kMass{0, 1}, kTime{0, 0, 1}, kAngle{0, 0, 0, 1};
constexpr Dimension kForce{1, 1, -2}, kAngularVelocity{0, 0, -1, 1};

constexpr Symbol kSymbols[] = {
    {"m", {1, kLength}},
    {"km", {1e3, kLength}},
    {"cm", {1e-2, kLength}},
    {"mm", {1e-3, kLength}},
    {"um", {1e-6, kLength}},
    {"in", {0.0254, kLength}},
    {"ft", {0.3048, kLength}},
    {"rad", {1, kAngle}},
    {"mrad", {1e-3, kAngle}},
    {"deg", {kPi / 180, kAngle}},
    {"rev", {2 * kPi, kAngle}},
    {"kg", {1, kMass}},
    {"g", {1e-3, kMass}},
    {"mg", {1e-6, kMass}},
    {"t", {1e3, kMass}},
    {"lb", {kPound, kMass}},
    {"s", {1, kTime}},
    {"ms", {1e-3, kTime}},
    {"min", {60, kTime}},
    {"h", {3600, kTime}},
    {"N", {1, kForce}},
    {"kN", {1e3, kForce}},
    {"mN", {1e-3, kForce}},
    {"lbf", {kPound * kStandardGravity, kForce}},
    {"rpm", {2 * kPi / 60, kAngularVelocity}},
};

struct Kind {
  std::string_view name;
  Dimension dimension;
};

constexpr Kind kKinds[] = {
    {"number", {}},
    {"length", kLength},
    {"angle", kAngle},
    {"mass", kMass},
    {"time", kTime},
    {"velocity", {1, 0, -1}},
    {"angular velocity", kAngularVelocity},
    {"acceleration", {1, 0, -2}},
    {"moment of inertia", {2, 1}},
    {"force", kForce},
    {"torque", {2, 1, -2}},
    {"stiffness", {0, 1, -2}},
    {"rotational stiffness", {2, 1, -2, -1}},
    {"damping", {0, 1, -1}},
    {"rotational damping", {2, 1, -1, -1}},
    {"area", {2}},
    {"volume", {3}},
    {"density", {-3, 1}},
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
  const std::optional<Unit> unit = FindUnit(text);
  return unit ? unit->Power(power) : unit;
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
    product = product.value_or(Unit{}) * *factor;
    text.remove_prefix(length);
  }
}

/// "m^2 kg/s": powers of names, those below zero behind a stroke.
std::string Product(const std::vector<std::pair<std::string_view, double>>& powers) {
  std::string over, under;
  for (const auto& [name, power] : powers) {
    if (power == 0) continue;
    std::string& side = power > 0 ? over : under;
    if (!side.empty()) side += ' ';
    side += name;
    if (std::abs(power) != 1) side += fmt::format("^{:g}", std::abs(power));
  }
  if (over.empty()) over = "1";
  return under.empty() ? over : over + "/" + under;
}

}  // namespace

Dimension Dimension::Power(double exponent) const {
  return {length * exponent, mass * exponent, time * exponent, angle * exponent};
}

Dimension operator*(const Dimension& a, const Dimension& b) {
  return {a.length + b.length, a.mass + b.mass, a.time + b.time, a.angle + b.angle};
}

Dimension operator/(const Dimension& a, const Dimension& b) {
  return a * b.Power(-1);
}

bool operator==(const Dimension& a, const Dimension& b) {
  constexpr double kRounding = 1e-9;  // of powers such as 1/3 and 2/3
  const auto same = [](double x, double y) { return std::abs(x - y) < kRounding; };
  return same(a.length, b.length) && same(a.mass, b.mass) && same(a.time, b.time) &&
         same(a.angle, b.angle);
}

std::string NameOf(const Dimension& dimension) {
  for (const auto& [name, known] : kKinds) {
    if (known == dimension) return std::string(name);
  }
  return Product({{"length", dimension.length},
                  {"mass", dimension.mass},
                  {"time", dimension.time},
                  {"angle", dimension.angle}});
}

std::string OneOf(const Dimension& dimension) {
  const std::string name = NameOf(dimension);
  return (name[0] == 'a' ? "an " : "a ") + name;
}

Unit Unit::Power(double exponent) const {
  return {std::pow(factor, exponent), dimension.Power(exponent)};
}

std::optional<Unit> FindUnit(std::string_view symbol) {
  const auto* const found = std::find_if(std::begin(kSymbols), std::end(kSymbols),
                                         [&](const Symbol& s) { return s.name == symbol; });
  return found == std::end(kSymbols) ? std::nullopt : std::optional(found->unit);
}

std::optional<Unit> ParseUnit(std::string_view text) {
  const size_t slash = text.find('/');
  const std::optional<Unit> over = ParseProduct(text.substr(0, slash));
  if (!over || slash == text.npos) return over;
  const std::optional<Unit> under = ParseProduct(text.substr(slash + 1));
  if (!under) return {};
  return *over / *under;
}

NamedUnit NameOf(const Unit& unit) {
  if (unit.dimension.none()) return {"", unit.factor};
  for (const auto& [name, known] : kSymbols) {
    if (known.dimension == unit.dimension && known.factor == unit.factor) {
      return {std::string(name), 1};
    }
  }
  const Dimension& d = unit.dimension;
  return {Product({{"kg", d.mass}, {"m", d.length}, {"rad", d.angle}, {"s", d.time}}), unit.factor};
}

}  // namespace vmech
