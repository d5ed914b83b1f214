#include "vmech/mechanisms/files/read_body.h"

#include <fmt/format.h>

#include <initializer_list>
#include <numbers>
#include <string_view>

namespace vmech {
namespace {

constexpr double kPi = std::numbers::pi;

enum class Shape { kNone, kBox, kCylinder, kTube, kCone, kSphere };

/// A body of mass 1: its volume, and the rest as of any body.
struct Solid {
  double volume = 1;
  Vector3d p_cm = Vector3d::Zero();
  Vector3d moments = Vector3d::Zero();  ///< about the centre of gravity, per mass [m^2]
};

Solid Box(const Vector3d& size) {
  const Vector3d squares = size.cwiseProduct(size);
  return {size.prod(), Vector3d::Zero(), (Vector3d::Constant(squares.sum()) - squares) / 12};
}

/// Without a hole if the inner radius is zero.
Solid Tube(double outer, double inner, double length) {
  const double squares = outer * outer + inner * inner;
  const double across = squares / 4 + length * length / 12;
  return {kPi * (outer - inner) * (outer + inner) * length,
          Vector3d::Zero(),
          {across, across, squares / 2}};
}

Solid Cone(double radius, double height) {
  const double across = 3.0 / 20 * radius * radius + 3.0 / 80 * height * height;
  return {kPi / 3 * radius * radius * height,
          Vector3d(0, 0, height / 4),
          {across, across, 0.3 * radius * radius}};
}

Solid Sphere(double radius) {
  return {4 * kPi / 3 * radius * radius * radius, Vector3d::Zero(),
          Vector3d::Constant(0.4 * radius * radius)};
}

/// Refuses lengths that the shape does not have, and asks for those that it has.
void CheckLengths(const Node& node, std::initializer_list<std::string_view> lengths) {
  for (const std::string_view key : {"size", "radius", "inner_radius", "length"}) {
    const bool used = std::find(lengths.begin(), lengths.end(), key) != lengths.end();
    if (used && !node[key]) node.KeyError(fmt::format("the key '{}' is missing", key));
    if (!used && node[key]) node[key].KeyError("this shape has no such length; leave it out");
  }
}

Solid ReadBox(const Node& node, const Units& units) {
  CheckLengths(node, {"size"});
  const Vector3d size = node["size"].Vector3(units.length, Vector3d::Ones());
  if (size.minCoeff() > 0) return Box(size);
  node["size"].Error("the three edges must be greater than zero");
  return {};
}

Solid ReadTube(const Node& node, const Units& units) {
  CheckLengths(node, {"radius", "inner_radius", "length"});
  const double outer = node["radius"].Positive(units.length, 2);
  const double inner = node["inner_radius"].Positive(units.length, 1);
  if (node["radius"] && node["inner_radius"] && !(inner < outer)) {
    node["inner_radius"].Error("must be less than 'radius'");
  }
  return Tube(outer, inner, node["length"].Positive(units.length, 1));
}

Solid ReadSolid(const Node& node, const Units& units, Shape shape) {
  const auto length = [&](const char* key) { return node[key].Positive(units.length, 1); };
  switch (shape) {
    case Shape::kBox:
      return ReadBox(node, units);
    case Shape::kTube:
      return ReadTube(node, units);
    case Shape::kCylinder:
      CheckLengths(node, {"radius", "length"});
      return Tube(length("radius"), 0, length("length"));
    case Shape::kCone:
      CheckLengths(node, {"radius", "length"});
      return Cone(length("radius"), length("length"));
    case Shape::kSphere:
      CheckLengths(node, {"radius"});
      return Sphere(length("radius"));
    default:
      return {};
  }
}

}  // namespace

BodyNumbers<double> ReadBody(const Node& node, const Units& units) {
  if (!node.CheckKeys({"shape"}, {"size", "radius", "inner_radius", "length", "density", "mass",
                                  "relative", "origin", "z", "x", "y", "dh"})) {
    return {};
  }
  const Shape shape = node["shape"].Word<Shape>({{"box", Shape::kBox},
                                                 {"cylinder", Shape::kCylinder},
                                                 {"tube", Shape::kTube},
                                                 {"cone", Shape::kCone},
                                                 {"sphere", Shape::kSphere}},
                                                Shape::kNone);
  const Node density = node["density"], mass = node["mass"];
  if (!density == !mass) node.KeyError("give either 'density' or 'mass'");
  const Solid solid = ReadSolid(node, units, shape);
  const double kilograms = density ? density.NonNegative(units.density, 1) * solid.volume
                                   : mass.NonNegative(units.mass, 1);
  const Vector3d moments = kilograms * solid.moments;
  return {kilograms, solid.p_cm, moments.asDiagonal()};
}

}  // namespace vmech
