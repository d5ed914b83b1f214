#include "vmech/mechanisms/cad/mechanism_from_cad.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <set>
#include <stdexcept>

#include "vmech/mechanisms/cad/anchors.h"
#include "vmech/mechanisms/cad/joint_fit.h"
#include "vmech/mechanisms/cad/tidy.h"
#include "vmech/mechanisms/files/document.h"
#include "vmech/mechanisms/graph.h"

namespace vmech {
namespace {

const Vector3d kUsualGravity{0, 0, -9.81};  // [m/s^2]
constexpr double kWorthSayingGap = 1e-5;    // [m]
constexpr double kWorthSayingSkew = 1e-3;   // [rad]

/// Makes the mechanism step by step; what is wrong is collected and thrown at the end.
class Importer {
 public:
  Importer(const CadAssembly& assembly, const CadImportOptions& options)
      : assembly_(assembly), options_(options) {
    result_.file = assembly.file;
    result_.unit = assembly.unit;
    result_.remarks = assembly.remarks;
    result_.mechanism.name =
        options.name.empty() ? std::filesystem::path(assembly.file).stem().string() : options.name;
    result_.mechanism.gravity_W = options.gravity_W.value_or(kUsualGravity);
    if (!options.gravity_W) Guess("gravity is 9.81 m/s^2 against z (--gravity)");
  }

  CadImport Run() {
    bodies_ = FindBodies(assembly_, options_.bodies, &loose_frames_);
    if (bodies_.empty()) Error("no part is left");
    ThrowErrors();
    result_.merges =
        MergeBodies(assembly_, options_.bodies, options_.contacts, options_.ground, &bodies_);
    GuessFasteners();
    ChooseGround();
    AddLinks();
    CollectFrames();
    AddNamedJoints();
    ProposeJoints();
    FindMisses();
    CheckOptions();
    ThrowErrors();
    CheckConnected();
    ThrowErrors();
    Tidy(&result_.mechanism);
    return std::move(result_);
  }

 private:
  void Error(std::string message) {
    errors_.push_back({assembly_.file, 0, 0, "", std::move(message)});
  }
  void ThrowErrors() {
    if (!errors_.empty()) throw FileErrors(errors_);
  }

  std::vector<std::string> BodyNames() const {
    std::vector<std::string> names;
    for (const CadBody& body : bodies_) names.push_back(body.name);
    return names;
  }

  void ChooseGround() {
    int& ground = result_.mechanism.ground;
    const std::vector<std::string> names = BodyNames();
    const auto find = [&](auto matches) {
      return static_cast<int>(std::find_if(names.begin(), names.end(), matches) - names.begin());
    };
    const int count = static_cast<int>(names.size());
    if (!options_.ground.empty()) {
      ground = find([&](const std::string& name) { return name == options_.ground; });
      if (ground < count) return;
      Error(fmt::format("there is no body {} to be the ground{}", Quoted(options_.ground),
                        DidYouMean(options_.ground, names)));
      return ThrowErrors();
    }
    ground = find(IsUsualGround);
    if (ground < count) {
      Guess(fmt::format("{} is the ground, by its name (--ground)", Quoted(names[ground])));
    } else if (!loose_frames_.empty()) {
      bodies_.push_back({"ground", {}, {}, {}});
      Guess("the frames directly in the file are the ground (--ground)");
    } else {
      ground = 0;
      Guess(fmt::format("{} is the ground, being the first (--ground)", Quoted(names[0])));
    }
  }

  void Guess(std::string text) { result_.guesses.push_back(std::move(text)); }

  /// The ground's drawing axes are those of the world, hence of the file.
  void AddLinks() {
    Mechanism& mechanism = result_.mechanism;
    bodies_[mechanism.ground].X_WL = Posed();
    options_.densities.Validate();
    for (const CadBody& body : bodies_) {
      const int link = static_cast<int>(mechanism.links.size());
      const BodyMass mass = WeighBody(assembly_, body, options_.densities);
      mechanism.links.push_back({body.name, mass.mass_properties, {}});
      for (const std::string& defect : mass.defects) {
        if (link == mechanism.ground) {
          result_.remarks.push_back(defect +
                                    "; it is part of the ground, whose mass plays no part");
        } else {
          Error(defect + "; or leave it out (--ignore)");
        }
      }
      if (link == mechanism.ground && !mass.defects.empty()) {
        mechanism.links.back().mass_properties = {};
      }
      result_.bodies.push_back({link, body.X_WL, mass});
      features_.push_back(FeaturesOf(assembly_, body));
    }
    GuessDensities();
  }

