#include "vmech/mechanisms/files/writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "vmech/mechanisms/files/document.h"
#include "vmech/mechanisms/files/flow_map.h"
#include "vmech/mechanisms/files/reader.h"
#include "vmech/mechanisms/files/units.h"
#include "vmech/mechanisms/freedoms.h"
#include "vmech/mechanisms/mass_properties.h"

namespace vmech {
namespace {

Units UnitsOf(FileUnits choice) {
  Units units;
  if (choice == FileUnits::kMetresRadians) return units;
  units.length.factor = 1e-3;
  units.angle.factor = std::numbers::pi / 180;
  units.inertia = units.mass * units.length * units.length;
  return units;
}

/// The shortest decimal that the reader takes for the figure; `to_si` is what the reader does with
/// a number of the file, `guess` the number that is asked for but for rounding.
std::string Decimal(double si, double guess, const std::function<double(double)>& to_si) {
  if (si == 0) return "0";
  if (!(std::abs(guess) <= kMaxNumber)) {
    throw std::invalid_argument(fmt::format("{} is not a number that a file can hold", si));
  }
  for (int digits = 1; digits <= 17; ++digits) {
    const double rounded = *ParseNumber(fmt::format("{:.{}g}", guess, digits));
    if (to_si(rounded) == si) return YamlNumber(rounded);
  }
  for (const double side : {-1e300, 1e300}) {
    const double beside = std::nextafter(guess, side);
    if (to_si(beside) == si) return YamlNumber(beside);
  }
  return YamlNumber(guess);
}

std::string Decimal(double si, double unit) {
  return Decimal(si, si / unit, [unit](double number) { return unit * number; });
}

template <typename Values>
std::string List(const Values& values, double unit) {
  std::vector<std::string> texts;
  for (const double value : values) texts.push_back(Decimal(value, unit));
  return fmt::format("[{}]", fmt::join(texts, ", "));
}

std::string List(const Vector3d& v, double unit) {
  return List(std::vector<double>{v[0], v[1], v[2]}, unit);
}

/// One value per freedom; `translation` and `rotation` are the unit of each kind.
std::string PerFreedom(const std::vector<double>& values, JointType type, double translation,
                       double rotation) {
  const std::vector<bool>& rotates = FreedomsOfType(type).rotates;
  std::vector<std::string> texts;
  for (size_t i = 0; i < values.size(); ++i) {
    texts.push_back(Decimal(values[i], rotates[i] ? rotation : translation));
  }
  return texts.size() == 1 ? texts[0] : fmt::format("[{}]", fmt::join(texts, ", "));
}

bool AnyDiffers(const std::vector<double>& values, double from) {
  return std::any_of(values.begin(), values.end(), [&](double value) { return value != from; });
}

void AddFrame(const Posed& X, const Units& units, FlowMap* map) {
  if (X.p != Vector3d::Zero()) map->Add("origin", List(X.p, units.length));
  if (X.R == Matrix3d::Identity()) return;
  map->Add("z", List(Vector3d(X.R.col(2)), 1));
  map->Add("x", List(Vector3d(X.R.col(0)), 1));
}

FlowMap InertiaMap(const MassProperties& properties, const Units& units) {
  FlowMap map;
  Matrix3d I = properties.I_Lcm;
  if (!InertiaDefect(I, I.cwiseAbs().maxCoeff()).empty()) {  // right but for rounding far from it
    I = InertiaAboutPoint(I, properties.mass, properties.p_LoLcm);
    map.Add("about", "origin");
  }
  for (const auto& [key, i, j] : {std::tuple{"xx", 0, 0}, {"yy", 1, 1}, {"zz", 2, 2}}) {
    map.Add(key, Decimal(I(i, j), units.inertia));
  }
  for (const auto& [key, i, j] : {std::tuple{"xy", 0, 1}, {"xz", 0, 2}, {"yz", 1, 2}}) {
    if (I(i, j) != 0) map.Add(key, Decimal(I(i, j), units.inertia));
  }
  return map;
}

std::string LinkText(const Link& link, const Units& units) {
  const MassProperties& properties = link.mass_properties;
  std::string text = fmt::format("  {}:\n", YamlWord(link.name));
  if (properties.mass != 0) {
    text += fmt::format("    mass: {}\n", Decimal(properties.mass, units.mass));
  }
  if (properties.p_LoLcm != Vector3d::Zero()) {
    text += fmt::format("    center_of_gravity: {}\n", List(properties.p_LoLcm, units.length));
  }
  if (properties.I_Lcm != Matrix3d::Zero()) {
    text += InertiaMap(properties, units).Line("    inertia: ");
  }
  if (link.anchors.empty()) return text + "    anchors: {}\n";
  std::vector<std::pair<std::string, FlowMap>> anchors;
  for (const Anchor& anchor : link.anchors) {
    AddFrame(anchor.X_LA, units, &anchors.emplace_back(anchor.name, FlowMap()).second);
  }
  return text + "    anchors:\n" + AlignedLines(anchors, 6);
}

std::string Limits(const Joint& joint, const Units& units) {
  const std::vector<bool>& rotates = FreedomsOfType(joint.type).rotates;
  std::vector<std::string> pairs;
  for (size_t i = 0; i < rotates.size(); ++i) {
    const double unit = rotates[i] ? units.angle : units.length;
    const auto bound = [&](double value) {
      return std::isinf(value) ? std::string("null") : Decimal(value, unit);
    };
    pairs.push_back(fmt::format("[{}, {}]", bound(joint.lower[i]), bound(joint.upper[i])));
    if (pairs[i] == "[null, null]") pairs[i] = "null";
  }
  if (pairs.size() == 1) return pairs[0] == "null" ? "" : pairs[0];
  const bool any = std::any_of(pairs.begin(), pairs.end(),
                               [](const std::string& pair) { return pair != "null"; });
  return any ? fmt::format("[{}]", fmt::join(pairs, ", ")) : "";
}

void AddPassive(const Joint& joint, const Units& units, FlowMap* map) {
  std::vector<double> stiffness, rest, viscous, coulomb;
  for (const Passive& passive : joint.passive) {
    stiffness.push_back(passive.stiffness);
    rest.push_back(passive.rest);
    viscous.push_back(passive.viscous);
    coulomb.push_back(passive.coulomb);
  }
  const auto each = [&](const std::vector<double>& values, double translation, double rotation) {
    return PerFreedom(values, joint.type, translation, rotation);
  };
  if (AnyDiffers(stiffness, 0) || AnyDiffers(rest, 0)) {
    FlowMap spring;
    spring.Add("stiffness", each(stiffness, units.stiffness, units.rotational_stiffness));
    if (AnyDiffers(rest, 0)) spring.Add("rest", each(rest, units.length, units.angle));
    map->Add("spring", spring.Text());
  }
  if (AnyDiffers(viscous, 0)) {
    map->Add("viscous", each(viscous, units.damping, units.rotational_damping));
  }
  if (AnyDiffers(coulomb, 0)) map->Add("coulomb", each(coulomb, units.force, units.torque));
}

void AddLoadFriction(const LoadFriction& friction, const Units& units, FlowMap* map) {
  const std::pair<const char*, double> lengths[] = {{"radius", friction.radius},
                                                    {"thrust_radius", friction.thrust_radius},
                                                    {"length", friction.length},
                                                    {"width", friction.width}};
  if (friction.coefficient == 0 && friction.radius == 0) return;
  FlowMap entry;
  entry.Add("coefficient", Decimal(friction.coefficient, 1));
  for (const auto& [key, length] : lengths) {
    if (length != 0) entry.Add(key, Decimal(length, units.length));
  }
  map->Add("friction", entry.Text());
}

std::string Stiffness(const Vector6d& stiffness, const Units& units) {
  std::vector<std::string> texts;
  for (int i = 0; i < 6; ++i) {
    texts.push_back(Decimal(stiffness[i], i < 3 ? units.stiffness : units.rotational_stiffness));
  }
  return fmt::format("[{}]", fmt::join(texts, ", "));
}

FlowMap JointMap(const Mechanism& mechanism, const Joint& joint, const Units& units) {
  constexpr double kTurn = 2 * std::numbers::pi;
  const auto end = [&](AnchorId id) {
    return YamlWord(mechanism.links[id.link].name + "/" + mechanism.anchor(id).name);
  };
  FlowMap map;
  map.Add("type", std::string(NameOf(joint.type)));
  map.Add("connects", fmt::format("[{}, {}]", end(joint.first), end(joint.second)));
  if (joint.type == JointType::kScrew) {
    const double per_turn = joint.pitch * kTurn / units.length;
    map.Add("pitch", Decimal(joint.pitch, per_turn,
                             [&](double pitch) { return units.length * pitch / kTurn; }));
  }
  if (joint.start_given || joint.start != ZeroCoordinates(joint.type)) {
    map.Add("start", joint.type == JointType::kSpherical
                         ? List(joint.start, 1)
                         : PerFreedom(joint.start, joint.type, units.length, units.angle));
  }
  if (const std::string limits = Limits(joint, units); !limits.empty()) map.Add("limits", limits);
  AddPassive(joint, units, &map);
  AddLoadFriction(joint.load_friction, units, &map);
  if (joint.stiffness) map.Add("stiffness", Stiffness(*joint.stiffness, units));
  return map;
}

FlowMap GraspMap(const Mechanism& mechanism, const Grasp& grasp, const Units& units) {
  FlowMap map;
  map.Add("link", YamlWord(mechanism.links[grasp.link].name));
  AddFrame(grasp.X_LG, units, &map);
  if (grasp.kind == GraspKind::kPoint) map.Add("kind", "point");
  return map;
}

std::string CommentLines(std::string_view comment) {
  std::string text;
  while (!comment.empty()) {
    const size_t end = std::min(comment.find('\n'), comment.size());
    text += end == 0 ? "#" : "# ";
    text += comment.substr(0, end);
    text += '\n';
    comment.remove_prefix(std::min(end + 1, comment.size()));
  }
  return text;
}

std::string Head(const Mechanism& mechanism, const WriterOptions& options) {
  const bool si = options.units == FileUnits::kMetresRadians;
  std::string text = CommentLines(options.comment);
  text += fmt::format("vmech: \"{}\"\nname: {}\n", kMechanismFormat, YamlWord(mechanism.name));
  text += si ? "units: {length: m, angle: rad}\n" : "units: {length: mm, angle: deg}\n";
  text += fmt::format("gravity: {}\n", List(mechanism.gravity_W, 1));
  return text + fmt::format("ground: {}\n", YamlWord(mechanism.links[mechanism.ground].name));
}

}  // namespace

std::string WriteMechanism(const Mechanism& mechanism, const WriterOptions& options) {
  const Units units = UnitsOf(options.units);
  std::string text = Head(mechanism, options) + "links:\n";
  for (const Link& link : mechanism.links) text += LinkText(link, units);
  std::vector<std::pair<std::string, FlowMap>> joints, grasps;
  for (const Joint& joint : mechanism.joints) {
    joints.emplace_back(joint.name, JointMap(mechanism, joint, units));
  }
  text += joints.empty() ? "joints: {}\n" : "joints:\n" + AlignedLines(joints, 2);
  for (const Grasp& grasp : mechanism.grasps) {
    grasps.emplace_back(grasp.name, GraspMap(mechanism, grasp, units));
  }
  if (!grasps.empty()) text += "grasps:\n" + AlignedLines(grasps, 2);
  if (mechanism.tolerance != Mechanism().tolerance) {
    text += fmt::format("tolerance: {}\n", Decimal(mechanism.tolerance, 1));
  }
  if (mechanism.preferred_cuts.empty()) return text;
  std::vector<std::string> cuts;
  for (const int joint : mechanism.preferred_cuts) {
    cuts.push_back(YamlWord(mechanism.joints[joint].name));
  }
  return text + fmt::format("cuts: [{}]\n", fmt::join(cuts, ", "));
}

}  // namespace vmech
