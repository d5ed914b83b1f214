#include <fmt/format.h>

#include <cmath>
#include <set>
#include <stdexcept>

#include "vmech/mechanisms/exchange/sdf/sdf.h"
#include "vmech/mechanisms/exchange/start_pose.h"
#include "vmech/mechanisms/exchange/xml/xml_text.h"

namespace vmech {
namespace {

/// Names that the SDF specification keeps for itself.
void CheckName(const std::string& name) {
  const bool reserved = name == "world" || (name.size() > 4 && name.substr(0, 2) == "__" &&
                                            name.substr(name.size() - 2) == "__");
  if (!reserved && name.find("::") == std::string::npos) return;
  throw std::invalid_argument(
      fmt::format("'{}' cannot name a part in SDF ('world', '__x__' and '::' have a meaning of "
                  "their own there); rename it",
                  name));
}

class Writer {
 public:
  explicit Writer(const Mechanism& original)
      : mechanism_(WithoutCompositeJoints(original)),
        poses_(LinkStartPoses(mechanism_, FindSpanningTree(mechanism_))) {
    for (const Joint& joint : original.joints) NoteLosses(joint);
  }

  ExportedText Write() {
    xml_.Open("sdf", {{"version", "1.9"}});
    xml_.Open("world", {{"name", "default"}});
    xml_.Text("gravity", XmlNumbers(mechanism_.gravity_W));
    xml_.Open("model", {{"name", mechanism_.name}});
    CheckName(mechanism_.name);
    for (size_t i = 0; i < mechanism_.links.size(); ++i) AddLink(static_cast<int>(i));
    for (const Joint& joint : mechanism_.joints) AddJoint(joint);
    const std::string& ground = mechanism_.links[mechanism_.ground].name;
    xml_.Open("joint", {{"name", Unique(ground + "_to_world", "_")}, {"type", "fixed"}});
    xml_.Text("parent", "world");
    xml_.Text("child", ground);
    xml_.Close();
    for (const Grasp& grasp : mechanism_.grasps) AddGrasp(grasp);
    while (depth_-- > 0) xml_.Close();
    return {xml_.text(), notes_};
  }

 private:
  void NoteLosses(const Joint& joint) {
    const auto note = [&](const std::string& what) {
      notes_.push_back(fmt::format("joint '{}': {}", joint.name, what));
    };
    if (joint.type == JointType::kCylindrical || joint.type == JointType::kPlanar) {
      note(fmt::format("{}, which SDF has not: prismatic and revolute joints in a row",
                       NameOf(joint.type)));
    }
    if (joint.stiffness) note("its stiffness is left out");
    if (joint.load_friction.coefficient != 0)
      note("friction in proportion to its load is left out");
    if (joint.type != JointType::kSpherical) return;
    for (const Passive& passive : joint.passive) {
      if (passive.viscous == 0 && passive.coulomb == 0) continue;
      note("SDF has no friction of a ball joint: left out");
      break;
    }
  }

  /// Links, joints and frames of a model share their names in SDF.
  std::string Unique(const std::string& name, const std::string& suffix) {
    std::string unique = name;
    while (!names_.insert(unique).second) unique += suffix;
    CheckName(unique);
    if (unique != name) notes_.push_back(fmt::format("'{}' is called '{}' there", name, unique));
    return unique;
  }

  void AddPose(const Posed& X, const XmlText::Attributes& relative_to = {}) {
    const Eigen::Quaterniond q(X.R);
    XmlText::Attributes attributes = relative_to;
    attributes.emplace_back("rotation_format", "quat_xyzw");
    xml_.Text("pose",
              fmt::format("{} {} {}", XmlNumbers(X.p), XmlNumbers(q.vec()), XmlNumber(q.w())),
              attributes);
  }

  void AddLink(int index) {
    const Link& link = mechanism_.links[index];
    xml_.Open("link", {{"name", Unique(link.name, "_")}});
    AddPose(poses_[index]);
    AddInertial(link, index == mechanism_.ground);
    xml_.Close();
  }

