#include "vmech/mechanisms/files/read_joint.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <numbers>

#include "vmech/mechanisms/freedoms.h"

namespace vmech {
namespace {

/// Does something with every entry of a map whose keys are names of freedoms, and its index.
template <typename Use>
void ForEachFreedom(const Node& map, JointType type, Use use) {
  for (const Node& entry : map.Map()) {
    const int freedom = FindFreedom(type, entry.key());
    if (freedom >= 0) {
      use(entry, freedom);
    } else {
      entry.KeyError(fmt::format("there is no freedom {}: a {} joint has {}", Quoted(entry.key()),
                                 NameOf(type), fmt::join(NamesOfFreedoms(type), ", ")));
    }
  }
}

/// A value per freedom, in SI: `translation` and `rotation` are the unit of each kind. A list, or a
/// map by the names of freedoms, where others are zero. Empty if the node is absent or wrong.
std::vector<double> PerFreedom(const Node& node, JointType type, const Unit& translation,
                               const Unit& rotation) {
  std::vector<Unit> units;
  for (const bool rotates : FreedomsOfType(type).rotates) {
    units.push_back(rotates ? rotation : translation);
  }
  if (node.kind() != Node::Kind::kMap) return node.Numbers(units);
  std::vector<double> values(units.size(), 0.0);
  ForEachFreedom(node, type, [&](const Node& entry, int k) { values[k] = entry.Number(units[k]); });
  return values;
}

/// The same for values that are not negative.
std::vector<double> PerFreedomNonNegative(const Node& node, JointType type, const Unit& translation,
                                          const Unit& rotation) {
  std::vector<double> values = PerFreedom(node, type, translation, rotation);
  for (double& value : values) {
    if (value >= 0) continue;
    node.Error("must not be negative");
    value = 0;
  }
  return values;
}

/// A spherical joint starts at a rotation vector (3 numbers) or a quaternion w, x, y, z (4).
std::vector<double> ReadSphericalStart(const Node& node, const Units& units) {
  if (node.kind() == Node::Kind::kList && node.List().size() == 4) {
    const std::vector<double> wxyz = node.Numbers(4);
    Eigen::Vector4d q(wxyz[0], wxyz[1], wxyz[2], wxyz[3]);
    constexpr double kRounded = 1e-3, kExact = 4e-15;  // off a length of 1
    if (std::abs(q.norm() - 1) > kRounded) {
      node.Error(fmt::format("a quaternion w, x, y, z has length 1, not {:.6g}", q.norm()));
      return ZeroCoordinates(JointType::kSpherical);
    }
    if (std::abs(q.norm() - 1) > kExact) q.normalize();
    return {q[0], q[1], q[2], q[3]};
  }
  const Vector3d rotation = node.Vector3(units.angle);
  const double angle = rotation.norm();
  if (angle == 0) return ZeroCoordinates(JointType::kSpherical);
  const Vector3d xyz = std::sin(angle / 2) / angle * rotation;
  return {std::cos(angle / 2), xyz[0], xyz[1], xyz[2]};
}

void ReadStart(const Node& node, const Units& units, Joint* joint) {
  if (!node) return;
  joint->start_given = true;
  if (joint->type == JointType::kSpherical) {
    joint->start = ReadSphericalStart(node, units);
    return;
  }
  const std::vector<double> start = PerFreedom(node, joint->type, units.length, units.angle);
  if (!start.empty()) joint->start = start;
}

/// One pair [lower, upper]; null where there is no limit.
void ReadLimitPair(const Node& node, const Unit& unit, double* lower, double* upper) {
  const std::vector<Node> pair = node.List();
  if (pair.size() != 2) {
    if (node.kind() == Node::Kind::kList) node.Error("expected a pair [lower, upper]");
    return;
  }
  double bounds[] = {*lower, *upper};
  for (int i = 0; i < 2; ++i) {
    if (pair[i].kind() != Node::Kind::kNull) bounds[i] = pair[i].Number(unit);
  }
  if (!(bounds[0] < bounds[1])) {
    node.Error("the lower limit is not below the upper one");
    return;
  }
  *lower = bounds[0];
  *upper = bounds[1];
}

/// [lower, upper], or for several freedoms a list of such pairs or a map of them by names.
void ReadLimits(const Node& node, const Units& units, Joint* joint) {
  if (!node) return;
  const std::vector<bool>& rotates = FreedomsOfType(joint->type).rotates;
  const auto read = [&](const Node& pair, int k) {
    if (pair.kind() == Node::Kind::kNull) return;
    ReadLimitPair(pair, rotates[k] ? units.angle : units.length, &joint->lower[k],
                  &joint->upper[k]);
  };
  if (node.kind() == Node::Kind::kMap) return ForEachFreedom(node, joint->type, read);
  std::vector<Node> pairs{node};
  if (rotates.size() > 1) pairs = node.List();
  if (pairs.size() != rotates.size()) {
    node.Error(
        fmt::format("expected {} pairs [lower, upper], one for each freedom", rotates.size()));
    return;
  }
  for (size_t i = 0; i < pairs.size(); ++i) read(pairs[i], static_cast<int>(i));
}

void CheckStartWithinLimits(const Node& start, const Joint& joint) {
  if (joint.type == JointType::kSpherical) return;
  for (size_t i = 0; i < joint.start.size(); ++i) {
    if (joint.start[i] >= joint.lower[i] && joint.start[i] <= joint.upper[i]) continue;
    start.Error("the start is outside the limits of the joint");
  }
}

/// Springs and friction: one number for each freedom.
void ReadPassive(const Node& node, const Units& units, Joint* joint) {
  const JointType type = joint->type;
  const Node spring = node["spring"];
  if (spring) spring.CheckKeys({"stiffness"}, {"rest"});
  const auto stiffness =
      PerFreedomNonNegative(spring["stiffness"], type, units.stiffness, units.rotational_stiffness);
  const auto rest = PerFreedom(spring["rest"], type, units.length, units.angle);
  const auto viscous =
      PerFreedomNonNegative(node["viscous"], type, units.damping, units.rotational_damping);
  const auto coulomb = PerFreedomNonNegative(node["coulomb"], type, units.force, units.torque);
  for (size_t i = 0; i < joint->passive.size(); ++i) {
    Passive& passive = joint->passive[i];
    if (!stiffness.empty()) passive.stiffness = stiffness[i];
    if (!rest.empty()) passive.rest = rest[i];
    if (!viscous.empty()) passive.viscous = viscous[i];
    if (!coulomb.empty()) passive.coulomb = coulomb[i];
  }
}

/// A length on which friction depends, or the reason why the type has none.
void ReadFrictionLength(const Node& node, const Units& units, bool used, std::string_view why,
                        double* length) {
  if (!node) return;
  *length = node.Positive(units.length);
  if (!used) node.KeyError(fmt::format("not used: {}", why));
}

void ReadLoadFriction(const Node& node, const Units& units, Joint* joint) {
  if (!node || !node.CheckKeys({"coefficient"}, {"radius", "thrust_radius", "length", "width"})) {
    return;
  }
  const FrictionKeys used = FrictionKeysOf(joint->type);
  LoadFriction& friction = joint->load_friction;
  friction.coefficient = node["coefficient"].NonNegative();
  if (used.radius && !node["radius"]) {
    node.KeyError("the key 'radius' is missing; friction of a rotation acts at a radius");
  }
  ReadFrictionLength(node["radius"], units, used.radius, "this joint does not rotate",
                     &friction.radius);
  ReadFrictionLength(node["thrust_radius"], units, used.thrust_radius,
                     "this joint has no collars that take a thrust", &friction.thrust_radius);
  ReadFrictionLength(node["length"], units, used.length,
                     "this joint has no two supports that hold a tilting couple", &friction.length);
  ReadFrictionLength(node["width"], units, used.width,
                     "only a slide has faces that keep it from turning", &friction.width);
}

void ReadStiffness(const Node& node, const Units& units, Joint* joint) {
  const std::array<Unit, 6> each = SixUnits(units.stiffness, units.rotational_stiffness);
  const std::vector<double> values = node.Numbers(each);
  if (values.empty()) return;
  for (int i = 0; i < 6; ++i) {
    if (values[i] > 0 || (values[i] == 0 && FreedomsOfType(joint->type).free[i])) continue;
    node.Error(
        fmt::format("number {} must be greater than zero, not {}; the six are the stiffness "
                    "along x, y, z and about x, y, z",
                    i + 1, values[i] / each[i].factor));
  }
  joint->stiffness = Vector6d(values.data());
}

void ReadPitch(const Node& node, const Node& pitch, const Units& units, Joint* joint) {
  if (joint->type != JointType::kScrew) {
    pitch.KeyError("only a screw has a pitch");
    return;
  }
  if (!pitch) node.KeyError("the key 'pitch' is missing: the travel of the screw in one turn");
  if (pitch.Number(units.length, 1) == 0) {
    pitch.Error("a screw without pitch is a revolute joint");
  }
  joint->pitch = pitch.Number(units.length) / (2 * std::numbers::pi);
}

/// Keys that say something about freedoms which the type does not have.
bool CheckKeysOfType(const Node& node, JointType type) {
  const auto refuse = [&](std::string_view key, std::string_view why) {
    if (const Node entry = node[key]) entry.KeyError(std::string(why));
    return !node[key];
  };
  bool ok = true;
  if (type == JointType::kWeld) {
    for (const char* key : {"start", "limits", "viscous", "coulomb", "friction", "spring"}) {
      ok &= refuse(key, "a weld has no freedom; leave it out");
    }
  } else if (type == JointType::kSpherical) {
    ok &= refuse("limits", "limits of a spherical joint are not defined; leave them out");
    ok &= refuse("spring", "a spring of a spherical joint is not defined; leave it out");
  }
  return ok;
}

std::optional<JointType> ReadType(const Node& node) {
  return node.Word<std::optional<JointType>>({{"revolute", JointType::kRevolute},
                                              {"prismatic", JointType::kPrismatic},
                                              {"cylindrical", JointType::kCylindrical},
                                              {"screw", JointType::kScrew},
                                              {"universal", JointType::kUniversal},
                                              {"spherical", JointType::kSpherical},
                                              {"planar", JointType::kPlanar},
                                              {"weld", JointType::kWeld}},
                                             std::nullopt);
}

/// An end of a joint. Beside a row of Denavit-Hartenberg parameters it may be the name of a link.
AnchorId ReadEnd(const Node& end, const AnchorNames& anchors, const std::string& joint, bool dh) {
  const bool names_anchor =
      end.kind() != Node::Kind::kScalar || end.Text().find('/') != std::string::npos;
  return dh && !names_anchor ? anchors.FindOnLink(end, joint) : anchors.Find(end);
}

void ReadConnects(const Node& node, const AnchorNames& anchors, bool dh, Joint* joint) {
  const std::vector<Node> ends = node.List();
  if (ends.size() != 2) {
    if (node.kind() == Node::Kind::kList) {
      node.Error("expected two anchors, as in [frame/main, crank/main]");
    }
    return;
  }
  joint->first = ReadEnd(ends[0], anchors, joint->name, dh);
  joint->second = ReadEnd(ends[1], anchors, joint->name, dh);
  if (dh && joint->second.link >= 0 && ends[1].Text().find('/') != std::string::npos) {
    ends[1].Error("'dh' leads to the frame of a link; write the link's name alone");
  }
  if (joint->first.link >= 0 && joint->first.link == joint->second.link) {
    node.Error("the joint connects a link with itself");
  }
}

}  // namespace

AnchorNames::AnchorNames(const std::vector<Link>& links) {
  for (size_t i = 0; i < links.size(); ++i) {
    links_.push_back(links[i].name);
    for (size_t a = 0; a < links[i].anchors.size(); ++a) {
      names_.push_back(links[i].name + "/" + links[i].anchors[a].name);
      ids_[names_.back()] = {static_cast<int>(i), static_cast<int>(a)};
    }
  }
}

AnchorId AnchorNames::Find(const Node& node) const {
  const std::string name = node.Text();
  if (node.kind() != Node::Kind::kScalar) return {};
  const auto found = ids_.find(name);
  if (found != ids_.end()) return found->second;
  node.Error("anchor " + Quoted(name) + " not found" + DidYouMean(name, names_));
  return {};
}

AnchorId AnchorNames::FindOnLink(const Node& node, const std::string& joint) const {
  const std::string link = node.Text();
  const auto found = ids_.find(link + "/" + joint);
  if (found != ids_.end()) return found->second;
  node.Error("link " + Quoted(link) + " not found" + DidYouMean(link, links_));
  return {};
}

Joint ReadJoint(const Node& node, const AnchorNames& anchors, const Units& units) {
  node.CheckName();
  if (!node.CheckKeys({"type", "connects"},
                      {"description", "dh", "start", "pitch", "limits", "viscous", "coulomb",
                       "friction", "spring", "stiffness"})) {
    return MakeJoint(node.key(), JointType::kWeld, {}, {});
  }
  node["description"].Text();
  const std::optional<JointType> type = ReadType(node["type"]);
  Joint joint = MakeJoint(node.key(), type.value_or(JointType::kWeld), {}, {});
  ReadConnects(node["connects"], anchors, static_cast<bool>(node["dh"]), &joint);
  if (!type) return joint;
  ReadPitch(node, node["pitch"], units, &joint);
  ReadStiffness(node["stiffness"], units, &joint);
  if (!CheckKeysOfType(node, joint.type)) return joint;
  ReadStart(node["start"], units, &joint);
  ReadLimits(node["limits"], units, &joint);
  CheckStartWithinLimits(node["start"], joint);
  ReadPassive(node, units, &joint);
  ReadLoadFriction(node["friction"], units, &joint);
  return joint;
}

}  // namespace vmech
