#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "vmech/mechanisms/exchange/mjcf.h"
#include "vmech/mechanisms/exchange/start_pose.h"
#include "vmech/mechanisms/exchange/xml/xml_text.h"
#include "vmech/mechanisms/freedoms.h"
#include "vmech/mechanisms/mass_properties.h"

namespace vmech {
namespace {

constexpr double kSmallestInertia = 1e-12;  // [kg m^2] MuJoCo refuses what is below 1e-14
constexpr double kLight = 1e-6;             // of the heaviest link: a link that must have a mass
constexpr double kRod = 0.02;               // of the length: radius of what is seen

/// Loops are best cut where <connect> says it all, and worst at screws: a light carriage on one
/// would be soft.
SpanningTree TreeFor(const Mechanism& mechanism) {
  const auto all = [&](auto&& wanted) {
    std::vector<int> joints;
    for (size_t j = 0; j < mechanism.joints.size(); ++j) {
      if (wanted(mechanism.joints[j].type)) joints.push_back(static_cast<int>(j));
    }
    return joints;
  };
  SpanningTreeOptions options;
  options.cut = all(
      [](JointType type) { return type == JointType::kSpherical || type == JointType::kRevolute; });
  if (options.cut.empty()) options.cut = all([](JointType t) { return t != JointType::kScrew; });
  return FindSpanningTree(mechanism, options);
}

class Writer {
 public:
  explicit Writer(const Mechanism& mechanism)
      : mechanism_(mechanism),
        tree_(TreeFor(mechanism)),
        poses_(LinkStartPoses(mechanism, tree_)),
        length_(CharacteristicLength(mechanism)) {
    RequireNames();
    double heaviest = 0;
    for (const Link& link : mechanism.links) {
      heaviest = std::max(heaviest, link.mass_properties.mass);
    }
    light_ = kLight * (heaviest > 0 ? heaviest : 1);
    for (const Joint& joint : mechanism.joints) NoteLosses(joint);
  }

  ExportedText Write() {
    xml_.Open("mujoco", {{"model", mechanism_.name}});
    AddSettings();
    xml_.Open("worldbody");
    AddContents(mechanism_.ground);
    xml_.Close();
    xml_.Open("equality");
    for (const auto& [tag, attributes] : equalities_) xml_.Element(tag, attributes);
    xml_.Close();
    xml_.Close();
    return {xml_.text(), notes_};
  }

 private:
  void RequireNames() const {
    const int world = FindLink(mechanism_, "world");
    if (world < 0 || world == mechanism_.ground) return;
    throw std::invalid_argument(
        "'world' cannot name a link that moves in MuJoCo, where it is the ground; rename it");
  }

  void NoteLosses(const Joint& joint) {
    const auto note = [&](const std::string& what) {
      notes_.push_back(fmt::format("joint '{}': {}", joint.name, what));
    };
    if (joint.stiffness) note("its stiffness is left out");
    if (joint.load_friction.coefficient != 0)
      note("friction in proportion to its load is left out");
  }

  void AddSettings() {
    xml_.Element("compiler", {{"angle", "radian"}, {"inertiafromgeom", "false"}});
    xml_.Element("option", {{"timestep", "0.0005"},
                            {"gravity", XmlNumbers(mechanism_.gravity_W)},
                            {"integrator", "RK4"},
                            {"iterations", "100"},
                            {"tolerance", "1e-14"}});
    xml_.Open("default");
    xml_.Element("geom", {{"contype", "0"}, {"conaffinity", "0"}, {"rgba", "0.5 0.6 0.7 1"}});
    xml_.Element("equality", {{"solref", "0.001 1"}, {"solimp", "0.9999 0.9999 0.001"}});
    xml_.Close();
  }

  void OpenBody(const std::string& name, const Posed& X_parent_body) {
    const Eigen::Quaterniond q(X_parent_body.R);
    xml_.Open("body", {{"name", name},
                       {"pos", XmlNumbers(X_parent_body.p)},
                       {"quat", fmt::format("{} {}", XmlNumber(q.w()), XmlNumbers(q.vec()))}});
  }

  /// What stands in a body, and the bodies that it carries.
  void AddContents(int link) {
    AddCapsules(mechanism_.links[link]);
    for (const Grasp& grasp : mechanism_.grasps) {
      if (grasp.link == link) AddSite(grasp);
    }
    for (const SpanningTree::Branch& branch : tree_.branches) {
      if (branch.parent_link == link) AddBody(branch);
    }
    for (const int cut : tree_.cuts) {
      if (mechanism_.joints[cut].first.link == link) AddCut(mechanism_.joints[cut]);
    }
  }

