#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sdf/Console.hh>
#include <sdf/Frame.hh>
#include <sdf/Joint.hh>
#include <sdf/JointAxis.hh>
#include <sdf/Link.hh>
#include <sdf/Model.hh>
#include <sdf/ParserConfig.hh>
#include <sdf/Root.hh>
#include <sdf/World.hh>

#include "vmech/mechanisms/document.h"
#include "vmech/mechanisms/exchange/mechanism_builder.h"
#include "vmech/mechanisms/exchange/sdf.h"
#include "vmech/mechanisms/exchange/xml_text.h"

namespace vmech {
namespace {

Vector3d FromSdf(const ignition::math::Vector3d& v) {
  return {v.X(), v.Y(), v.Z()};
}

Posed FromSdf(const ignition::math::Pose3d& X) {
  const auto& q = X.Rot();
  return {Eigen::Quaterniond(q.W(), q.X(), q.Y(), q.Z()).normalized().toRotationMatrix(),
          FromSdf(X.Pos())};
}

class Reader {
 public:
  Reader(std::string file, const sdf::Model& model, MechanismBuilder* builder)
      : file_(std::move(file)), builder_(*builder) {
    AddLinks(model, "", Resolved(model.SemanticPose(), ""));
    AddJoints(model, "");
    AddFrames(model, "");
    if (left_out_ > 0) builder_.Note("visuals, collisions and sensors are left out");
  }

  /// The link that a fixed joint holds to the world, or a link for the world itself.
  std::optional<int> ground() const { return ground_; }

 private:
  [[noreturn]] void Fail(const std::string& message) const { throw FileErrors(file_, message); }

  void Require(const sdf::Errors& errors) const {
    if (!errors.empty()) Fail(errors[0].Message());
  }

  Posed Resolved(const sdf::SemanticPose& pose, const std::string& relative_to) const {
    ignition::math::Pose3d X;
    Require(pose.Resolve(X, relative_to));
    return FromSdf(X);
  }

  void AddLinks(const sdf::Model& model, const std::string& prefix, const Posed& X_WM) {
    for (uint64_t i = 0; i < model.LinkCount(); ++i) {
      const sdf::Link& link = *model.LinkByIndex(i);
      const Posed X_WL = X_WM * Resolved(link.SemanticPose(), "__model__");
      poses_[prefix + link.Name()] = X_WL;
      links_[prefix + link.Name()] = builder_.AddLink(prefix + link.Name(), Inertial(link), X_WL);
      left_out_ += link.VisualCount() + link.CollisionCount() + link.SensorCount();
    }
    for (uint64_t i = 0; i < model.ModelCount(); ++i) {
      const sdf::Model& nested = *model.ModelByIndex(i);
      AddLinks(nested,
               prefix + nested.Name() + "::", X_WM * Resolved(nested.SemanticPose(), "__model__"));
    }
  }

  MassProperties Inertial(const sdf::Link& link) {
    if (link.Element() != nullptr && !link.Element()->HasElement("inertial")) {
      builder_.Note(fmt::format("link '{}' has no inertial: 1 kg and 1 kg m^2 by SDF's default",
                                link.Name()));
    }
    const ignition::math::Inertiald& inertial = link.Inertial();
    if (inertial.MassMatrix().Mass() <= kNextToNoMass) return {};
    const ignition::math::Matrix3d I = inertial.Moi();  // about the centre of mass, axes of L
    Matrix3d I_Lcm;
    I_Lcm << I(0, 0), I(0, 1), I(0, 2), I(1, 0), I(1, 1), I(1, 2), I(2, 0), I(2, 1), I(2, 2);
    return {inertial.MassMatrix().Mass(), FromSdf(inertial.Pose().Pos()),
            0.5 * (I_Lcm + I_Lcm.transpose())};
  }

  void AddJoints(const sdf::Model& model, const std::string& prefix) {
    int to_world = 0;
    for (uint64_t i = 0; i < model.JointCount(); ++i) {
      const sdf::Joint& joint = *model.JointByIndex(i);
      to_world += joint.ParentLinkName() == "world" || joint.ChildLinkName() == "world" ? 1 : 0;
    }
    for (uint64_t i = 0; i < model.JointCount(); ++i) {
      AddJoint(*model.JointByIndex(i), prefix, to_world == 1);
    }
    for (uint64_t i = 0; i < model.ModelCount(); ++i) {
      const sdf::Model& nested = *model.ModelByIndex(i);
      AddJoints(nested, prefix + nested.Name() + "::");
    }
  }

