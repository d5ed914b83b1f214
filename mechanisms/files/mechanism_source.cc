#include "vmech/mechanisms/files/mechanism_source.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <unordered_map>
#include <utility>

#include "vmech/mechanisms/expressions/unit.h"
#include "vmech/mechanisms/files/inserted.h"
#include "vmech/mechanisms/files/parameters.h"
#include "vmech/mechanisms/files/read_dh.h"
#include "vmech/mechanisms/files/read_joint.h"
#include "vmech/mechanisms/files/read_link.h"

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

Grasp ReadGrasp(const Node& node, const PartNames& names, const std::vector<Link>& links,
                const Units& units) {
  Grasp grasp;
  grasp.name = node.key();
  node.CheckName();
  if (!node.CheckKeys({"link"}, {"relative", "origin", "z", "x", "y", "dh", "kind"})) return grasp;
  grasp.link = names.Find(node["link"]);
  if (grasp.link >= 0) grasp.X_LG = ReadFrameOn(node, links[grasp.link], units);
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

/// A name that a used mechanism has brought already.
void RefuseUsedName(const Node& node, int found) {
  if (found >= 0) node.KeyError("a used mechanism has brought this name; choose another one");
}

std::filesystem::path Canonical(const std::filesystem::path& path) {
  std::error_code ignored;
  std::filesystem::path canonical = std::filesystem::weakly_canonical(path, ignored);
  return canonical.empty() ? path : canonical;
}

/// How deep files use each other, and how many links may come of it.
constexpr size_t kDeepest = 16;
constexpr size_t kMostLinks = 10000;

}  // namespace

MechanismSource::MechanismSource(std::string_view text, const std::string& name)
    : MechanismSource(text, name, {}) {}

MechanismSource::MechanismSource(std::string_view text, const std::string& name,
                                 std::vector<std::filesystem::path> users)
    : text_(text), document_(text, name), users_(std::move(users)) {
  users_.push_back(Canonical(name));
  const Node root = document_.root();
  if (root.kind() == Node::Kind::kMap) {
    units_ = ReadUnits(root["units"]);
    scope_.units = units_.counting();
    ReadParameters(root["parameters"], scope_.units, &table_);
  }
  errors_of_text_ = document_.error_count();
}

MechanismSource::~MechanismSource() = default;

std::vector<MechanismSource::File> MechanismSource::files() const {
  std::vector<File> files{{document_.name(), text_}};
  for (const auto& [use, source] : used_) {
    for (File& file : source->files()) {
      const bool known = std::any_of(files.begin(), files.end(),
                                     [&](const File& f) { return f.path == file.path; });
      if (!known) files.push_back(std::move(file));
    }
  }
  return files;
}

std::vector<StatedParameter> MechanismSource::stated() const {
  std::vector<StatedParameter> stated;
  for (const std::string& name : table_.names()) {
    const Quantity<double>& value = scope_.values.at(name);
    const NamedUnit unit = NameOf(value.unit);
    stated.push_back({name, value.figure * unit.times, unit.symbol});
  }
  return stated;
}

/// Gives the expressions of the document their values.
void MechanismSource::Resolve() {
  std::vector<FileError> errors;
  scope_.values = table_.Resolve<double>(&errors);
  scope_.names = table_.names();
  document_.SetScope(scope_);
  for (FileError& error : errors) document_.Report(std::move(error));
}

Mechanism MechanismSource::Read() {
  document_.ForgetErrorsAfter(errors_of_text_);  // of other values
  while (true) {
    Resolve();
    Mechanism mechanism = ReadOnce();
    for (const ParameterUse& use : document_.uses()) {
      if (use.alone) table_.NoteUse(use.parameter, use.asked);
    }
    if (!table_.learned()) {
      document_.ThrowErrors();  // what follows takes indices for granted
      if (users_.size() == 1) CheckWhole(mechanism);
      return mechanism;
    }
    document_.ForgetErrorsAfter(errors_of_text_);
  }
}

Mechanism MechanismSource::ReadOnce() {
  Mechanism mechanism;
  const Node root = document_.root();
  if (!root.CheckKeys({"vmech", "gravity", "ground", "links", "joints"},
                      {"name", "description", "units", "parameters", "mechanisms", "grasps", "cuts",
                       "tolerance"})) {
    return mechanism;
  }
  CheckVersion(root["vmech"]);
  mechanism.name = root["name"].Text(std::filesystem::path(document_.name()).stem().string());
  root["description"].Text();
  const Units& units = units_;
  mechanism.units = DisplayUnitsOf(root["units"], units);
  ReadTolerance(root["tolerance"], &mechanism);
  mechanism.gravity_W = root["gravity"].Vector3(units.acceleration);
  ReadParts(units, &mechanism);
  return mechanism;
}