  void GuessFasteners() {
    std::string names;
    for (const BodyMerge& merge : result_.merges) {
      if (merge.is_guess) names += (names.empty() ? "" : ", ") + merge.body;
    }
    if (names.empty()) return;
    Guess(fmt::format("fasteners, which belong to what they sit in: {} (--moving)", names));
  }

  void GuessDensities() {
    std::string names;
    int count = 0;
    for (const ImportedBody& body : result_.bodies) {
      for (const BodyMass::Part& part : body.mass.parts) {
        if (!part.assumed || body.link == result_.mechanism.ground) continue;
        names += (count++ > 0 ? ", " : "") + part.name;
      }
    }
    if (count == 0) return;
    Guess(fmt::format("density of {:g} kg/m^3 for {} (--density)", kUsualDensity, names));
  }

  void CollectFrames() {
    for (int b = 0; b < static_cast<int>(bodies_.size()); ++b) {
      for (const int f : bodies_[b].frames) CollectFrame(b, assembly_.frames[f]);
    }
    for (const int f : loose_frames_) {
      CollectFrame(result_.mechanism.ground, assembly_.frames[f]);
    }
    for (const CadFrame& frame : assembly_.frames) {
      if (ParseFrameName(frame.name).role != FrameName::Role::kNone) continue;
      result_.remarks.push_back(
          fmt::format("frame {} is passed over: its name begins with none of anchor_, dof_, "
                      "closing_, fix_, frame_, grasp_",
                      Quoted(frame.name)));
    }
  }

  void CollectFrame(int body, const CadFrame& frame) {
    BodyFrame taken{body, frame.name, ParseFrameName(frame.name), frame.X_WF};
    if (!taken.name.error.empty()) {
      Error(fmt::format("frame {} of {}: {}", Quoted(frame.name), Quoted(bodies_[body].name),
                        taken.name.error));
    }
    if (taken.name.inverted) {
      taken.X_WA.R.col(1) *= -1;
      taken.X_WA.R.col(2) *= -1;
    }
    Link& link = result_.mechanism.links[body];
    const Posed X_LA = bodies_[body].X_WL.inverse() * taken.X_WA;
    switch (taken.name.role) {
      case FrameName::Role::kGrasp:
        AddGrasp(body, taken.name, X_LA);
        break;
      case FrameName::Role::kAnchor:
        AddAnchor(&link, taken.name.name, X_LA);
        break;
      default:
        frames_.push_back(taken);
    }
  }

  void AddGrasp(int body, const FrameName& name, const Posed& X_LG) {
    if (FindGrasp(result_.mechanism, name.name) >= 0) {
      Error(fmt::format("grasp {} is there twice; give each a name of its own", Quoted(name.name)));
      return;
    }
    result_.mechanism.grasps.push_back({name.name, body, X_LG, name.grasp});
  }

  int AddAnchor(Link* link, const std::string& name, const Posed& X_LA) {
    const auto is_there = [&](const std::string& candidate) {
      return std::any_of(link->anchors.begin(), link->anchors.end(),
                         [&](const Anchor& anchor) { return anchor.name == candidate; });
    };
    std::string free = name;
    for (int number = 2; is_there(free); ++number) free = fmt::format("{}-{}", name, number);
    link->anchors.push_back({free, X_LA});
    return static_cast<int>(link->anchors.size()) - 1;
  }

  void AddNamedJoints() {
    const AnchorMatches matches = MatchAnchors(frames_);
    for (const std::string& error : matches.errors) Error(error);
    for (const AnchorPair& pair : matches.pairs) AddNamedJoint(pair);
    for (const BodyFrame& frame : matches.unmatched) AddUnmatched(frame, matches.unmatched);
  }

