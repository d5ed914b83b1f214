#include <console_bridge/console.h>
#include <fmt/format.h>
#include <urdf_model/link.h>
#include <urdf_parser/urdf_parser.h>

#include <map>
#include <mutex>

#include "vmech/mechanisms/document.h"
#include "vmech/mechanisms/exchange/mechanism_builder.h"
#include "vmech/mechanisms/exchange/urdf.h"
#include "vmech/mechanisms/exchange/xml_text.h"
#include "vmech/mechanisms/mass_properties.h"

namespace vmech {
namespace {

/// Keeps what urdfdom says instead of printing it. Its handler is one for the process.
class Messages : public console_bridge::OutputHandler {
 public:
  Messages() : lock_(Mutex()) { console_bridge::useOutputHandler(this); }
  ~Messages() override { console_bridge::restorePreviousOutputHandler(); }
  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR) errors.push_back(text);
  }
  std::vector<std::string> errors;

 private:
  static std::mutex& Mutex() {
    static std::mutex mutex;
    return mutex;
  }
  const std::lock_guard<std::mutex> lock_;
};

Vector3d FromUrdf(const urdf::Vector3& v) {
  return {v.x, v.y, v.z};
}

Posed FromUrdf(const urdf::Pose& X) {
  const urdf::Rotation& q = X.rotation;
  return {Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized().toRotationMatrix(),
          FromUrdf(X.position)};
}

MassProperties InertialOf(const urdf::Link& link) {
  if (link.inertial == nullptr) return {};
  const urdf::Inertial& inertial = *link.inertial;
  const Posed X_LI = FromUrdf(inertial.origin);
  return {inertial.mass, X_LI.p,
          RotatedInertia(X_LI.R, InertiaFromElements(inertial.ixx, inertial.iyy, inertial.izz,
                                                     inertial.ixy, inertial.ixz, inertial.iyz))};
}

class Reader {
 public:
  Reader(std::string file, const urdf::ModelInterface& model, MechanismBuilder* builder)
      : file_(std::move(file)), builder_(*builder) {
    RequireTree(model);
    AddLinks(*model.getRoot());
    if (left_out_) builder_.Note("visuals and collisions are left out");
  }

 private:
  /// urdfdom keeps the last of two parents and says nothing.
  void RequireTree(const urdf::ModelInterface& model) const {
    std::map<std::string, std::string> carried_by;
    for (const auto& [name, joint] : model.joints_) {
      const auto [entry, first] = carried_by.emplace(joint->child_link_name, name);
      if (first) continue;
      throw FileErrors(
          file_, fmt::format("link '{}' is the child of two joints, '{}' and '{}', and URDF is a "
                             "tree: take one out and close the loop in a side file (--loops)",
                             joint->child_link_name, entry->second, name));
    }
  }

  /// From the root on, depth first; without recursion, whatever the file is.
  void AddLinks(const urdf::Link& root) {
    struct Entry {
      const urdf::Link* link;
      int parent;
    };
    std::vector<Entry> waiting{{&root, -1}};
    while (!waiting.empty()) {
      const auto [link, parent] = waiting.back();
      waiting.pop_back();
      const int index = builder_.AddLink(link->name, InertialOf(*link), {});
      left_out_ |= !link->visual_array.empty() || !link->collision_array.empty();
      if (parent >= 0) AddJoint(*link->parent_joint, parent, index);
      for (auto child = link->child_links.rbegin(); child != link->child_links.rend(); ++child) {
        waiting.push_back({child->get(), index});
      }
    }
  }

  void AddJoint(const urdf::Joint& joint, int parent, int child) {
    const JointType type = TypeOf(joint);
    Posed X_CJ;
    if (type != JointType::kWeld) {
      if (joint.axis.x == 0 && joint.axis.y == 0 && joint.axis.z == 0) {
        throw FileErrors(file_, fmt::format("joint '{}': its axis has no length", joint.name));
      }
      X_CJ.R = AxesAlong(FromUrdf(joint.axis), Matrix3d::Identity());
    }
    Joint& added =
        builder_.AddJoint(joint.name, type, parent,
                          FromUrdf(joint.parent_to_joint_origin_transform) * X_CJ, child, X_CJ);
    if (joint.mimic != nullptr) {
      builder_.Note(fmt::format("joint '{}' mimics '{}': it moves by itself here", joint.name,
                                joint.mimic->joint_name));
    }
    if (FreedomsOf(type) != 1) return;
    if (joint.dynamics != nullptr) {
      added.passive[0].viscous = joint.dynamics->damping;
      added.passive[0].coulomb = joint.dynamics->friction;
    }
    const bool limited = joint.type != urdf::Joint::CONTINUOUS && joint.limits != nullptr;
    if (limited && joint.limits->lower < joint.limits->upper) {
      added.lower[0] = joint.limits->lower;
      added.upper[0] = joint.limits->upper;
    }
  }

  JointType TypeOf(const urdf::Joint& joint) const {
    switch (joint.type) {
      case urdf::Joint::REVOLUTE:
      case urdf::Joint::CONTINUOUS:
        return JointType::kRevolute;
      case urdf::Joint::PRISMATIC:
        return JointType::kPrismatic;
      case urdf::Joint::PLANAR:
        return JointType::kPlanar;
      case urdf::Joint::FIXED:
        return JointType::kWeld;
      default:
        throw FileErrors(file_, fmt::format("joint '{}' is of type floating or unknown: a link "
                                            "that nothing holds is not part of a mechanism",
                                            joint.name));
    }
  }

  const std::string file_;
  MechanismBuilder& builder_;
  bool left_out_ = false;
};

}  // namespace

bool HasUrdfReader() {
  return true;
}

ImportedMechanism ReadUrdf(const std::filesystem::path& path, const ImportOptions& options) {
  const std::string file = path.string(), text = ReadTextFile(path);
  RequireShallowXml(text, file);
  urdf::ModelInterfaceSharedPtr model;
  {
    Messages messages;
    try {
      model = urdf::parseURDF(text);
    } catch (const std::exception& error) {
      throw FileErrors(file, error.what());
    }
    if (model == nullptr || model->getRoot() == nullptr) {
      throw FileErrors(
          file, messages.errors.empty() ? "is not a robot of URDF" : messages.errors.front());
    }
  }
  MechanismBuilder builder(model->getName());
  const Reader reader(file, *model, &builder);
  if (!options.gravity_W) builder.Note("URDF has no gravity: 9.81 m/s^2 along -z");
  return builder.Finish(options, 0, {0, 0, -9.81}, file);
}

}  // namespace vmech