void MechanismSource::ReadParts(const Units& units, Mechanism* mechanism) {
  const Node root = document_.root();
  link_nodes_ = root["links"].Map();
  for (const Node& link : link_nodes_) mechanism->links.push_back(ReadLink(link, units));
  AddDhAnchors(root["joints"], units, &mechanism->links);
  mechanism->ground = PartNames("link", mechanism->links).Find(root["ground"]);
  ReadUses(units, mechanism);
  const AnchorNames anchors(mechanism->links);
  const PartNames links("link", mechanism->links);
  std::vector<Joint> joints;
  for (const Node& joint : root["joints"].Map()) {
    joints.push_back(ReadJoint(joint, anchors, units));
    RefuseUsedName(joint, FindJoint(*mechanism, joint.key()));
  }
  mechanism->joints.insert(mechanism->joints.begin(), joints.begin(), joints.end());
  std::vector<Grasp> grasps;
  for (const Node& grasp : root["grasps"].Map()) {
    grasps.push_back(ReadGrasp(grasp, links, mechanism->links, units));
    RefuseUsedName(grasp, FindGrasp(*mechanism, grasp.key()));
  }
  mechanism->grasps.insert(mechanism->grasps.begin(), grasps.begin(), grasps.end());
  for (int& cut : mechanism->preferred_cuts) cut += static_cast<int>(joints.size());
  ReadCuts(root["cuts"], mechanism);
}

void MechanismSource::ReadUses(const Units& units, Mechanism* mechanism) {
  const Node uses = document_.root()["mechanisms"];
  if (!uses || mechanism->ground < 0) return;
  for (const Node& node : uses.Map()) {
    ReadUse(node, units, mechanism);
    if (mechanism->links.size() > kMostLinks) {
      return node.KeyError(fmt::format("more than {} links; a file is used too often", kMostLinks));
    }
  }
}

/// One mechanism used in this one: its ground becomes a part of a link here.
void MechanismSource::ReadUse(const Node& node, const Units& units, Mechanism* mechanism) {
  node.CheckName();
  if (!node.CheckKeys({"use"}, {"description", "on", "relative", "origin", "z", "x", "y", "dh",
                                "parameters"})) {
    return;
  }
  node["description"].Text();
  MechanismSource* const used = SourceOf(node);
  const int on =
      node["on"] ? PartNames("link", mechanism->links).Find(node["on"]) : mechanism->ground;
  if (used == nullptr || on < 0) return;
  const Posed X_LU = ReadFrameOn(node, mechanism->links[on], units);
  FixParameters(node["parameters"], used);
  try {
    const Mechanism part = used->Read();
    const std::string defect = Insert(part, node.key(), on, X_LU, mechanism);
    if (!defect.empty()) node.KeyError(defect);
  } catch (const FileErrors& errors) {
    for (const FileError& error : errors.errors()) document_.ReportOnce(error);
  }
  link_nodes_.resize(mechanism->links.size(), node);
}

/// The file that a use names, parsed when it is first asked for; null if it cannot be.
MechanismSource* MechanismSource::SourceOf(const Node& node) {
  const auto known = used_.find(node.key());
  if (known != used_.end()) return known->second.get();
  const std::string file = node["use"].Text();
  if (file.empty()) return nullptr;
  const std::filesystem::path path = std::filesystem::path(document_.name()).parent_path() / file;
  const auto found = std::find(users_.begin(), users_.end(), Canonical(path));
  if (found != users_.end() || users_.size() > kDeepest) {
    std::string way;
    for (auto i = found; i != users_.end(); ++i) way += i->filename().string() + " -> ";
    node["use"].Error(found == users_.end() ? "files use each other too deeply"
                                            : "the file uses itself: " + way + file);
    return nullptr;
  }
  try {
    std::unique_ptr<MechanismSource> source(
        new MechanismSource(ReadTextFile(path), path.string(), users_));
    return used_.emplace(node.key(), std::move(source)).first->second.get();
  } catch (const FileErrors& errors) {
    for (const FileError& error : errors.errors()) {
      if (error.line == 0) node["use"].Error(ToString(error));
      if (error.line != 0) document_.ReportOnce(error);
    }
  }
  return nullptr;
}

/// Gives parameters of a used mechanism the values that are stated here.
void MechanismSource::FixParameters(const Node& block, MechanismSource* used) {
  if (!block) return;
  for (const Node& entry : block.Map()) {
    const int parameter = used->table_.Find(entry.key());
    if (parameter < 0) {
      entry.KeyError(fmt::format("{} has no parameter {}{}", used->name(), Quoted(entry.key()),
                                 DidYouMean(entry.key(), used->table_.names())));
      continue;
    }
    const std::optional<Quantity<double>> value = entry.Value<double>();
    if (!value) continue;
    used->table_.Fix(
        parameter,
        PlacedValue{{value->figure, value->unit, value->bare, value->radians}, PlaceOf(entry)});
  }
}

void MechanismSource::CheckWhole(const Mechanism& mechanism) {
  CheckConnected(mechanism, Neighbours(mechanism), link_nodes_);
  CheckMassless(mechanism, link_nodes_);
  document_.ThrowErrors();
}

}  // namespace vmech