  /// The user's word, that of the frames, or revolute.
  JointType TypeOf(const AnchorPair& pair, bool* assumed) {
    const std::string& name = pair.first.name.name;
    for (const auto& [joint, type] : options_.joint_types) {
      if (joint == name) return type;
    }
    const auto &one = pair.first.name.type, &other = pair.second.name.type;
    if (one && other && *one != *other) {
      Error(fmt::format("joint {} is {} by frame {} and {} by frame {}; name both alike",
                        Quoted(name), NameOf(*one), Quoted(pair.first.frame), NameOf(*other),
                        Quoted(pair.second.frame)));
    }
    *assumed = !one && !other;
    return one ? *one : other ? *other : JointType::kRevolute;
  }

  void AddNamedJoint(const AnchorPair& pair) {
    ImportedJoint imported;
    const JointType type = TypeOf(pair, &imported.type_assumed);
    const std::string& name = pair.first.name.name;
    AddJoint(name, type, pair.first.body, pair.first.X_WA, pair.second.body, pair.second.X_WA,
             &imported);
    if (imported.type_assumed) {
      Guess(fmt::format("joint {} is revolute (name a frame anchor_{}__TYPE, or --joint {}=TYPE)",
                        Quoted(name), name, name));
    }
    if (imported.gap > kWorthSayingGap || imported.skew > kWorthSayingSkew) {
      result_.remarks.push_back(fmt::format(
          "the anchors of joint {} are {:.4g} mm and {:.3g} deg off what a {} joint allows; the "
          "assembly moves the links to close it",
          Quoted(name), 1e3 * imported.gap, imported.skew * 180 / std::numbers::pi, NameOf(type)));
    }
    if (pair.first.name.prefer_cut || pair.second.name.prefer_cut) {
      result_.mechanism.preferred_cuts.push_back(imported.joint);
    }
  }

  void AddJoint(const std::string& name, JointType type, int first, const Posed& X_WF, int second,
                const Posed& X_WM, ImportedJoint* imported) {
    Mechanism& mechanism = result_.mechanism;
    // The joint leads from the ground outwards where one of its bodies is the ground.
    if (second == mechanism.ground) {
      return AddJoint(name, type, second, X_WM, first, X_WF, imported);
    }
    const auto add_anchor = [&](int body, const Posed& X_WA) {
      return AddAnchor(&mechanism.links[body], name, bodies_[body].X_WL.inverse() * X_WA);
    };
    Joint joint =
        MakeJoint(name, type, {first, add_anchor(first, X_WF)}, {second, add_anchor(second, X_WM)});
    const JointFit fit = FitJoint(type, X_WF.inverse() * X_WM);
    joint.start = fit.start;
    imported->joint = static_cast<int>(mechanism.joints.size());
    imported->distance = fit.distance;
    imported->angle = fit.angle;
    imported->gap = fit.gap;
    imported->skew = fit.skew;
    // A shaft that nothing stops may be a piston; the user's own word is taken.
    const bool is_guide = type == JointType::kCylindrical && imported->from_geometry;
    if (type == JointType::kRevolute || (type == JointType::kCylindrical && !is_guide)) {
      imported->seat = FindSeat(features_[first], features_[second], X_WF, options_.contacts);
    }
    mechanism.joints.push_back(std::move(joint));
    result_.joints.push_back(*imported);
    joined_.insert(std::minmax(first, second));
  }

  void AddUnmatched(const BodyFrame& frame, const std::vector<BodyFrame>& free) {
    UnmatchedAnchor unmatched;
    unmatched.frame = frame.frame;
    unmatched.body = bodies_[frame.body].name;
    std::string nearest_text = "there is no other anchor on another body";
    if (const auto nearest = NearestFrame(frame, free, frames_)) {
      unmatched.nearest_frame = nearest->frame;
      unmatched.nearest_body = bodies_[nearest->body].name;
      unmatched.distance = (nearest->X_WA.p - frame.X_WA.p).norm();
      const Vector3d z = frame.X_WA.R.col(2), z_nearest = nearest->X_WA.R.col(2);
      unmatched.angle = std::atan2(z.cross(z_nearest).norm(), std::abs(z.dot(z_nearest)));
      nearest_text =
          fmt::format("the nearest is {} of {}, {:.4g} mm and {:.3g} deg away",
                      Quoted(nearest->frame), Quoted(unmatched.nearest_body),
                      1e3 * unmatched.distance, unmatched.angle * 180 / std::numbers::pi);
    }
    if (options_.allow_unmatched) {
      AddAnchor(&result_.mechanism.links[frame.body], frame.name.name,
                bodies_[frame.body].X_WL.inverse() * frame.X_WA);
    } else {
      Error(
          fmt::format("anchor {} of {} has no partner of that name on another body; {}. Name "
                      "both alike, call it frame_{} to keep it alone, or allow it "
                      "(--allow-unmatched)",
                      Quoted(frame.frame), Quoted(unmatched.body), nearest_text, frame.name.name));
    }
    result_.unmatched.push_back(std::move(unmatched));
  }

