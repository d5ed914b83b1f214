#include "vmech/apps/view/scene.h"

#include <Eigen/Geometry>
#include <cmath>
#include <optional>
#include <utility>

#include "vmech/apps/view/json_text.h"
#include "vmech/base/text/base64.h"
#include "vmech/dynamics/loads/open_components.h"
#include "vmech/dynamics/loads/pose/external_loads.h"
#include "vmech/kinematics/loops/assembled_mechanism.h"
#include "vmech/kinematics/tree/link_poses.h"
#include "vmech/mechanisms/freedoms.h"

namespace vmech {
namespace {

using Json = nlohmann::ordered_json;

template <typename Numbers>
std::string Base64Of(const Numbers& numbers) {
  return Base64(
      {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(numbers[0])});
}

Json ArrayOf(const Vector3d& v) {
  return {v[0], v[1], v[2]};
}

/// Infinity, that is no limit, is null.
Json LimitOf(double limit) {
  return std::isfinite(limit) ? Json(limit) : Json();
}

Json LinksOf(const Mechanism& mechanism, const std::vector<std::string>& meshes) {
  Json links = Json::array();
  for (size_t i = 0; i < mechanism.links.size(); ++i) {
    const Link& link = mechanism.links[i];
    Json anchors = Json::array();
    for (const Anchor& anchor : link.anchors) {
      anchors.push_back({{"name", anchor.name}, {"pose", SevenOf(anchor.X_LA)}});
    }
    links.push_back({{"name", link.name},
                     {"mass", link.mass_properties.mass},
                     {"centre", ArrayOf(link.mass_properties.p_LoLcm)},
                     {"anchors", std::move(anchors)}});
    if (i < meshes.size() && !meshes[i].empty()) links.back()["mesh"] = Base64(meshes[i]);
  }
  return links;
}

Json FreedomsOf(const Joint& joint) {
  Json freedoms = Json::array();
  const bool ball = joint.type == JointType::kSpherical;  // its coordinates have no limits
  for (int k = 0; k < vmech::FreedomsOf(joint.type); ++k) {
    const auto at = static_cast<size_t>(k);
    freedoms.push_back({{"name", NameOfFreedom(joint, k)},
                        {"rotation", FreedomsOfType(joint.type).rotates[at]},
                        {"lower", ball ? Json() : LimitOf(joint.lower[at])},
                        {"upper", ball ? Json() : LimitOf(joint.upper[at])}});
  }
  return freedoms;
}

Json JointsOf(const KinematicTree& tree) {
  const Mechanism& mechanism = tree.mechanism;
  Json joints = Json::array();
  for (size_t j = 0; j < mechanism.joints.size(); ++j) {
    const Joint& joint = mechanism.joints[j];
    const auto place = [](AnchorId id) { return Json{{"link", id.link}, {"anchor", id.anchor}}; };
    joints.push_back({{"name", joint.name},
                      {"type", NameOf(joint.type)},
                      {"cut", tree.placements[j].tree_node < 0},
                      {"first", place(joint.first)},
                      {"second", place(joint.second)},
                      {"freedoms", FreedomsOf(joint)}});
  }
  return joints;
}

Json StartOf(const KinematicTree& tree) {
  Json poses = Json::array();
  for (const Posed& X_WL : LinkPoses(tree, StartCoordinates(tree))) {
    poses.push_back(SevenOf(X_WL));
  }
  return {{"poses", std::move(poses)}, {"coordinates", StartOfFreedoms(tree.mechanism)}};
}

std::vector<float> Floats(const LoadArrays::Array& numbers) {
  return {numbers.begin(), numbers.end()};
}

std::string PosesOf(const LoadArrays& arrays) {
  std::vector<float> poses;
  poses.reserve(7 * arrays.links.size());
  for (const LinkMotion& link : arrays.links) {
    for (const double value : SevenOf(link.X_WL)) poses.push_back(static_cast<float>(value));
  }
  return Base64Of(poses);
}

Json DrivesOf(const LoadStudy& study, const LoadArrays& arrays) {
  Json drives = Json::array();
  for (size_t k = 0; k < study.drives.size(); ++k) {
    const JointDrive& drive = study.drives[k];
    const Joint& joint = study.mechanism.joints[static_cast<size_t>(drive.joint)];
    std::vector<float> forces;
    for (size_t i = 0; i < arrays.pose_count(); ++i) {
      forces.push_back(static_cast<float>(arrays.Drive(i, k).force));
    }
    drives.push_back(
        {{"name", NameOfFreedom(joint, drive.freedom)},
         {"unit",
          FreedomsOfType(joint.type).rotates[static_cast<size_t>(drive.freedom)] ? "N m" : "N"},
         {"forces", Base64Of(forces)}});
  }
  return drives;
}

Json HandOf(const LoadStudy& study, const LoadArrays& arrays) {
  std::vector<float> wrenches;
  for (const HandLoad& hand : arrays.hands) {
    for (const double f : hand.wrench.force) wrenches.push_back(static_cast<float>(f));
    for (const double m : hand.wrench.moment) wrenches.push_back(static_cast<float>(m));
  }
  return {{"grasp", study.hand->grasp}, {"wrenches", Base64Of(wrenches)}};
}

/// About the load's point, world axes.
Json LoadOf(const ExternalLoad& load, const LoadArrays& arrays) {
  std::vector<float> wrenches;
  for (size_t i = 0; i < arrays.pose_count(); ++i) {
    const bool over_drive = load.over == ExternalLoad::Over::kDriveCoordinate;
    Wrenchd w = WrenchAt(
        load, over_drive ? arrays.drives[i * arrays.drive_count].position : arrays.times[i]);
    if (load.axes == ExternalLoad::Axes::kLink) {
      const size_t link = i * arrays.link_count + static_cast<size_t>(load.link);
      w = w.In(arrays.links[link].X_WL.R.transpose());
    }
    for (const double f : w.force) wrenches.push_back(static_cast<float>(f));
    for (const double m : w.moment) wrenches.push_back(static_cast<float>(m));
  }
  return {{"link", load.link}, {"point", ArrayOf(load.p_L)}, {"wrenches", Base64Of(wrenches)}};
}

Json CertaintyOf(const LoadStudyResult& loads) {
  Json all = Json::array();
  for (size_t j = 0; j < loads.certainty.size(); ++j) {
    Json words = Json::array();
    for (const Certainty verdict : VerdictsThatMatter(loads, j))
      words.push_back(CertaintyWord(verdict));
    all.push_back(std::move(words));
  }
  return all;
}

/// Where an axis first has a value, in poses; nothing if it does not.
std::optional<double> PoseWhere(const std::vector<double>& axis, double value) {
  for (size_t i = 0; i + 1 < axis.size(); ++i) {
    const double step = axis[i + 1] - axis[i], part = (value - axis[i]) / step;
    if (step != 0 && part >= 0 && part <= 1) return static_cast<double>(i) + part;
  }
  return std::nullopt;
}

Json MotionOf(const Scene& scene) {
  const LoadArrays& arrays = scene.loads->poses.arrays();
  Json centres = Json::array();
  for (const SceneAxis::Mark& mark : scene.axis.dead_centres) {
    const std::optional<double> pose = PoseWhere(scene.axis.values, mark.value);
    if (!pose) continue;
    centres.push_back({{"axis", mark.value}, {"pose", *pose}, {"label", mark.label}});
  }
  Json motion{{"times", Base64Of(arrays.times)},
              {"cycle", scene.study->cycle},
              {"axis",
               {{"label", scene.axis.label},
                {"unit", scene.axis.unit},
                {"values", Base64Of(scene.axis.values)}}},
              {"poses", PosesOf(arrays)},
              {"coordinates", Base64Of(Floats(arrays.positions))},
              {"rates", Base64Of(Floats(arrays.rates))},
              {"wrenches", Base64Of(Floats(arrays.wrenches))},
              {"certainty", CertaintyOf(*scene.loads)},
              {"drives", DrivesOf(*scene.study, arrays)},
              {"dead_centres", std::move(centres)}};
  motion["loads"] = Json::array();
  for (const ExternalLoad& load : scene.study->external) {
    motion["loads"].push_back(LoadOf(load, arrays));
  }
  if (scene.study->hand) motion["hand"] = HandOf(*scene.study, arrays);
  return motion;
}

Json AuditOf(const RecordedMotion& recorded) {
  Json charts = Json::array(), findings = Json::array();
  for (const RecordedMotion::Chart& chart : recorded.charts) {
    Json series = Json::array();
    for (const RecordedMotion::Series& one : chart.series) {
      series.push_back({{"name", one.name}, {"values", Base64Of(one.values)}});
    }
    charts.push_back({{"title", chart.title}, {"unit", chart.unit}, {"series", std::move(series)}});
  }
  for (const RecordedMotion::Finding& finding : recorded.findings) {
    findings.push_back({{"what", finding.what},
                        {"unit", finding.unit},
                        {"worst", finding.worst},
                        {"bound", finding.bound},
                        {"sound", finding.sound}});
  }
  return {
      {"words", recorded.words}, {"findings", std::move(findings)}, {"charts", std::move(charts)}};
}

/// The first hand has an arrow of its own, others are loads.
Json RecordedMotionOf(const RecordedMotion& recorded, const Mechanism& mechanism) {
  const std::string times = Base64Of(recorded.times);
  Json motion{{"times", times},
              {"cycle", 0},
              {"axis", {{"label", "time"}, {"unit", "s"}, {"values", times}}},
              {"poses", Base64Of(recorded.poses)},
              {"coordinates", Base64Of(recorded.coordinates)},
              {"wrenches", Base64Of(recorded.wrenches)},
              {"loads", Json::array()},
              {"audit", AuditOf(recorded)}};
  for (const RecordedMotion::Hand& hand : recorded.hands) {
    const Grasp& grasp = mechanism.grasps[static_cast<size_t>(hand.grasp)];
    const std::string wrenches = Base64Of(hand.wrenches);
    if (!motion.contains("hand")) {
      motion["hand"] = {{"grasp", hand.grasp}, {"wrenches", wrenches}};
    } else {
      motion["loads"].push_back(
          {{"link", grasp.link}, {"point", ArrayOf(grasp.X_LG.p)}, {"wrenches", wrenches}});
    }
  }
  return motion;
}

/// The characters that could end an element or begin one, as escapes of JSON.
std::string WithoutMarkup(const std::string& json) {
  std::string text;
  text.reserve(json.size() + 64);
  for (const char c : json) {
    if (c == '<') {
      text += "\\u003c";
    } else if (c == '>') {
      text += "\\u003e";
    } else if (c == '&') {
      text += "\\u0026";
    } else {
      text += c;
    }
  }
  return text;
}

}  // namespace

const char* CertaintyWord(Certainty certainty) {
  switch (certainty) {
    case Certainty::kCertain:
      return "certain";
    case Certainty::kNotDetermined:
      return "not determined";
    case Certainty::kSingular:
      return "singular";
  }
  return "";
}

std::vector<double> SevenOf(const Posed& X) {
  const Eigen::Quaterniond turn(X.R);
  return {X.p[0], X.p[1], X.p[2], turn.w(), turn.x(), turn.y(), turn.z()};
}

std::string SceneJson(const Scene& scene) {
  const Mechanism& mechanism = scene.tree->mechanism;
  const DisplayUnits& units = scene.study != nullptr ? scene.study->units : mechanism.units;
  Json json{{"format", "vmech-view/1"},
            {"title", scene.title},
            {"version", scene.version},
            {"length", scene.tree->length},
            {"units",
             {{"length", units.length},
              {"metres", units.metres},
              {"angle", units.angle},
              {"radians", units.radians}}},
            {"gravity", ArrayOf(mechanism.gravity_W)},
            {"ground", mechanism.ground},
            {"links", LinksOf(mechanism, scene.meshes)},
            {"joints", JointsOf(*scene.tree)},
            {"grasps", Json::array()},
            {"start", StartOf(*scene.tree)}};
  for (const Grasp& grasp : mechanism.grasps) {
    json["grasps"].push_back({{"name", grasp.name},
                              {"link", grasp.link},
                              {"pose", SevenOf(grasp.X_LG)},
                              {"point", grasp.kind == GraspKind::kPoint}});
  }
  if (scene.loads != nullptr) json["motion"] = MotionOf(scene);
  if (scene.recorded != nullptr) json["motion"] = RecordedMotionOf(*scene.recorded, mechanism);
  if (!scene.session.empty()) {
    json["session"] = {{"socket", "/socket"}, {"kind", scene.session}};
    if (!scene.parameters.empty()) json["session"]["parameters"] = Json::parse(scene.parameters);
  }
  return WithoutMarkup(JsonText(json));
}

}  // namespace vmech
