#include "vmech/dynamics/in_hand/held_design.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace vmech {
namespace {

/// An infinite limit stays one.
double Between(double from, double to, double share) noexcept {
  return from == to ? from : from + share * (to - from);
}

Posed Between(const Posed& from, const Posed& to, double share) noexcept {
  Posed between{from.R, from.p + share * (to.p - from.p)};
  if (from.R != to.R) {
    const Eigen::Quaterniond a(from.R), b(to.R);
    between.R = a.slerp(share, b).toRotationMatrix();
  }
  return between;
}

Passive Between(const Passive& from, const Passive& to, double share) noexcept {
  return {Between(from.stiffness, to.stiffness, share), Between(from.rest, to.rest, share),
          Between(from.viscous, to.viscous, share), Between(from.coulomb, to.coulomb, share)};
}

double Way(const Posed& from, const Posed& to, double length) {
  const double angle = Eigen::AngleAxisd(from.R.transpose() * to.R).angle();
  return (to.p - from.p).norm() + length * angle;
}

bool IsLimited(double lower, double upper) {
  return std::isfinite(lower) || std::isfinite(upper);
}

/// The names and types that make a topology, of which the numbers are left open.
std::string TopologyOf(const Mechanism& mechanism) {
  std::string text;
  for (const Link& link : mechanism.links) {
    text += fmt::format("link {} with {} anchors\n", link.name, link.anchors.size());
  }
  for (const Joint& joint : mechanism.joints) {
    text +=
        fmt::format("joint {} {} {}.{} {}.{}\n", joint.name, NameOf(joint.type), joint.first.link,
                    joint.first.anchor, joint.second.link, joint.second.anchor);
  }
  for (const Grasp& grasp : mechanism.grasps) {
    text += fmt::format("grasp {} {}\n", grasp.name, grasp.link);
  }
  return text + fmt::format("ground {}", mechanism.ground);
}

}  // namespace

HeldDesign HeldDesignOf(const KinematicTree& tree, std::span<const int> grasps,
                        const VectorXd& values) {
  HeldDesign design;
  design.values = values;
  design.tree = DesignOfTree<double>(tree);
  for (const TreeNode& node : tree.nodes) {
    const Joint& joint = tree.mechanism.joints[node.joint];
    HeldDesign::FreedomNumbers numbers;
    if (node.v >= 0 && node.motion != NodeMotion::kSpherical) {
      const auto k = static_cast<size_t>(node.freedom);
      numbers = {joint.passive[k], joint.lower[k], joint.upper[k]};
    }
    design.freedoms.push_back(numbers);
  }
  design.gravity_W = tree.mechanism.gravity_W;
  for (const int grasp : grasps) design.grasps.push_back(GraspFrameOf(tree, grasp));
  return design;
}

Mechanism MechanismWith(const HeldDesign& design, const KinematicTree& tree,
                        std::span<const int> grasps) {
  Mechanism mechanism = tree.mechanism;
  const auto in_link = [&](int link) {
    const int node = tree.NodeOfLink(link);
    return node < 0 ? Posed{} : design.tree.nodes[static_cast<size_t>(node)].X_BL.inverse();
  };
  for (size_t i = 0; i < tree.nodes.size(); ++i) {
    const TreeNode& node = tree.nodes[i];
    const auto& numbers = design.tree.nodes[i];
    if (node.link >= 0) {
      const Posed X_LB = in_link(node.link);
      mechanism.links[static_cast<size_t>(node.link)].mass_properties = {
          numbers.mass, X_LB * numbers.p_BoBcm, X_LB.R * numbers.I_Bcm * X_LB.R.transpose()};
    }
    if (node.v < 0 || node.motion == NodeMotion::kSpherical) continue;
    Joint& joint = mechanism.joints[static_cast<size_t>(node.joint)];
    const auto k = static_cast<size_t>(node.freedom);
    joint.passive[k] = design.freedoms[i].passive;
    joint.lower[k] = design.freedoms[i].lower;
    joint.upper[k] = design.freedoms[i].upper;
  }
  const auto anchor = [&](const AnchorId& id) -> Posed& {
    return mechanism.links[static_cast<size_t>(id.link)]
        .anchors[static_cast<size_t>(id.anchor)]
        .X_LA;
  };
  for (size_t j = 0; j < mechanism.joints.size(); ++j) {
    const auto& [X_AF, X_BM, pitch] = design.tree.placements[j];
    Joint& joint = mechanism.joints[j];
    joint.pitch = pitch;
    anchor(joint.first) = in_link(joint.first.link) * X_AF;
    anchor(joint.second) = in_link(joint.second.link) * X_BM;
  }
  for (size_t i = 0; i < grasps.size(); ++i) {
    Grasp& grasp = mechanism.grasps[static_cast<size_t>(grasps[i])];
    grasp.X_LG = in_link(grasp.link) * design.grasps[i].X_BG;
  }
  mechanism.gravity_W = design.gravity_W;
  return mechanism;
}

