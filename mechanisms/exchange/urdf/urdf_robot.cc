#include "vmech/mechanisms/exchange/urdf/urdf_robot.h"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <map>

#include "vmech/mechanisms/exchange/xml/xml_document.h"
#include "vmech/mechanisms/mass_properties.h"

namespace vmech {
namespace {

using Words = std::initializer_list<std::string_view>;

class Parser {
 public:
  Parser(std::string_view text, const std::string& file) : errors_(file) {
    const XmlElement root = ParseXml(text, file);
    if (root.name == "robot") {
      ReadRobot(root);
    } else {
      errors_.Add(root.line,
                  fmt::format("<robot> expected, which a URDF begins with, not <{}>", root.name));
    }
    errors_.Throw();
    robot_.left_out = left_out_.Texts();
  }

  UrdfRobot Take() { return std::move(robot_); }

 private:
  void ReadRobot(const XmlElement& root) {
    for (const auto& [key, value] : root.attributes) {
      if (key == "name") robot_.name = value;
    }
    if (robot_.name.empty()) errors_.Add(root.line, "the robot has no name (<robot name='...'>)");
    for (const XmlElement& child : root.children) {
      if (child.name == "link") {
        ReadLink(child);
      } else if (child.name == "joint") {
        ReadJoint(child);
      } else {
        LeaveOut(child);
      }
    }
    if (robot_.links.empty()) errors_.Add(root.line, "there is no link in it");
    RequireUnique("link", robot_.links);
    RequireUnique("joint", robot_.joints);
  }

  void LeaveOut(const XmlElement& element) {
    if (element.name.starts_with("xacro:")) {
      errors_.Add(element.line, fmt::format("<{}> has to go through xacro first: xacro {} > "
                                            "robot.urdf",
                                            element.name, errors_.file()));
    }
    left_out_.Add(fmt::format("<{}>", element.name));
  }

  /// Nothing is lost in silence: what is not known is counted.
  void LeaveOutAllBut(Words children, Words attributes, const XmlElement& element) {
    const auto known = [](Words words, const std::string& name) {
      return std::find(words.begin(), words.end(), name) != words.end();
    };
    for (const XmlElement& child : element.children) {
      if (!known(children, child.name)) LeaveOut(child);
    }
    for (const auto& [key, value] : element.attributes) {
      if (!known(attributes, key)) left_out_.Add(fmt::format("'{}' of <{}>", key, element.name));
    }
  }

  template <typename Part>
  void RequireUnique(std::string_view kind, const std::vector<Part>& parts) {
    std::map<std::string, int> lines;
    for (const Part& part : parts) {
      const auto [entry, added] = lines.emplace(part.name, part.line);
      if (added) continue;
      errors_.Add(part.line, fmt::format("a second {} is called {}; the first is in line {}", kind,
                                         Quoted(part.name), entry->second));
    }
  }

  std::string Name(const XmlElement& element) {
    const std::string* name = element.Attribute("name");
    if (name != nullptr && !name->empty()) return *name;
    errors_.Add(element.line, fmt::format("a {} has no name", element.name));
    return {};
  }

  /// An attribute that must be there.
  double Required(const XmlElement& element, std::string_view key, std::string_view what) {
    if (element.Attribute(key) == nullptr) {
      errors_.Add(element.line, fmt::format("<{}> of {} lacks '{}'", element.name, what, key));
    }
    return errors_.Number(element, key, 0, what);
  }

  Vector3d Vector(const XmlElement& element, std::string_view key, const Vector3d& fallback,
                  std::string_view what) {
    const std::string* text = element.Attribute(key);
    if (text == nullptr) return fallback;
    const std::vector<double> numbers = errors_.Numbers(
        *text, 3, element.line, fmt::format("'{}' of <{}> of {}", key, element.name, what));
    return {numbers[0], numbers[1], numbers[2]};
  }