  int LinkIndex(const std::string& name, const std::string& prefix) {
    if (name != "world") return links_.at(prefix + name);
    if (!ground_) {
      ground_ = builder_.AddLink("world", {}, {});
      poses_["world"] = Posed();
    }
    return *ground_;
  }

  void AddJoint(const sdf::Joint& joint, const std::string& prefix, bool only_one_to_world) {
    std::string parent, child;
    Require(joint.ResolveParentLink(parent));
    Require(joint.ResolveChildLink(child));
    const bool to_world = parent == "world" || child == "world";
    if (joint.Type() == sdf::JointType::FIXED && to_world && only_one_to_world && !ground_) {
      ground_ = links_.at(prefix + (parent == "world" ? child : parent));
      return;
    }
    const int first = LinkIndex(parent, prefix), second = LinkIndex(child, prefix);
    const Posed X_CJ = Resolved(joint.SemanticPose(), child);
    const Posed X_WJ = (child == "world" ? Posed() : poses_.at(prefix + child)) * X_CJ;
    const JointType type = TypeOf(joint);
    const Posed X_WF{X_WJ.R * Axes(joint, type), X_WJ.p};
    Joint& added = builder_.AddJoint(prefix + joint.Name(), type, first, second, X_WF);
    if (type == JointType::kScrew) added.pitch = -1 / ThreadPitch(joint);
    for (size_t i = 0; i < added.passive.size() && joint.Axis(static_cast<unsigned>(i)); ++i) {
      AddDynamics(*joint.Axis(static_cast<unsigned>(i)), i, &added);
    }
  }

  double ThreadPitch(const sdf::Joint& joint) const {
    if (joint.ThreadPitch() != 0 && std::isfinite(joint.ThreadPitch())) return joint.ThreadPitch();
    Fail(fmt::format("joint '{}': a screw needs a thread_pitch that is not zero", joint.Name()));
  }

  JointType TypeOf(const sdf::Joint& joint) const {
    switch (joint.Type()) {
      case sdf::JointType::REVOLUTE:
      case sdf::JointType::CONTINUOUS:
        return JointType::kRevolute;
      case sdf::JointType::PRISMATIC:
        return JointType::kPrismatic;
      case sdf::JointType::SCREW:
        return JointType::kScrew;
      case sdf::JointType::UNIVERSAL:
        return JointType::kUniversal;
      case sdf::JointType::BALL:
        return JointType::kSpherical;
      case sdf::JointType::FIXED:
        return JointType::kWeld;
      default:
        Fail(
            fmt::format("joint '{}': joints of type gearbox and revolute2 have no counterpart "
                        "here; model their parts as links",
                        joint.Name()));
    }
  }

  Vector3d Axis(const sdf::Joint& joint, unsigned index) const {
    ignition::math::Vector3d xyz;
    if (joint.Axis(index) == nullptr) {
      Fail(fmt::format("joint '{}': an axis is missing", joint.Name()));
    }
    Require(joint.Axis(index)->ResolveXyz(xyz));
    return FromSdf(xyz);
  }

  /// The joint's axes, in the axes of the SDF joint frame.
  Matrix3d Axes(const sdf::Joint& joint, JointType type) const {
    constexpr double kSquare = 1e-9;
    if (type == JointType::kSpherical || type == JointType::kWeld) return Matrix3d::Identity();
    if (type != JointType::kUniversal) return AxesAlong(Axis(joint, 0), Matrix3d::Identity());
    const Vector3d x = Axis(joint, 0).normalized(), y = Axis(joint, 1).normalized();
    if (std::abs(x.dot(y)) > kSquare) {
      Fail(fmt::format("joint '{}': the axes of a universal joint must be square to each other",
                       joint.Name()));
    }
    return AxesFromZX(x.cross(y), x);
  }

