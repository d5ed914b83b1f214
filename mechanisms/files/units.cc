#include "vmech/mechanisms/files/units.h"

#include <fmt/format.h>

#include <optional>
#include <string>
#include <string_view>

namespace vmech {
namespace {

/// The unit under a key, which must be of the same kind as the example.
Unit ReadUnit(const Node& units, std::string_view key, const Unit& fallback,
              std::string_view example) {
  const Node node = units[key];
  const std::string text = node.Text();
  if (text.empty() && node.kind() != Node::Kind::kScalar) return fallback;
  const std::optional<Unit> unit = ParseUnit(text);
  if (unit && unit->dimension == fallback.dimension) return *unit;
  node.Error(fmt::format("{} is not {} unit of {}; an example is '{}'", Quoted(text),
                         unit ? "a" : "a known", key, example));
  return fallback;
}

}  // namespace

Units ReadUnits(const Node& node) {
  Units units;
  if (!node ||
      !node.CheckKeys({}, {"length", "angle", "mass", "time", "velocity", "angular_velocity",
                           "acceleration", "inertia", "density", "force", "torque", "stiffness",
                           "rotational_stiffness", "damping", "rotational_damping"})) {
    return units;
  }
  const auto read = [&](std::string_view key, const Unit& fallback, std::string_view example) {
    return ReadUnit(node, key, fallback, example);
  };
  units.length = read("length", units.length, "mm");
  units.angle = read("angle", units.angle, "deg");
  units.mass = read("mass", units.mass, "kg");
  units.time = read("time", units.time, "s");
  units.velocity = read("velocity", units.length / units.time, "mm/s");
  units.angular_velocity = read("angular_velocity", units.angle / units.time, "rpm");
  units.acceleration = read("acceleration", units.acceleration, "m/s^2");
  units.inertia = read("inertia", units.mass * units.length * units.length, "kg mm^2");
  units.density = read("density", units.density, "kg/m^3");
  units.force = read("force", units.force, "N");
  units.torque = read("torque", units.torque, "N m");
  units.stiffness = read("stiffness", units.stiffness, "N/mm");
  units.rotational_stiffness = read("rotational_stiffness", units.rotational_stiffness, "N m/rad");
  units.damping = read("damping", units.damping, "N s/m");
  units.rotational_damping = read("rotational_damping", units.rotational_damping, "N m s/rad");
  return units;
}

CountingUnits Units::counting() const {
  return {length,
          angle,
          mass,
          time,
          {velocity, angular_velocity, acceleration, inertia, density, force, torque, stiffness,
           rotational_stiffness, damping, rotational_damping}};
}

std::array<Unit, 6> SixUnits(const Unit& along, const Unit& about) {
  return {along, along, along, about, about, about};
}

DisplayUnits DisplayUnitsOf(const Node& node, const Units& units) {
  return {node["length"].Text("m"), node["angle"].Text("rad"), units.length, units.angle};
}

}  // namespace vmech