void Blend(const HeldDesign& from, const HeldDesign& to, double share,
           HeldDesign* between) noexcept {
  const auto mix = [share](const auto& a, const auto& b) { return Between(a, b, share); };
  for (Eigen::Index i = 0; i < between->values.size(); ++i) {
    between->values[i] = mix(from.values[i], to.values[i]);
  }
  for (size_t i = 0; i < between->tree.nodes.size(); ++i) {
    const auto &a = from.tree.nodes[i], &b = to.tree.nodes[i];
    auto& node = between->tree.nodes[i];
    node.X_PF = mix(a.X_PF, b.X_PF);
    node.X_BL = mix(a.X_BL, b.X_BL);
    node.pitch = mix(a.pitch, b.pitch);
    node.mass = mix(a.mass, b.mass);
    node.p_BoBcm = a.p_BoBcm + share * (b.p_BoBcm - a.p_BoBcm);
    node.I_Bcm = a.I_Bcm + share * (b.I_Bcm - a.I_Bcm);
  }
  for (size_t j = 0; j < between->tree.placements.size(); ++j) {
    const auto &a = from.tree.placements[j], &b = to.tree.placements[j];
    between->tree.placements[j] = {mix(a.X_AF, b.X_AF), mix(a.X_BM, b.X_BM), mix(a.pitch, b.pitch)};
  }
  for (size_t i = 0; i < between->freedoms.size(); ++i) {
    const HeldDesign::FreedomNumbers &a = from.freedoms[i], &b = to.freedoms[i];
    between->freedoms[i] = {mix(a.passive, b.passive), mix(a.lower, b.lower),
                            mix(a.upper, b.upper)};
  }
  between->gravity_W = from.gravity_W + share * (to.gravity_W - from.gravity_W);
  for (size_t i = 0; i < between->grasps.size(); ++i) {
    between->grasps[i].X_BG = mix(from.grasps[i].X_BG, to.grasps[i].X_BG);
  }
}

bool HasSameNumbers(const HeldDesign& a, const HeldDesign& b) {
  const auto same = [](const Posed& X, const Posed& Y) { return X.R == Y.R && X.p == Y.p; };
  for (size_t i = 0; i < a.tree.nodes.size(); ++i) {
    const auto &m = a.tree.nodes[i], &n = b.tree.nodes[i];
    if (!same(m.X_PF, n.X_PF) || !same(m.X_BL, n.X_BL) || m.pitch != n.pitch || m.mass != n.mass ||
        m.p_BoBcm != n.p_BoBcm || m.I_Bcm != n.I_Bcm) {
      return false;
    }
    const HeldDesign::FreedomNumbers &f = a.freedoms[i], &g = b.freedoms[i];
    if (f.lower != g.lower || f.upper != g.upper || f.passive.stiffness != g.passive.stiffness ||
        f.passive.rest != g.passive.rest || f.passive.viscous != g.passive.viscous ||
        f.passive.coulomb != g.passive.coulomb) {
      return false;
    }
  }
  for (size_t j = 0; j < a.tree.placements.size(); ++j) {
    const auto &p = a.tree.placements[j], &q = b.tree.placements[j];
    if (!same(p.X_AF, q.X_AF) || !same(p.X_BM, q.X_BM) || p.pitch != q.pitch) return false;
  }
  for (size_t i = 0; i < a.grasps.size(); ++i) {
    if (!same(a.grasps[i].X_BG, b.grasps[i].X_BG)) return false;
  }
  return a.gravity_W == b.gravity_W;
}

double WayBetween(const KinematicTree& tree, const HeldDesign& from, const HeldDesign& to) {
  double way = 0;
  const auto take = [&](const Posed& a, const Posed& b) {
    way = std::max(way, Way(a, b, tree.length));
  };
  for (size_t i = 0; i < from.tree.nodes.size(); ++i) {
    take(from.tree.nodes[i].X_PF, to.tree.nodes[i].X_PF);
    take(from.tree.nodes[i].X_BL, to.tree.nodes[i].X_BL);
  }
  for (size_t j = 0; j < from.tree.placements.size(); ++j) {
    take(from.tree.placements[j].X_AF, to.tree.placements[j].X_AF);
    take(from.tree.placements[j].X_BM, to.tree.placements[j].X_BM);
  }
  for (size_t i = 0; i < from.grasps.size(); ++i) take(from.grasps[i].X_BG, to.grasps[i].X_BG);
  return way;
}

std::string WhyNotInPlaceOf(const KinematicTree& held, const KinematicTree& other) {
  if (TopologyOf(held.mechanism) != TopologyOf(other.mechanism) ||
      held.spanning.cuts != other.spanning.cuts) {
    return "it has other links, joints or grasps";
  }
  const HeldDesign a = HeldDesignOf(held), b = HeldDesignOf(other);
  for (size_t i = 0; i < a.freedoms.size(); ++i) {
    const HeldDesign::FreedomNumbers &p = a.freedoms[i], &q = b.freedoms[i];
    const bool same = std::isfinite(p.lower) == std::isfinite(q.lower) &&
                      std::isfinite(p.upper) == std::isfinite(q.upper);
    const bool appears = HasPassive(q.passive) && !HasPassive(p.passive);
    if (same && (!appears || IsLimited(p.lower, p.upper))) continue;
    return fmt::format("joint '{}' has {}", held.mechanism.joints[held.nodes[i].joint].name,
                       same ? "a spring or friction that it had not" : "other limits");
  }
  return "";
}

}  // namespace vmech