  Matrix3d Rotation(const XmlElement& origin, const std::string& what) {
    const std::string* quaternion = origin.Attribute("quat_xyzw");
    if (quaternion != nullptr) {
      if (origin.Attribute("rpy") != nullptr) {
        errors_.Add(origin.line, fmt::format("the origin of {} has 'rpy' and 'quat_xyzw'", what));
      }
      const std::vector<double> q = errors_.Numbers(
          *quaternion, 4, origin.line, fmt::format("'quat_xyzw' of <origin> of {}", what));
      const Eigen::Quaterniond rotation(q[3], q[0], q[1], q[2]);
      constexpr double kNothing = 1e-100;  // whose square may vanish
      if (rotation.norm() > kNothing) return rotation.normalized().toRotationMatrix();
      errors_.Add(origin.line, fmt::format("'quat_xyzw' of {} has no length", what));
    }
    const Vector3d rpy = Vector(origin, "rpy", Vector3d::Zero(), what);
    // R = Rz(yaw) Ry(pitch) Rx(roll)
    return (Eigen::AngleAxisd(rpy[2], Vector3d::UnitZ()) *
            Eigen::AngleAxisd(rpy[1], Vector3d::UnitY()) *
            Eigen::AngleAxisd(rpy[0], Vector3d::UnitX()))
        .toRotationMatrix();
  }

  Posed Origin(const XmlElement& element, const std::string& what) {
    const XmlElement* origin = OnlyChild(element, "origin", &errors_);
    if (origin == nullptr) return {};
    LeaveOutAllBut({}, {"xyz", "rpy", "quat_xyzw"}, *origin);
    return {Rotation(*origin, what), Vector(*origin, "xyz", Vector3d::Zero(), what)};
  }

  void ReadLink(const XmlElement& element) {
    UrdfLink link;
    link.name = Name(element);
    link.line = element.line;
    LeaveOutAllBut({"inertial"}, {"name"}, element);
    if (const XmlElement* inertial = OnlyChild(element, "inertial", &errors_)) {
      ReadInertial(*inertial, &link);
    }
    robot_.links.push_back(std::move(link));
  }

  void ReadInertial(const XmlElement& element, UrdfLink* link) {
    const std::string what = fmt::format("link {}", Quoted(link->name));
    LeaveOutAllBut({"origin", "mass", "inertia"}, {}, element);
    link->has_inertial = true;
    link->line = element.line;
    const Posed X_LI = Origin(element, what);
    link->mass_properties.p_LoLcm = X_LI.p;
    ReadMass(element, what, link);
    const XmlElement* inertia = OnlyChild(element, "inertia", &errors_);
    link->has_inertia = inertia != nullptr;
    if (inertia != nullptr) {
      link->mass_properties.I_Lcm = RotatedInertia(X_LI.R, Inertia(*inertia, what));
    }
  }

  void ReadMass(const XmlElement& inertial, const std::string& what, UrdfLink* link) {
    const XmlElement* mass = OnlyChild(inertial, "mass", &errors_);
    if (mass == nullptr) {
      errors_.Add(inertial.line, fmt::format("<inertial> of {} lacks <mass value='...'>", what));
      return;
    }
    LeaveOutAllBut({}, {"value"}, *mass);
    const double value = Required(*mass, "value", what);
    if (value < 0) {
      errors_.Add(mass->line,
                  fmt::format("the mass of {}, {} kg, must not be negative", what, value));
    }
    link->mass_properties.mass = value;
  }

  Matrix3d Inertia(const XmlElement& element, const std::string& what) {
    LeaveOutAllBut({}, {"ixx", "iyy", "izz", "ixy", "ixz", "iyz"}, element);
    const auto moment = [&](const char* key) { return Required(element, key, what); };
    const auto product = [&](const char* key) { return errors_.Number(element, key, 0, what); };
    return InertiaFromElements(moment("ixx"), moment("iyy"), moment("izz"), product("ixy"),
                               product("ixz"), product("iyz"));
  }

  UrdfJointType Type(const XmlElement& element, const std::string& what) {
    static const std::vector<std::string> names{"revolute", "continuous", "prismatic",
                                                "planar",   "fixed",      "floating"};
    const std::string* type = element.Attribute("type");
    const auto found = type == nullptr ? names.end() : std::find(names.begin(), names.end(), *type);
    if (found == names.end()) {
      const std::string given = type == nullptr ? "" : *type;
      errors_.Add(element.line,
                  fmt::format("{} is of type {}, which is none of {}{}", what, Quoted(given),
                              fmt::join(names, ", "), DidYouMean(given, names)));
      return UrdfJointType::kFixed;
    }
    return static_cast<UrdfJointType>(found - names.begin());
  }