  void AddInertial(const Link& link, bool ground) {
    MassProperties properties = link.mass_properties;
    if (properties.mass == 0) {
      properties.mass = kNextToNoMass;
      properties.I_Lcm = 1e-6 * kNextToNoMass * Matrix3d::Identity();
      if (!ground) {
        notes_.push_back(fmt::format("link '{}' has no mass, which SDF does not allow: {} kg",
                                     link.name, kNextToNoMass));
      }
    }
    const Matrix3d& I = properties.I_Lcm;
    xml_.Open("inertial");
    AddPose({Matrix3d::Identity(), properties.p_LoLcm});
    xml_.Text("mass", XmlNumber(properties.mass));
    xml_.Open("inertia");
    for (const auto& [tag, i, j] : {std::tuple{"ixx", 0, 0},
                                    {"ixy", 0, 1},
                                    {"ixz", 0, 2},
                                    {"iyy", 1, 1},
                                    {"iyz", 1, 2},
                                    {"izz", 2, 2}}) {
      xml_.Text(tag, XmlNumber(I(i, j)));
    }
    xml_.Close();
    xml_.Close();
  }

  void AddJoint(const Joint& joint) {
    const Posed X_WM = poses_[joint.second.link] * mechanism_.anchor(joint.second).X_LA;
    const Posed X_WF = poses_[joint.first.link] * mechanism_.anchor(joint.first).X_LA;
    xml_.Open("joint", {{"name", Unique(joint.name, "_joint")}, {"type", TypeName(joint.type)}});
    AddPose(mechanism_.anchor(joint.second).X_LA);
    xml_.Text("parent", mechanism_.links[joint.first.link].name);
    xml_.Text("child", mechanism_.links[joint.second.link].name);
    if (joint.type == JointType::kScrew) xml_.Text("thread_pitch", XmlNumber(-1 / joint.pitch));
    const std::vector<StartAxis> axes = StartAxes(joint, X_WF);
    for (size_t i = 0; i < axes.size(); ++i) {
      const bool own = joint.type != JointType::kUniversal;
      const Vector3d xyz = own      ? Vector3d::UnitZ()
                           : i == 0 ? Vector3d(X_WM.R.transpose() * axes[i].direction_W)
                                    : Vector3d::UnitY();
      AddAxis(i == 0 ? "axis" : "axis2", xyz, joint, static_cast<int>(i));
    }
    xml_.Close();
  }

  static std::string TypeName(JointType type) {
    switch (type) {
      case JointType::kSpherical:
        return "ball";
      case JointType::kWeld:
        return "fixed";
      default:
        return std::string(NameOf(type));
    }
  }

  /// Coordinates are counted from the start.
  void AddAxis(std::string_view tag, const Vector3d& xyz, const Joint& joint, int i) {
    const double start = joint.start[i];
    const Passive& passive = joint.passive[i];
    xml_.Open(tag);
    xml_.Text("xyz", XmlNumbers(xyz));
    if (std::isfinite(joint.lower[i]) || std::isfinite(joint.upper[i])) {
      xml_.Open("limit");
      if (std::isfinite(joint.lower[i])) xml_.Text("lower", XmlNumber(joint.lower[i] - start));
      if (std::isfinite(joint.upper[i])) xml_.Text("upper", XmlNumber(joint.upper[i] - start));
      xml_.Close();
    }
    if (passive.viscous != 0 || passive.coulomb != 0 || passive.stiffness != 0) {
      xml_.Open("dynamics");
      xml_.Text("damping", XmlNumber(passive.viscous));
      xml_.Text("friction", XmlNumber(passive.coulomb));
      xml_.Text("spring_reference", XmlNumber(passive.rest - start));
      xml_.Text("spring_stiffness", XmlNumber(passive.stiffness));
      xml_.Close();
    }
    xml_.Close();
  }

  void AddGrasp(const Grasp& grasp) {
    xml_.Open("frame", {{"name", Unique(grasp.name, "_grasp")},
                        {"attached_to", mechanism_.links[grasp.link].name}});
    AddPose(grasp.X_LG);
    xml_.Close();
    if (grasp.kind == GraspKind::kPoint) {
      notes_.push_back(fmt::format("grasp '{}' is a point; its frame does not say so", grasp.name));
    }
  }

  const Mechanism mechanism_;
  const std::vector<Posed> poses_;
  XmlText xml_;
  int depth_ = 3;  // sdf, world, model
  std::set<std::string> names_;
  std::vector<std::string> notes_;
};

}  // namespace

ExportedText WriteSdf(const Mechanism& mechanism) {
  return Writer(mechanism).Write();
}

}  // namespace vmech
