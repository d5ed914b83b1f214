#include <fmt/format.h>

#include <unordered_map>

#include "vmech/mechanisms/exchange/mechanism_builder.h"
#include "vmech/mechanisms/exchange/urdf/urdf.h"
#include "vmech/mechanisms/exchange/urdf/urdf_robot.h"
#include "vmech/mechanisms/files/document.h"

namespace vmech {
namespace {

JointType TypeOf(UrdfJointType type) {
  switch (type) {
    case UrdfJointType::kRevolute:
    case UrdfJointType::kContinuous:
      return JointType::kRevolute;
    case UrdfJointType::kPrismatic:
      return JointType::kPrismatic;
    case UrdfJointType::kPlanar:
      return JointType::kPlanar;
    default:
      return JointType::kWeld;
  }
}

class Reader {
 public:
  Reader(const UrdfRobot& robot, std::string file, MechanismBuilder* builder)
      : file_(std::move(file)), builder_(*builder) {
    const std::vector<int> order = LinksFromRoot(robot, file_);
    const std::vector<int> parent_joints = ParentJoints(robot);
    for (const int link : order) {
      AddLink(robot.links[link]);
      if (parent_joints[link] >= 0) AddJoint(robot.joints[parent_joints[link]]);
    }
    if (!robot.left_out.empty()) {
      builder_.Note(fmt::format("left out: {}", fmt::join(robot.left_out, ", ")));
    }
  }

 private:
  void AddLink(const UrdfLink& link) {
    const MassProperties& properties = link.mass_properties;
    indices_[link.name] = builder_.AddLink(link.name, properties, {}, {file_, link.line});
    if (properties.mass == 0 || properties.I_Lcm != Matrix3d::Zero()) return;
    builder_.Note(fmt::format("link '{}' has a mass of {:.6g} kg and no inertia: a point ({}:{})",
                              link.name, properties.mass, file_, link.line));
  }

  void AddJoint(const UrdfJoint& joint) {
    const JointType type = TypeOf(joint.type);
    Posed X_CJ;
    if (type != JointType::kWeld) X_CJ.R = AxesAlong(joint.axis, Matrix3d::Identity());
    Joint& added = builder_.AddJoint(joint.name, type, indices_.at(joint.parent), joint.X_PC * X_CJ,
                                     indices_.at(joint.child), X_CJ);
    if (joint.type == UrdfJointType::kFloating) {
      builder_.NoteMended(
          {file_, joint.line},
          fmt::format("joint '{}' floats, and nothing that holds it is told", joint.name),
          fmt::format("link '{}' is welded to '{}' where it is drawn", joint.child, joint.parent));
    }
    if (!joint.mimics.empty()) {
      builder_.Note(
          fmt::format("joint '{}' mimics '{}': it moves by itself here", joint.name, joint.mimics));
    }
    if (FreedomsOf(type) == 1) AddDynamics(joint, &added);
    const bool more = joint.has_limits || joint.damping != 0 || joint.friction != 0;
    if (type == JointType::kPlanar && more) {
      builder_.Note(
          fmt::format("joint '{}' is planar: its limits, damping and friction are left "
                      "out",
                      joint.name));
    }
  }

  void AddDynamics(const UrdfJoint& joint, Joint* added) {
    added->passive[0].viscous = joint.damping;
    added->passive[0].coulomb = joint.friction;
    if (!joint.has_limits) return;
    if (joint.type == UrdfJointType::kContinuous) {
      builder_.Note(
          fmt::format("joint '{}' is continuous: its limits, {:.6g} and {:.6g}, are left "
                      "out",
                      joint.name, joint.lower, joint.upper));
    } else {
      builder_.SetLimits({file_, joint.line}, joint.lower, joint.upper, 0, added);
    }
  }

  const std::string file_;
  MechanismBuilder& builder_;
  std::unordered_map<std::string, int> indices_;
};

}  // namespace

ImportedMechanism ReadUrdf(const std::filesystem::path& path, const ImportOptions& options) {
  const std::string file = path.string();
  const UrdfRobot robot = ParseUrdf(ReadTextFile(path), file);
  MechanismBuilder builder(robot.name, options);
  const Reader reader(robot, file, &builder);
  if (!options.gravity_W) builder.Note("URDF has no gravity: 9.81 m/s^2 along -z");
  return builder.Finish(0, {0, 0, -9.81}, file);
}

}  // namespace vmech