  void AddBody(const SpanningTree::Branch& branch) {
    const Joint& joint = mechanism_.joints[branch.joint];
    const Link& link = mechanism_.links[branch.child_link];
    const Posed& X_WL = poses_[branch.child_link];
    OpenBody(link.name, poses_[branch.parent_link].inverse() * X_WL);
    AddInertial(link.name, link.mass_properties);
    std::vector<StartAxis> axes = StartAxes(joint, PoseOf(joint.first));
    if (joint.first.link == branch.child_link) {  // the chain backwards, the other way round
      std::reverse(axes.begin(), axes.end());
      for (StartAxis& axis : axes) axis.direction_W *= -1;
    }
    AddFreedoms(joint, axes, X_WL);
    AddContents(branch.child_link);
    xml_.Close();
  }

  Posed PoseOf(AnchorId id) const { return poses_[id.link] * mechanism_.anchor(id).X_LA; }

  void AddFreedoms(const Joint& joint, const std::vector<StartAxis>& axes, const Posed& X_WB) {
    if (joint.type == JointType::kSpherical) {
      const Vector3d centre = X_WB.inverse() * PoseOf(joint.second).p;
      XmlText::Attributes ball{{"name", joint.name}, {"type", "ball"}, {"pos", XmlNumbers(centre)}};
      AddFriction(joint.passive[0], &ball);
      xml_.Element("joint", ball);
    }
    for (const StartAxis& axis : axes) {
      const std::string name = NameOfFreedom(joint, axis.freedom);
      AddFreedom(name, axis.rotates ? "hinge" : "slide", joint, axis, X_WB);
      if (joint.type != JointType::kScrew) continue;
      const std::string travel = name + " travel";
      xml_.Element("joint", {{"name", travel},
                             {"type", "slide"},
                             {"axis", XmlNumbers(X_WB.R.transpose() * axis.direction_W)}});
      equalities_.push_back({"joint",
                             {{"joint1", travel},
                              {"joint2", name},
                              {"polycoef", fmt::format("0 {} 0 0 0", XmlNumber(joint.pitch))}}});
    }
  }

  static void AddFriction(const Passive& passive, XmlText::Attributes* attributes) {
    if (passive.viscous != 0) attributes->emplace_back("damping", XmlNumber(passive.viscous));
    if (passive.coulomb != 0) attributes->emplace_back("frictionloss", XmlNumber(passive.coulomb));
  }

  void AddFreedom(const std::string& name, const std::string& type, const Joint& joint,
                  const StartAxis& axis, const Posed& X_WB) {
    constexpr double kFar = 1e6;  // in place of the bound that a one-sided limit has not
    const int i = axis.freedom;
    XmlText::Attributes attributes{{"name", name},
                                   {"type", type},
                                   {"pos", XmlNumbers(X_WB.inverse() * axis.point_W)},
                                   {"axis", XmlNumbers(X_WB.R.transpose() * axis.direction_W)}};
    if (std::isfinite(joint.lower[i]) || std::isfinite(joint.upper[i])) {
      const double lower = std::max(joint.lower[i] - axis.coordinate, -kFar);
      const double upper = std::min(joint.upper[i] - axis.coordinate, kFar);
      attributes.emplace_back("limited", "true");
      attributes.emplace_back("range", XmlNumber(lower) + " " + XmlNumber(upper));
    }
    const Passive& passive = joint.passive[i];
    AddFriction(passive, &attributes);
    if (passive.stiffness != 0) {
      attributes.emplace_back("stiffness", XmlNumber(passive.stiffness));
      attributes.emplace_back("springref", XmlNumber(passive.rest - axis.coordinate));
    }
    xml_.Element("joint", attributes);
  }