  /// Between bodies that no named joint connects. Where no frame says what is a joint, the geometry
  /// does; what screws hold together is welded in any case.
  void ProposeJoints() {
    const bool take_all = options_.propose || frames_.empty();
    if (!options_.propose && take_all) {
      Guess("no coordinate system is an anchor; the joints are those of the geometry (--propose)");
    }
    for (int a = 0; a < static_cast<int>(bodies_.size()); ++a) {
      for (int b = a + 1; b < static_cast<int>(bodies_.size()); ++b) {
        if (joined_.count({a, b}) > 0) continue;
        const auto proposed = ProposeJoint(features_[a], features_[b], options_.contacts);
        if (!proposed) continue;
        const bool is_screwed = proposed->fastened && proposed->type == JointType::kWeld;
        if (take_all || is_screwed) {
          TakeProposal(*proposed, a, b);
        } else {
          result_.hints.push_back({bodies_[a].name, bodies_[b].name, *proposed});
        }
      }
    }
  }

  void TakeProposal(const ProposedJoint& proposed, int a, int b) {
    ImportedJoint imported;
    imported.from_geometry = true;
    imported.why = proposed.why;
    const std::string name = fmt::format("{}-{}", bodies_[a].name, bodies_[b].name);
    JointType type = proposed.type;
    for (const auto& [joint, asked] : options_.joint_types) {
      if (joint == name) type = asked;
    }
    AddJoint(name, type, a, proposed.X_WJ, b, proposed.X_WJ, &imported);
    Guess(fmt::format("joint {} is {}: {}", Quoted(name), NameOf(type), proposed.why));
  }

  void FindMisses() {
    for (size_t a = 0; a < bodies_.size(); ++a) {
      for (size_t b = a + 1; b < bodies_.size(); ++b) {
        for (std::string& what : FindNearMisses(features_[a], features_[b], options_.contacts)) {
          result_.near_misses.push_back({bodies_[a].name, bodies_[b].name, std::move(what)});
        }
      }
    }
  }

  void CheckOptions() {
    std::vector<std::string> joints;
    for (const Joint& joint : result_.mechanism.joints) joints.push_back(joint.name);
    for (const auto& [name, type] : options_.joint_types) {
      if (FindJoint(result_.mechanism, name) >= 0) continue;
      Error(
          fmt::format("there is no joint {} (--joint){}", Quoted(name), DidYouMean(name, joints)));
    }
  }

  void CheckConnected() {
    try {
      FindSpanningTree(result_.mechanism);
    } catch (const std::invalid_argument& error) {
      std::string text = error.what();
      for (const JointHint& hint : result_.hints) {
        text += fmt::format("\n  the geometry suggests: {} - {}, {} ({})", hint.first_body,
                            hint.second_body, NameOf(hint.joint.type), hint.joint.why);
      }
      for (const NearMiss& miss : result_.near_misses) {
        text += fmt::format("\n  no fit by a little: {} - {}, {} (--tolerance)", miss.first_body,
                            miss.second_body, miss.what);
      }
      text += result_.hints.empty()
                  ? "; give the parts anchors, or leave them out (--ignore)"
                  : "\n  take these joints (--propose), give the parts anchors, or leave them out "
                    "(--ignore)";
      Error(text);
    }
  }

  const CadAssembly& assembly_;
  const CadImportOptions& options_;
  CadImport result_;
  std::vector<FileError> errors_;
  std::vector<CadBody> bodies_;  ///< body i becomes link i
  std::vector<int> loose_frames_;
  std::vector<WorldFeatures> features_;
  std::vector<BodyFrame> frames_;  ///< anchors of joints
  std::set<std::pair<int, int>> joined_;
};

}  // namespace

CadImport MechanismFromCad(const CadAssembly& assembly, const CadImportOptions& options) {
  options.contacts.Validate();
  return Importer(assembly, options).Run();
}

}  // namespace vmech
