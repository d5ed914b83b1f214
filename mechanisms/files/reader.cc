#include "vmech/mechanisms/files/reader.h"

#include <fmt/format.h>

#include <unordered_map>

#include "vmech/mechanisms/files/read_dh.h"
#include "vmech/mechanisms/files/read_joint.h"
#include "vmech/mechanisms/files/read_link.h"
#include "vmech/mechanisms/files/units.h"

namespace vmech {
namespace {

/// Indices of named parts, to look them up by the words of a file.
class PartNames {
 public:
  template <typename Part>
  PartNames(std::string_view kind, const std::vector<Part>& parts) : kind_(kind) {
    for (const Part& part : parts) {
      indices_.emplace(part.name, static_cast<int>(names_.size()));
      names_.push_back(part.name);
    }
  }

  /// The index of the part that a node names; -1 if there is none, which is reported.
  int Find(const Node& node) const {
    const std::string name = node.Text();
    if (node.kind() != Node::Kind::kScalar) return -1;
    const auto found = indices_.find(name);
    if (found != indices_.end()) return found->second;
    node.Error(fmt::format("{} {} not found{}", kind_, Quoted(name), DidYouMean(name, names_)));
    return -1;
  }

 private:
  std::string kind_;
  std::vector<std::string> names_;
  std::unordered_map<std::string, int> indices_;
};

void CheckVersion(const Node& version) {
  const std::string text = version.Text(std::string(kMechanismFormat));
  if (text == kMechanismFormat) return;
  version.Error(
      fmt::format("this is format {}; only {} can be read", Quoted(text), kMechanismFormat));
}

Grasp ReadGrasp(const Node& node, const PartNames& links, const Units& units) {
  Grasp grasp;
  grasp.name = node.key();
  node.CheckName();
  if (!node.CheckKeys({"link"}, {"origin", "z", "x", "y", "dh", "kind"})) return grasp;
  grasp.link = links.Find(node["link"]);
  grasp.X_LG = ReadFrame(node, units);
  grasp.kind = node["kind"].Word<GraspKind>(
      {{"rigid", GraspKind::kRigid}, {"point", GraspKind::kPoint}}, GraspKind::kRigid);
  return grasp;
}

void ReadCuts(const Node& node, Mechanism* mechanism) {
  if (!node) return;
  const PartNames joints("joint", mechanism->joints);
  std::vector<bool> is_cut(mechanism->joints.size(), false);
  for (const Node& entry : node.List()) {
    const int joint = joints.Find(entry);
    if (joint < 0) continue;
    if (is_cut[joint]) entry.Error("this joint is already cut");
    is_cut[joint] = true;
    mechanism->preferred_cuts.push_back(joint);
  }
}

void ReadTolerance(const Node& node, Mechanism* mechanism) {
  if (!node) return;
  const double tolerance = node.Number();
  if (tolerance >= 0 && tolerance <= kWidestTolerance) {
    mechanism->tolerance = tolerance;
  } else {
    node.Error(
        fmt::format("must be from 0 to {}: what anchors may be off for the loops to count "
                    "as closed, in radians and in parts of the mechanism's length",
                    kWidestTolerance));
  }
}

/// How the links hang together: for each the links beyond its joints.
std::vector<std::vector<int>> Neighbours(const Mechanism& mechanism) {
  std::vector<std::vector<int>> neighbours(mechanism.links.size());
  for (const Joint& joint : mechanism.joints) {
    neighbours[joint.first.link].push_back(joint.second.link);
    neighbours[joint.second.link].push_back(joint.first.link);
  }
  return neighbours;
}

void CheckConnected(const Mechanism& mechanism, const std::vector<std::vector<int>>& neighbours,
                    const std::vector<Node>& links) {
  std::vector<bool> reached(mechanism.links.size(), false);
  std::vector<int> frontier{mechanism.ground};
  reached[mechanism.ground] = true;
  while (!frontier.empty()) {
    const int link = frontier.back();
    frontier.pop_back();
    for (const int next : neighbours[link]) {
      if (!reached[next]) frontier.push_back(next);
      reached[next] = true;
    }
  }
  for (size_t i = 0; i < links.size(); ++i) {
    if (!reached[i]) links[i].KeyError("no chain of joints leads from this link to the ground");
  }
}

/// A link without mass is fine between others, which carry what it would have carried; at the end
/// of a chain nothing gives its motion a meaning. In a file without any mass, which is for
/// kinematics only, that is nobody's concern.
void CheckMassless(const Mechanism& mechanism, const std::vector<Node>& links) {
  std::vector<int> joints_of(mechanism.links.size(), 0);
  std::vector<bool> welded(mechanism.links.size(), false);
  for (const Joint& joint : mechanism.joints) {
    for (const int link : {joint.first.link, joint.second.link}) {
      ++joints_of[link];
      if (joint.type == JointType::kWeld) welded[link] = true;
    }
  }
  bool any_mass = false;
  for (const Link& link : mechanism.links) any_mass |= link.mass_properties.mass > 0;
  for (int i = 0; any_mass && i < static_cast<int>(mechanism.links.size()); ++i) {
    const bool moves_alone = i != mechanism.ground && joints_of[i] == 1 && !welded[i];
    if (moves_alone && mechanism.links[i].mass_properties.mass == 0) {
      links[i].KeyError("this link ends a chain and has no mass; give its mass");
    }
  }
}

void ReadParts(const Node& root, const Units& units, Mechanism* mechanism) {
  for (const Node& link : root["links"].Map()) mechanism->links.push_back(ReadLink(link, units));
  AddDhAnchors(root["joints"], units, &mechanism->links);
  const AnchorNames anchors(mechanism->links);
  const PartNames links("link", mechanism->links);
  for (const Node& joint : root["joints"].Map()) {
    mechanism->joints.push_back(ReadJoint(joint, anchors, units));
  }
  for (const Node& grasp : root["grasps"].Map()) {
    mechanism->grasps.push_back(ReadGrasp(grasp, links, units));
  }
  mechanism->ground = links.Find(root["ground"]);
  ReadCuts(root["cuts"], mechanism);
}

Mechanism ReadDocument(Document* document) {
  Mechanism mechanism;
  const Node root = document->root();
  if (root.CheckKeys({"vmech", "gravity", "ground", "links", "joints"},
                     {"name", "description", "units", "grasps", "cuts", "tolerance"})) {
    CheckVersion(root["vmech"]);
    mechanism.name = root["name"].Text(std::filesystem::path(document->name()).stem().string());
    root["description"].Text();
    const Units units = ReadUnits(root["units"]);
    mechanism.units = DisplayUnitsOf(root["units"], units);
    ReadTolerance(root["tolerance"], &mechanism);
    mechanism.gravity_W = units.acceleration * root["gravity"].Vector3();
    ReadParts(root, units, &mechanism);
  }
  document->ThrowErrors();  // what follows takes indices for granted
  const std::vector<Node> links = root["links"].Map();
  CheckConnected(mechanism, Neighbours(mechanism), links);
  CheckMassless(mechanism, links);
  document->ThrowErrors();
  return mechanism;
}

}  // namespace

Mechanism ReadMechanism(const std::filesystem::path& path) {
  return ParseMechanism(ReadTextFile(path), path.string());
}

Mechanism ParseMechanism(std::string_view text, const std::string& name) {
  Document document(text, name);
  return ReadDocument(&document);
}

}  // namespace vmech
