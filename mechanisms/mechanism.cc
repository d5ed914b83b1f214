#include "vmech/mechanisms/mechanism.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "vmech/mechanisms/direction.h"
#include "vmech/mechanisms/freedoms.h"

namespace vmech {
namespace {

template <typename Item>
int FindByName(const std::vector<Item>& items, std::string_view name) {
  for (size_t i = 0; i < items.size(); ++i) {
    if (items[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

}  // namespace

bool HasPassive(const Passive& passive) {
  return passive.stiffness != 0 || passive.viscous != 0 || passive.coulomb != 0;
}

int FindLink(const Mechanism& mechanism, std::string_view name) {
  return FindByName(mechanism.links, name);
}

int FindJoint(const Mechanism& mechanism, std::string_view name) {
  return FindByName(mechanism.joints, name);
}

int FindGrasp(const Mechanism& mechanism, std::string_view name) {
  return FindByName(mechanism.grasps, name);
}

std::string NameOfFreedom(const Joint& joint, int freedom) {
  if (FreedomsOf(joint.type) < 2) return joint.name;
  return joint.name + "." + NameOfFreedom(joint.type, freedom);
}

Matrix3d AxesFromZX(const Vector3d& z, const Vector3d& x) {
  constexpr double kParallel =
      1e-6;                         // sine of the angle below which x says nothing about the frame
  constexpr double kExact = 4e-15;  // defect of axes that cannot be made more square
  const Vector3d z_near = NearUnitLength(z), x_near = NearUnitLength(x);
  if (!(z_near.norm() > 0)) throw std::invalid_argument("the z axis has no length");
  const Vector3d z_unit = z_near.normalized();
  const Vector3d x_across = x_near - z_unit * z_unit.dot(x_near);
  if (!(x_across.norm() > kParallel * x_near.norm())) {
    throw std::invalid_argument("the x axis is parallel to the z axis, or has no length");
  }
  const bool orthonormal = std::abs(z.squaredNorm() - 1) < kExact &&
                           std::abs(x.squaredNorm() - 1) < kExact && std::abs(z.dot(x)) < kExact;
  Matrix3d R;
  R.col(2) = orthonormal ? z : z_unit;
  R.col(0) = orthonormal ? x : (x_across - z_unit * z_unit.dot(x_across)).normalized();
  R.col(1) = R.col(2).cross(R.col(0));
  return R;
}

double CharacteristicLength(const Mechanism& mechanism) {
  double sum = 0;
  int count = 0;
  for (size_t i = 0; i < mechanism.links.size(); ++i) {
    if (static_cast<int>(i) == mechanism.ground) continue;
    const Link& link = mechanism.links[i];
    std::vector<Vector3d> points{link.mass_properties.p_LoLcm};
    for (const Anchor& anchor : link.anchors) points.push_back(anchor.X_LA.p);
    for (size_t a = 0; a < points.size(); ++a) {
      for (size_t b = 0; b < a; ++b) {
        sum += (points[a] - points[b]).norm();
        ++count;
      }
    }
  }
  return sum > 0 ? sum / count : 1.0;
}

std::string FormatCoordinate(const DisplayUnits& units, const Joint& joint, int freedom,
                             double value) {
  return FreedomsOfType(joint.type).rotates[freedom]
             ? fmt::format("{:.6g} {}", value / units.radians, units.angle)
             : fmt::format("{:.6g} {}", value / units.metres, units.length);
}

std::vector<double> ZeroCoordinates(JointType type) {
  std::vector<double> zero(CoordinatesOf(type), 0.0);
  if (type == JointType::kSpherical) zero[0] = 1;
  return zero;
}

Joint MakeJoint(std::string name, JointType type, AnchorId first, AnchorId second) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const int f = FreedomsOf(type);
  Joint joint;
  joint.name = std::move(name);
  joint.type = type;
  joint.first = first;
  joint.second = second;
  joint.start = ZeroCoordinates(type);
  joint.lower.assign(f, -kInfinity);
  joint.upper.assign(f, kInfinity);
  joint.passive.assign(f, Passive{});
  return joint;
}

}  // namespace vmech
