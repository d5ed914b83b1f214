#include "vmech/mechanisms/validity.h"

#include <fmt/format.h>

#include <cmath>
#include <set>
#include <stdexcept>
#include <string>

#include "vmech/mechanisms/mass_properties.h"

namespace vmech {
namespace {

[[noreturn]] void Refuse(std::string_view field, const std::string& defect) {
  throw std::invalid_argument(fmt::format("{}{}", field, defect));
}

/// NaN is in no range.
void RequireRange(std::string_view field, double value, double low, double high,
                  std::string_view range) {
  if (value >= low && value <= high) return;
  Refuse(field, fmt::format(" = {}, must be {}", value, range));
}

void RequireFinitePoint(std::string_view field, const Vector3d& p) {
  if (p.allFinite()) return;
  Refuse(field, fmt::format(" = ({}, {}, {}), must be finite", p[0], p[1], p[2]));
}

void RequireLength(std::string_view field, size_t length, int wanted) {
  if (length == static_cast<size_t>(wanted)) return;
  Refuse(field, fmt::format(" has {} entries, must have {} (MakeJoint gives lists of the right "
                            "lengths)",
                            length, wanted));
}

void RequirePose(const std::string& field, const Posed& X) {
  constexpr double kSquare = 1e-9;
  RequireFinitePoint(field + ".p", X.p);
  const double defect = (X.R.transpose() * X.R - Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(defect < kSquare) || !(X.R.determinant() > 0)) {
    Refuse(field, fmt::format(".R is no rotation: R'R is off the identity by {:.2g}, and its "
                              "determinant is {:.2g}; make it with AxesFromZX",
                              defect, X.R.determinant()));
  }
}

template <typename Item>
void RequireDistinctNames(std::string_view list, const std::vector<Item>& items) {
  std::set<std::string_view> names;
  for (const Item& item : items) {
    if (item.name.empty() || names.insert(item.name).second) continue;
    Refuse(list, fmt::format(" has two items of the name '{}'; give each its own", item.name));
  }
}

void RequireMassProperties(const std::string& link, const MassProperties& body) {
  constexpr double kRounding = 1e-3;  // of figures that are published with three digits
  RequireNonNegative(link + ".mass_properties.mass", body.mass);
  RequireFinitePoint(link + ".mass_properties.p_LoLcm", body.p_LoLcm);
  const Matrix3d& I = body.I_Lcm;
  const std::string field = link + ".mass_properties.I_Lcm";
  if (!I.allFinite()) Refuse(field, " holds values that are not finite");
  const double scale = I.cwiseAbs().maxCoeff() + body.mass * body.p_LoLcm.squaredNorm();
  if ((I - I.transpose()).cwiseAbs().maxCoeff() > 1e-9 * scale) {
    Refuse(field, " is not symmetric; make it with InertiaFromElements");
  }
  const Vector3d moments = PrincipalMoments(I);
  if (moments[0] >= -kRounding * scale) return;
  Refuse(field,
         fmt::format(" is not positive definite: principal moments {:.6g}, {:.6g}, {:.6g} "
                     "kg m^2; it is about the centre of gravity (InertiaAboutCenterOfGravity)",
                     moments[0], moments[1], moments[2]));
}

void RequireLink(const std::string& name, const Link& link) {
  RequireMassProperties(name, link.mass_properties);
  RequireDistinctNames(name + ".anchors", link.anchors);
  for (size_t i = 0; i < link.anchors.size(); ++i) {
    RequirePose(fmt::format("{}.anchors[{}] '{}'.X_LA", name, i, link.anchors[i].name),
                link.anchors[i].X_LA);
  }
}

void RequireAnchor(const std::string& field, const Mechanism& mechanism, AnchorId id) {
  RequireIndex(field + ".link", id.link, mechanism.links.size());
  RequireIndex(field + ".anchor", id.anchor, mechanism.links[id.link].anchors.size());
}

void RequireStart(const std::string& field, const Joint& joint) {
  constexpr double kUnit = 1e-6;
  RequireLength(field, joint.start.size(), CoordinatesOf(joint.type));
  double squares = 0;
  for (double value : joint.start) RequireFinite(field, value), squares += value * value;
  if (joint.type == JointType::kSpherical && std::abs(squares - 1) > kUnit) {
    Refuse(field, fmt::format(" is a quaternion of length {:.9g}, must be 1", std::sqrt(squares)));
  }
}

void RequireLimits(const std::string& joint_name, const Joint& joint) {
  const int f = FreedomsOf(joint.type);
  RequireLength(joint_name + ".lower", joint.lower.size(), f);
  RequireLength(joint_name + ".upper", joint.upper.size(), f);
  for (int k = 0; k < f; ++k) {
    if (joint.lower[k] <= joint.upper[k]) continue;
    Refuse(joint_name, fmt::format(": lower[{0}] = {1} and upper[{0}] = {2} leave no value", k,
                                   joint.lower[k], joint.upper[k]));
  }
}

void RequirePassive(const std::string& name, const Joint& joint) {
  RequireLength(name + ".passive", joint.passive.size(), FreedomsOf(joint.type));
  for (size_t k = 0; k < joint.passive.size(); ++k) {
    const Passive& passive = joint.passive[k];
    const std::string field = fmt::format("{}.passive[{}]", name, k);
    RequireNonNegative(field + ".stiffness", passive.stiffness);
    RequireFinite(field + ".rest", passive.rest);
    RequireNonNegative(field + ".viscous", passive.viscous);
    RequireNonNegative(field + ".coulomb", passive.coulomb);
  }
  const LoadFriction& friction = joint.load_friction;
  const std::string field = name + ".load_friction";
  RequireNonNegative(field + ".coefficient", friction.coefficient);
  RequireNonNegative(field + ".radius", friction.radius);
  RequireNonNegative(field + ".thrust_radius", friction.thrust_radius);
  RequireNonNegative(field + ".length", friction.length);
  RequireNonNegative(field + ".width", friction.width);
  if (!joint.stiffness) return;
  for (double k : *joint.stiffness) RequireNonNegative(name + ".stiffness", k);
}

void RequireJoint(const std::string& name, const Mechanism& mechanism, const Joint& joint) {
  const int type = static_cast<int>(joint.type);
  RequireRange(name + ".type", type, 0, static_cast<int>(JointType::kWeld), "a JointType");
  RequireAnchor(name + ".first", mechanism, joint.first);
  RequireAnchor(name + ".second", mechanism, joint.second);
  if (joint.first.link == joint.second.link) {
    Refuse(name, fmt::format(" joins link '{}' with itself; a joint needs two links",
                             mechanism.links[joint.first.link].name));
  }
  RequireFinite(name + ".pitch", joint.pitch);
  RequireStart(name + ".start", joint);
  RequireLimits(name, joint);
  RequirePassive(name, joint);
}

template <typename Item>
std::string NameOfItem(std::string_view list, size_t i, const Item& item) {
  return fmt::format("{}[{}] '{}'", list, i, item.name);
}

void RequireGrasps(const Mechanism& mechanism) {
  for (size_t i = 0; i < mechanism.grasps.size(); ++i) {
    const Grasp& grasp = mechanism.grasps[i];
    const std::string name = NameOfItem("grasps", i, grasp);
    RequireIndex(name + ".link", grasp.link, mechanism.links.size());
    RequirePose(name + ".X_LG", grasp.X_LG);
  }
}

}  // namespace

void RequireFinite(std::string_view field, double value) {
  if (!std::isfinite(value)) Refuse(field, fmt::format(" = {}, must be a finite number", value));
}

void RequireNonNegative(std::string_view field, double value) {
  RequireRange(field, value, 0, std::numeric_limits<double>::max(), "finite and not negative");
}

void RequireIndex(std::string_view field, int index, size_t count) {
  if (index >= 0 && static_cast<size_t>(index) < count) return;
  Refuse(field,
         fmt::format(" = {}, but there {}; indices begin at 0, and -1 stands for a name "
                     "that is not there",
                     index, count == 1 ? std::string("is 1") : fmt::format("are {}", count)));
}

void RequireValid(const Mechanism& mechanism) {
  RequireFinitePoint("gravity_W", mechanism.gravity_W);
  RequireIndex("ground", mechanism.ground, mechanism.links.size());
  RequireRange("tolerance", mechanism.tolerance, 0, kWidestTolerance,
               fmt::format("in [0, {}]", kWidestTolerance));
  RequireDistinctNames("links", mechanism.links);
  RequireDistinctNames("joints", mechanism.joints);
  RequireDistinctNames("grasps", mechanism.grasps);
  for (size_t i = 0; i < mechanism.links.size(); ++i) {
    RequireLink(NameOfItem("links", i, mechanism.links[i]), mechanism.links[i]);
  }
  for (size_t i = 0; i < mechanism.joints.size(); ++i) {
    RequireJoint(NameOfItem("joints", i, mechanism.joints[i]), mechanism, mechanism.joints[i]);
  }
  RequireGrasps(mechanism);
  for (int cut : mechanism.preferred_cuts) {
    RequireIndex("preferred_cuts", cut, mechanism.joints.size());
  }
}

}  // namespace vmech