  std::string LinkOf(const XmlElement& joint, std::string_view end, const std::string& what) {
    const XmlElement* element = OnlyChild(joint, end, &errors_);
    const std::string* link = element == nullptr ? nullptr : element->Attribute("link");
    if (link != nullptr) return *link;
    errors_.Add(joint.line, fmt::format("{} lacks <{} link='...'>", what, end));
    return {};
  }

  void ReadJoint(const XmlElement& element) {
    UrdfJoint joint;
    joint.name = Name(element);
    joint.line = element.line;
    const std::string what = fmt::format("joint {}", Quoted(joint.name));
    LeaveOutAllBut({"origin", "parent", "child", "axis", "limit", "dynamics", "mimic"},
                   {"name", "type"}, element);
    joint.type = Type(element, what);
    joint.parent = LinkOf(element, "parent", what);
    joint.child = LinkOf(element, "child", what);
    joint.X_PC = Origin(element, what);
    ReadAxis(element, what, &joint);
    ReadLimits(element, what, &joint);
    ReadDynamics(element, what, &joint);
    if (const XmlElement* mimic = OnlyChild(element, "mimic", &errors_)) {
      const std::string* master = mimic->Attribute("joint");
      if (master == nullptr)
        errors_.Add(mimic->line, fmt::format("<mimic> of {} lacks 'joint'", what));
      if (master != nullptr) joint.mimics = *master;
    }
    robot_.joints.push_back(std::move(joint));
  }

  void ReadAxis(const XmlElement& element, const std::string& what, UrdfJoint* joint) {
    const XmlElement* axis = OnlyChild(element, "axis", &errors_);
    if (axis == nullptr) return;
    const size_t before = errors_.size();
    joint->axis = Vector(*axis, "xyz", Vector3d::UnitX(), what);
    const bool moves =
        joint->type != UrdfJointType::kFixed && joint->type != UrdfJointType::kFloating;
    if (moves && joint->axis == Vector3d::Zero() && errors_.size() == before) {
      errors_.Add(axis->line, fmt::format("the axis of {} has no length", what));
    }
  }

  void ReadLimits(const XmlElement& element, const std::string& what, UrdfJoint* joint) {
    const XmlElement* limit = OnlyChild(element, "limit", &errors_);
    if (limit == nullptr) return;
    LeaveOutAllBut({}, {"lower", "upper"}, *limit);
    joint->has_limits =
        limit->Attribute("lower") != nullptr || limit->Attribute("upper") != nullptr;
    joint->lower = errors_.Number(*limit, "lower", 0, what);
    joint->upper = errors_.Number(*limit, "upper", 0, what);
    if (joint->lower <= joint->upper) return;
    errors_.Add(limit->line, fmt::format("the lower limit of {}, {}, is above the upper one, {}",
                                         what, joint->lower, joint->upper));
  }

  void ReadDynamics(const XmlElement& element, const std::string& what, UrdfJoint* joint) {
    const XmlElement* dynamics = OnlyChild(element, "dynamics", &errors_);
    if (dynamics == nullptr) return;
    LeaveOutAllBut({}, {"damping", "friction"}, *dynamics);
    joint->damping = errors_.Number(*dynamics, "damping", 0, what);
    joint->friction = errors_.Number(*dynamics, "friction", 0, what);
    if (joint->damping >= 0 && joint->friction >= 0) return;
    errors_.Add(dynamics->line, fmt::format("damping {} and friction {} of {} must not be negative",
                                            joint->damping, joint->friction, what));
  }

  XmlErrors errors_;
  UrdfRobot robot_;
  LeftOut left_out_;
};

}  // namespace

UrdfRobot ParseUrdf(std::string_view text, const std::string& file) {
  return Parser(text, file).Take();
}

}  // namespace vmech