  void AddDynamics(const sdf::JointAxis& axis, size_t i, Joint* joint) const {
    constexpr double kUnlimited = 1e15;  // SDF's default limits are 1e16 or infinite
    if (axis.Lower() > -kUnlimited) joint->lower[i] = axis.Lower();
    if (axis.Upper() < kUnlimited) joint->upper[i] = axis.Upper();
    joint->passive[i] = {axis.SpringStiffness(), axis.SpringReference(), axis.Damping(),
                         axis.Friction()};
    if (axis.SpringStiffness() == 0) joint->passive[i].rest = 0;
  }

  void AddFrames(const sdf::Model& model, const std::string& prefix) {
    for (uint64_t i = 0; i < model.FrameCount(); ++i) {
      const sdf::Frame& frame = *model.FrameByIndex(i);
      std::string link;
      Require(frame.ResolveAttachedToBody(link));
      const auto found = links_.find(prefix + link);
      if (found == links_.end()) continue;
      builder_.AddGrasp(prefix + frame.Name(), found->second, Resolved(frame.SemanticPose(), link));
    }
    for (uint64_t i = 0; i < model.ModelCount(); ++i) {
      const sdf::Model& nested = *model.ModelByIndex(i);
      AddFrames(nested, prefix + nested.Name() + "::");
    }
  }

  const std::string file_;
  MechanismBuilder& builder_;
  std::map<std::string, int> links_;
  std::map<std::string, Posed> poses_;
  std::optional<int> ground_;
  uint64_t left_out_ = 0;
};

/// libsdformat's errors with the lines that it knows. Some messages quote the whole file.
FileErrors Collected(const std::string& file, const sdf::Errors& errors) {
  constexpr size_t kLongest = 200;
  std::vector<FileError> list;
  for (const sdf::Error& error : errors) {
    std::string message = error.Message().substr(0, kLongest);
    message.resize(std::min(message.size(), message.find('\n')));
    list.push_back({file, error.LineNumber().value_or(0), 1, "", std::move(message)});
  }
  return FileErrors(std::move(list));
}

/// The one model that moves.
const sdf::Model& OnlyModel(const std::string& file, const sdf::Root& root,
                            std::vector<std::string>* notes) {
  if (root.Model() != nullptr) return *root.Model();
  const sdf::World* world = root.WorldCount() > 0 ? root.WorldByIndex(0) : nullptr;
  const sdf::Model* only = nullptr;
  for (uint64_t i = 0; world != nullptr && i < world->ModelCount(); ++i) {
    const sdf::Model& model = *world->ModelByIndex(i);
    if (model.Static()) {
      notes->push_back(fmt::format("model '{}' is static: left out", model.Name()));
      continue;
    }
    if (only != nullptr) {
      throw FileErrors(file, fmt::format("holds several models that move, '{}' and '{}'; a "
                                         "mechanism is one: keep one, or nest them in a model",
                                         only->Name(), model.Name()));
    }
    only = &model;
  }
  if (only == nullptr) throw FileErrors(file, "there is no model that moves in it");
  return *only;
}

}  // namespace

bool HasSdfReader() {
  return true;
}

ImportedMechanism ReadSdf(const std::filesystem::path& path, const ImportOptions& options) {
  const std::string file = path.string(), text = ReadTextFile(path);
  // libsdformat would try whether it is URDF, and say so on the terminal.
  if (text.find("<sdf") == text.npos) throw FileErrors(file, "there is no <sdf> in it");
  if (text.find("</sdf>") == text.npos) throw FileErrors(file, "it ends without </sdf>: cut off?");
  RequireShallowXml(text, file);
  sdf::Console::Instance()->SetQuiet(true);
  sdf::ParserConfig config;
  config.SetWarningsPolicy(sdf::EnforcementPolicy::LOG);
  sdf::Root root;
  const sdf::Errors errors = root.LoadSdfString(text, config);
  if (!errors.empty()) throw Collected(file, errors);
  std::vector<std::string> notes;
  const sdf::Model& model = OnlyModel(file, root, &notes);
  MechanismBuilder builder(model.Name());
  for (const std::string& note : notes) builder.Note(note);
  const Reader reader(file, model, &builder);
  Vector3d gravity_W(0, 0, -9.81);
  if (root.WorldCount() > 0) {
    gravity_W = FromSdf(root.WorldByIndex(0)->Gravity());
  } else if (!options.gravity_W) {
    builder.Note("a model has no gravity of its own: 9.81 m/s^2 along -z");
  }
  return builder.Finish(options, reader.ground(), gravity_W, file);
}

}  // namespace vmech