  void AddInertial(const std::string& name, MassProperties properties) {
    if (properties.mass == 0) {
      properties.mass = light_;
      notes_.push_back(fmt::format("link '{}' has no mass, which MuJoCo does not allow: {:.3g} kg",
                                   name, light_));
    }
    Matrix3d I = properties.I_Lcm;
    const Vector3d moments = PrincipalMoments(I);
    // Added alike to all three, it mends a moment that is too small and one that is too large.
    const double added =
        std::max(kSmallestInertia - moments[0], moments[2] - moments[1] - moments[0]);
    if (added > 0) {
      I += added * Matrix3d::Identity();
      notes_.push_back(fmt::format(
          "link '{}': {:.3g} kg m^2 added to its moments of inertia, as MuJoCo asks for", name,
          added));
    }
    const std::string elements =
        fmt::format("{} {} {} {} {} {}", XmlNumber(I(0, 0)), XmlNumber(I(1, 1)), XmlNumber(I(2, 2)),
                    XmlNumber(I(0, 1)), XmlNumber(I(0, 2)), XmlNumber(I(1, 2)));
    xml_.Element("inertial", {{"pos", XmlNumbers(properties.p_LoLcm)},
                              {"mass", XmlNumber(properties.mass)},
                              {"fullinertia", elements}});
  }

  void AddCapsules(const Link& link) {
    for (size_t a = 1; a < link.anchors.size(); ++a) {
      const Vector3d &from = link.anchors[0].X_LA.p, &to = link.anchors[a].X_LA.p;
      if ((to - from).norm() < kRod * length_) continue;
      xml_.Element("geom", {{"type", "capsule"},
                            {"fromto", XmlNumbers(from) + " " + XmlNumbers(to)},
                            {"size", XmlNumber(kRod * length_)}});
    }
  }

  void AddSite(const Grasp& grasp) {
    const Eigen::Quaterniond q(grasp.X_LG.R);
    xml_.Element("site", {{"name", grasp.name},
                          {"pos", XmlNumbers(grasp.X_LG.p)},
                          {"quat", fmt::format("{} {}", XmlNumber(q.w()), XmlNumbers(q.vec()))},
                          {"size", XmlNumber(kRod * length_)}});
  }

  /// A cut joint, seen from its first link.
  void AddCut(const Joint& joint) {
    const std::vector<StartAxis> axes = StartAxes(joint, PoseOf(joint.first));
    const bool turns = !axes.empty() && axes.back().rotates && joint.type != JointType::kScrew;
    const size_t carried = turns ? axes.size() - 1 : axes.size();
    std::string body = BodyName(joint.first.link);
    const Posed X_WM = PoseOf(joint.second);
    Posed X_WB = poses_[joint.first.link];
    if (carried > 0) {
      body = joint.name + " carriage";
      OpenBody(body, X_WB.inverse() * X_WM);
      X_WB = X_WM;
      const double moment = std::max(light_ * length_ * length_, kSmallestInertia);
      AddInertial(body, {light_, Vector3d::Zero(), moment * Matrix3d::Identity()});
      notes_.push_back(fmt::format(
          "joint '{}' closes a loop: a carriage of {:.3g} kg is part of it", joint.name, light_));
      AddFreedoms(joint, {axes.begin(), axes.begin() + static_cast<std::ptrdiff_t>(carried)}, X_WB);
      xml_.Close();
    }
    const std::string other = BodyName(joint.second.link);
    if (turns) {
      AddConnect(body, other, X_WB, joint.second.link, X_WM.p);
      AddConnect(body, other, X_WB, joint.second.link, X_WM.p + length_ * axes.back().direction_W);
    } else if (joint.type == JointType::kSpherical) {
      AddConnect(body, other, X_WB, joint.second.link, X_WM.p);
    } else if (body == "world") {
      equalities_.push_back({"weld", {{"body1", other}}});
    } else {
      equalities_.push_back({"weld", {{"body1", body}, {"body2", other}}});
    }
  }

  std::string BodyName(int link) const {
    return link == mechanism_.ground ? "world" : mechanism_.links[link].name;
  }

  /// The anchor is given in the first body, which must not be the world.
  void AddConnect(const std::string& body, const std::string& other, const Posed& X_WB,
                  int other_link, const Vector3d& point_W) {
    const bool swap = body == "world";
    const Posed& X_W1 = swap ? poses_[other_link] : X_WB;
    equalities_.push_back({"connect",
                           {{"body1", swap ? other : body},
                            {"body2", swap ? body : other},
                            {"anchor", XmlNumbers(X_W1.inverse() * point_W)}}});
  }

  const Mechanism& mechanism_;
  const SpanningTree tree_;
  const std::vector<Posed> poses_;
  const double length_;
  double light_ = 0;
  XmlText xml_;
  std::vector<std::pair<std::string, XmlText::Attributes>> equalities_;
  std::vector<std::string> notes_;
};

}  // namespace

ExportedText WriteMjcf(const Mechanism& mechanism) {
  return Writer(mechanism).Write();
}

}  // namespace vmech
