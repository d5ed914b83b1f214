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

#include "vmech/mechanisms/exchange/mechanism_builder.h"
#include "vmech/mechanisms/exchange/sdf/sdf.h"
#include "vmech/mechanisms/exchange/sdf/sdf_copies.h"
#include "vmech/mechanisms/exchange/sdf/sdf_document.h"
#include "vmech/mechanisms/exchange/xml/xml_text.h"
#include "vmech/mechanisms/files/document.h"

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
  Reader(const SdfCopies& copies, const sdf::Model& model, MechanismBuilder* builder)
      : copies_(copies), file_(copies.OriginalOf("").string()), builder_(*builder) {
    AddLinks(model, "", Resolved(model.SemanticPose(), ""), false);
    AddJoints(model, "");
    AddFrames(model, "");
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

  /// Of a model and those nested in it; those that are static are part of the ground.
  void AddLinks(const sdf::Model& model, const std::string& prefix, const Posed& X_WM,
                bool is_ground) {
    if (is_ground)
      builder_.Note(fmt::format("model '{}' is static: part of the ground", model.Name()));
    for (uint64_t i = 0; i < model.LinkCount(); ++i) {
      const sdf::Link& link = *model.LinkByIndex(i);
      const std::string name = prefix + link.Name();
      poses_[name] = X_WM * Resolved(link.SemanticPose(), "__model__");
      links_[name] =
          is_ground ? World()
                    : builder_.AddLink(name, Inertial(link, name), poses_[name], PlaceOf(link));
    }
    for (uint64_t i = 0; i < model.ModelCount(); ++i) {
      const sdf::Model& nested = *model.ModelByIndex(i);
      AddLinks(nested,
               prefix + nested.Name() + "::", X_WM * Resolved(nested.SemanticPose(), "__model__"),
               is_ground || nested.Static());
    }
  }

  /// Of the inertial, or of the link if it has none.
  Place PlaceOf(const sdf::Link& link) const {
    const sdf::ElementPtr element = link.Element()->HasElement("inertial")
                                        ? link.Element()->GetElement("inertial")
                                        : link.Element();
    return {copies_.OriginalOf(element->FilePath()).string(), element->LineNumber().value_or(0)};
  }

  void NoteDefaults(const sdf::Link& link, const std::string& name) {
    const sdf::ElementPtr element = link.Element();
    const sdf::ElementPtr inertial =
        element->HasElement("inertial") ? element->GetElement("inertial") : nullptr;
    const bool mass = inertial != nullptr && inertial->HasElement("mass");
    const bool inertia = inertial != nullptr && inertial->HasElement("inertia");
    if (mass && inertia) return;
    const Place place = PlaceOf(link);
    builder_.Note(fmt::format("link '{}' has no {}: {} by SDF's default ({}:{})", name,
                              inertial == nullptr ? "inertial"
                              : mass              ? "inertia"
                                                  : "mass",
                              mass      ? "1 kg m^2"
                              : inertia ? "1 kg"
                                        : "1 kg and 1 kg m^2",
                              place.file, place.line));
  }

  MassProperties Inertial(const sdf::Link& link, const std::string& name) {
    NoteDefaults(link, name);
    const ignition::math::Inertiald& inertial = link.Inertial();
    const double mass = inertial.MassMatrix().Mass();
    const ignition::math::Matrix3d I = inertial.Moi();  // about the centre of mass, axes of L
    Matrix3d I_Lcm;
    I_Lcm << I(0, 0), I(0, 1), I(0, 2), I(1, 0), I(1, 1), I(1, 2), I(2, 0), I(2, 1), I(2, 2);
    const bool next_to_none = mass > 0 && mass <= kNextToNoMass;  // as WriteSdf has it
    if (next_to_none) return {};
    return {mass, FromSdf(inertial.Pose().Pos()), 0.5 * (I_Lcm + I_Lcm.transpose())};
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
    return name == "world" ? World() : links_.at(prefix + name);
  }

  int World() {
    if (!ground_) ground_ = builder_.AddLink("world", {}, {});
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
      AddLimits(joint, i, &added);
    }
  }

  double ThreadPitch(const sdf::Joint& joint) const {
    const bool given = joint.Element()->HasElement("thread_pitch");
    if (given && joint.ThreadPitch() != 0) return joint.ThreadPitch();
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

  static void AddDynamics(const sdf::JointAxis& axis, size_t i, Joint* joint) {
    joint->passive[i] = {axis.SpringStiffness(), axis.SpringReference(), axis.Damping(),
                         axis.Friction()};
    if (axis.SpringStiffness() == 0) joint->passive[i].rest = 0;
  }

  void AddLimits(const sdf::Joint& from, size_t i, Joint* joint) {
    constexpr double kUnlimited = 1e15;  // SDF's default limits are 1e16 or infinite
    const auto bound = [](double value) {
      return std::abs(value) < kUnlimited ? value : std::copysign(INFINITY, value);
    };
    const sdf::JointAxis& axis = *from.Axis(static_cast<unsigned>(i));
    const Place place{copies_.OriginalOf(from.Element()->FilePath()).string(),
                      from.Element()->LineNumber().value_or(0)};
    builder_.SetLimits(place, bound(axis.Lower()), bound(axis.Upper()), i, joint);
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

  const SdfCopies& copies_;
  const std::string file_;
  MechanismBuilder& builder_;
  std::map<std::string, int> links_;
  std::map<std::string, Posed> poses_;
  std::optional<int> ground_;
};

/// libsdformat's errors with the lines that it knows. Some messages quote the whole file.
FileErrors Collected(const SdfCopies& copies, const sdf::Errors& errors) {
  constexpr size_t kLongest = 200;
  std::vector<FileError> list;
  for (const sdf::Error& error : errors) {
    std::string message = error.Message().substr(0, kLongest);
    message.resize(std::min(message.size(), message.find('\n')));
    list.push_back({copies.OriginalOf(error.FilePath().value_or("")).string(),
                    error.LineNumber().value_or(0), 1, "", std::move(message)});
  }
  return FileErrors(std::move(list));
}

/// Inertias that no body has are mended later, and are no reason to refuse a file here.
sdf::Errors WithoutInertias(sdf::Errors errors) {
  const auto is_inertia = [](const sdf::Error& error) {
    return error.Code() == sdf::ErrorCode::LINK_INERTIA_INVALID;
  };
  const auto is_sequel = [](const sdf::Error& error) {
    return error.Message() == "Failed to load a world.";
  };
  const auto end = std::remove_if(errors.begin(), errors.end(), is_inertia);
  if (end == errors.end()) return errors;
  errors.erase(end, errors.end());
  if (std::all_of(errors.begin(), errors.end(), is_sequel)) return {};
  return errors;
}

struct ChosenModel {
  const sdf::Model* model = nullptr;
  const sdf::World* world = nullptr;  ///< none: the file has no world
};

std::vector<ChosenModel> AllModels(const sdf::Root& root) {
  std::vector<ChosenModel> models;
  if (root.Model() != nullptr) models.push_back({root.Model(), nullptr});
  for (uint64_t w = 0; w < root.WorldCount(); ++w) {
    const sdf::World* world = root.WorldByIndex(w);
    for (uint64_t i = 0; i < world->ModelCount(); ++i) {
      models.push_back({world->ModelByIndex(i), world});
    }
  }
  return models;
}

/// The model that is asked for, or the only one that moves. The others are told.
ChosenModel Choose(const std::string& file, const sdf::Root& root, const std::string& asked,
                   std::vector<std::string>* notes) {
  std::vector<ChosenModel> fitting;
  std::vector<std::string> names;
  for (const ChosenModel& each : AllModels(root)) {
    names.push_back(each.model->Name());
    const bool fits = asked.empty() ? !each.model->Static() : each.model->Name() == asked;
    if (fits) {
      fitting.push_back(each);
    } else {
      notes->push_back(fmt::format("model '{}' {}", each.model->Name(),
                                   asked.empty() ? "is static: left out" : "is left out"));
    }
  }
  if (fitting.size() == 1) return fitting[0];
  if (!fitting.empty()) {
    throw FileErrors(file, fmt::format("holds several models that move: {}; a mechanism is one: "
                                       "name it (--model), or nest them in a model",
                                       fmt::join(names, ", ")));
  }
  if (asked.empty()) throw FileErrors(file, "there is no model that moves in it");
  throw FileErrors(
      file, fmt::format("there is no model {} in it{}", Quoted(asked), DidYouMean(asked, names)));
}

Vector3d GravityOf(const sdf::World& world, const SdfDocument& document) {
  XmlErrors ignored("");
  for (const XmlElement& each : document.main().root.children) {
    const std::string* name = each.Attribute("name");
    if (each.name != "world" || name == nullptr || *name != world.Name()) continue;
    for (const XmlElement& child : each.children) {
      if (child.name != "gravity") continue;
      const std::vector<double> g = ignored.Numbers(child.text, 3, child.line, "gravity");
      return {g[0], g[1], g[2]};
    }
  }
  return FromSdf(world.Gravity());
}

void AddCounts(const sdf::Model& model, uint64_t* links, uint64_t* joints) {
  *links += model.LinkCount();
  *joints += model.JointCount();
  for (uint64_t i = 0; i < model.ModelCount(); ++i) {
    AddCounts(*model.ModelByIndex(i), links, joints);
  }
}

/// Of what is wrong with an included file libsdformat prints some and leaves the part out.
void RequireAllParts(const SdfDocument& document, const sdf::Root& root, bool join_worlds) {
  uint64_t links = 0, joints = 0;
  for (const ChosenModel& each : AllModels(root)) AddCounts(*each.model, &links, &joints);
  const auto require = [&](uint64_t loaded, const char* name) {
    const int written = CountElements(document, name, join_worlds);
    if (loaded == static_cast<uint64_t>(written)) return;
    throw FileErrors(document.main().path.string(),
                     fmt::format("libsdformat takes {} of {} <{}> of this file and those that it "
                                 "includes: is each of them right by itself?",
                                 loaded, written, name));
  };
  require(links, "link");
  require(joints, "joint");
}

void Load(const SdfDocument& document, const SdfCopies& copies, bool join_worlds, sdf::Root* root) {
  sdf::Console::Instance()->SetQuiet(true);
  sdf::ParserConfig config;
  config.SetWarningsPolicy(sdf::EnforcementPolicy::LOG);
  const sdf::Errors errors = WithoutInertias(root->LoadSdfString(copies.main(), config));
  if (!errors.empty()) throw Collected(copies, errors);
  RequireAllParts(document, *root, join_worlds);
}

}  // namespace

bool HasSdfReader() {
  return true;
}

ImportedMechanism ReadSdf(const std::filesystem::path& path, const ImportOptions& options) {
  const std::string file = path.string();
  const SdfDocument document = ReadSdfDocument(path);
  const bool join_worlds = options.model.empty();
  const SdfCopies copies(document, join_worlds);
  sdf::Root root;
  Load(document, copies, join_worlds, &root);
  std::vector<std::string> notes;
  const ChosenModel chosen = Choose(file, root, options.model, &notes);
  MechanismBuilder builder(chosen.model->Name(), options);
  for (const std::string& note : notes) builder.Note(note);
  if (!document.left_out.empty()) {
    builder.Note(fmt::format("left out: {}", fmt::join(document.left_out, ", ")));
  }
  const Reader reader(copies, *chosen.model, &builder);
  Vector3d gravity_W(0, 0, -9.81);
  if (chosen.world != nullptr) {
    gravity_W = GravityOf(*chosen.world, document);
  } else if (!options.gravity_W) {
    builder.Note("a model has no gravity of its own: 9.81 m/s^2 along -z");
  }
  return builder.Finish(reader.ground(), gravity_W, file);
}

}  // namespace vmech
