#include "vmech/apps/compare/suite_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "vmech/apps/compare/digest.h"
#include "vmech/mechanisms/files/mechanism_source.h"
#include "vmech/mechanisms/files/parameters.h"
#include "vmech/mechanisms/files/read_link.h"
#include "vmech/mechanisms/files/units.h"
#include "vmech/studies/read_motion.h"

namespace vmech {
namespace {

constexpr int kMaxCount = 1'000'000;
constexpr int kMaxSteps = 100'000;
constexpr int64_t kMaxProblems = 1'000'000;     // of a suite; each is a row per solver
constexpr int64_t kMaxTargets = 1'000'000'000;  // of its paths

void CheckVersion(const Node& version) {
  const std::string text = version.Text(std::string(kSuiteFormat));
  if (text == kSuiteFormat) return;
  version.Error(fmt::format("this is format {}; only {} can be read", Quoted(text), kSuiteFormat));
}

void ReadStopping(const Node& node, StoppingRule* rule) {
  if (!node) return;
  if (!node.CheckKeys({}, {"constraint_tolerance", "optimality_tolerance", "max_iterations"})) {
    return;
  }
  rule->constraint_tolerance = node["constraint_tolerance"].Positive(rule->constraint_tolerance);
  rule->optimality_tolerance = node["optimality_tolerance"].Positive(rule->optimality_tolerance);
  rule->max_iterations = node["max_iterations"].Integer(rule->max_iterations, 1, 1'000'000);
}

/// A number within a range.
double Within(const Node& node, double fallback, double least, double most) {
  const double value = node.Number(fallback);
  if (value >= least && value <= most) return value;
  node.Error(fmt::format("must be from {:g} to {:g}, but is {:g}", least, most, value));
  return fallback;
}

/// Keys that only some kinds of targets know.
void CheckKeysOfKind(const Node& node, const TargetBlock& block) {
  const bool unreachable = block.kind == TargetKind::kUnreachable;
  const bool singular = block.kind == TargetKind::kSingular;
  const std::pair<const char*, bool> keys[] = {
      {"start", !block.is_path()}, {"start_distance", !block.is_path()}, {"offset", unreachable},
      {"closeness", singular},     {"steps", block.is_path()},           {"step", block.is_path()},
  };
  for (const auto& [key, used] : keys) {
    const Node given = node[key];
    if (given && !used) {
      given.KeyError(fmt::format("targets of kind '{}' have no '{}'", NameOf(block.kind), key));
    }
  }
  if (block.start == StartKind::kFar && node["start_distance"]) {
    node["start_distance"].KeyError("used with 'start: near' only");
  }
}

TargetBlock ReadBlock(const Node& node) {
  TargetBlock block;
  block.name = node.key();
  node.CheckName();
  if (!node.CheckKeys({"kind", "count"},
                      {"start", "start_distance", "offset", "closeness", "steps", "step"})) {
    return block;
  }
  block.kind =
      node["kind"].Word<TargetKind>({{NameOf(TargetKind::kReachable), TargetKind::kReachable},
                                     {NameOf(TargetKind::kUnreachable), TargetKind::kUnreachable},
                                     {NameOf(TargetKind::kSingular), TargetKind::kSingular},
                                     {NameOf(TargetKind::kDeadCentre), TargetKind::kDeadCentre},
                                     {NameOf(TargetKind::kTracking), TargetKind::kTracking}},
                                    TargetKind::kReachable);
  block.start = node["start"].Word<StartKind>(
      {{"near", StartKind::kNear}, {"far", StartKind::kFar}}, StartKind::kNear);
  block.count = node["count"].Integer(1, 1, kMaxCount);
  block.start_distance = Within(node["start_distance"], block.start_distance, 1e-9, 10);
  block.offset = Within(node["offset"], block.offset, 1e-9, 100);
  block.closeness = Within(node["closeness"], block.closeness, 1e-9, 1);
  block.steps = node["steps"].Integer(block.steps, 2, kMaxSteps);
  block.step = Within(node["step"], block.step, 1e-6, 1);
  CheckKeysOfKind(node, block);
  return block;
}

/// A grasp of the mechanism by its name, or one of the suite's own.
Grasp ReadSuiteGrasp(const Node& node, const Units& units, const Mechanism& mechanism) {
  Grasp grasp;
  if (node.kind() == Node::Kind::kScalar) {
    const int index = FindPart(node, "grasp", mechanism.grasps);
    return index < 0 ? grasp : mechanism.grasps[index];
  }
  if (!node.CheckKeys({"link"}, {"origin", "z", "x", "y", "kind"})) return grasp;
  grasp.link = FindPart(node["link"], "link", mechanism.links);
  grasp.X_LG = ReadFrame(node, units);
  grasp.kind = node["kind"].Word<GraspKind>(
      {{"rigid", GraspKind::kRigid}, {"point", GraspKind::kPoint}}, GraspKind::kRigid);
  if (grasp.link == mechanism.ground) node["link"].Error("the ground does not move");
  return grasp;
}

std::vector<int> ReadBlocksOf(const Node& node, const std::vector<TargetBlock>& blocks) {
  std::vector<int> chosen;
  if (!node) {
    for (size_t i = 0; i < blocks.size(); ++i) chosen.push_back(static_cast<int>(i));
    return chosen;
  }
  for (const Node& entry : node.List()) {
    const int block = FindPart(entry, "block of targets", blocks);
    if (block < 0) continue;
    if (std::find(chosen.begin(), chosen.end(), block) != chosen.end()) {
      entry.Error("this block is already named");
    }
    chosen.push_back(block);
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

class SuiteReader {
 public:
  SuiteReader(std::string_view text, const std::filesystem::path& path,
              std::span<const ParameterSetting> settings)
      : document_(text, path.string()), folder_(path.parent_path()), settings_(settings) {
    suite_.path = path;
    suite_.digest = DigestOf(text);
    for (const ParameterSetting& setting : settings) {
      suite_.digest = DigestOf(PlaceOf(setting), suite_.digest);
    }
  }

  Suite Read() {
    const Node root = document_.root();
    if (root.CheckKeys({"vmech_suite", "targets", "mechanisms"},
                       {"name", "description", "units", "seed", "repetitions", "stopping",
                        "reach_tolerance"})) {
      CheckVersion(root["vmech_suite"]);
      ReadHead(root);
      for (const Node& entry : root["targets"].Map()) suite_.blocks.push_back(ReadBlock(entry));
      if (document_.ok() && suite_.blocks.empty()) root["targets"].Error("name at least one block");
      const Units units = ReadUnits(root["units"]);
      for (const Node& entry : root["mechanisms"].Map()) ReadOne(entry, units);
      if (document_.ok() && suite_.mechanisms.empty()) {
        root["mechanisms"].Error("name at least one mechanism");
      }
      if (document_.ok()) CheckSize(root["targets"]);
    }
    document_.ThrowErrors();
    RequireUsed();
    return std::move(suite_);
  }

 private:
  void ReadHead(const Node& root) {
    suite_.name = root["name"].Text(suite_.path.stem().string());
    suite_.description = root["description"].Text();
    suite_.seed =
        static_cast<uint64_t>(root["seed"].Integer(1, 0, std::numeric_limits<int>::max()));
    suite_.repetitions = root["repetitions"].Integer(suite_.repetitions, 1, 1000);
    suite_.reach_tolerance = Within(root["reach_tolerance"], suite_.reach_tolerance, 1e-15, 1);
    ReadStopping(root["stopping"], &suite_.stopping);
    try {
      suite_.stopping.Validate();
    } catch (const std::invalid_argument& defect) {
      root["stopping"].Error(defect.what());
    }
  }

  void RequireUsed() const {
    for (const ParameterSetting& setting : settings_) {
      if (set_.contains(setting.name)) continue;
      throw FileErrors(PlaceOf(setting), fmt::format("no mechanism of {} has a parameter {}",
                                                     suite_.path.string(), Quoted(setting.name)));
    }
  }

  /// Each count may be large, their sum may not.
  void CheckSize(const Node& targets) const {
    int64_t problems = 0, on_paths = 0;
    for (const SuiteMechanism& mechanism : suite_.mechanisms) {
      for (const int b : mechanism.blocks) {
        const TargetBlock& block = suite_.blocks[b];
        problems += block.count;
        on_paths += block.is_path() ? int64_t{block.count} * block.steps : 0;
      }
    }
    CheckSum(targets, "problems", "counts over all mechanisms", problems, kMaxProblems);
    CheckSum(targets, "targets on paths", "counts times steps", on_paths, kMaxTargets);
  }

  static void CheckSum(const Node& targets, const char* what, const char* sum, int64_t value,
                       int64_t most) {
    if (value <= most) return;
    targets.KeyError(
        fmt::format("{} {} (the sum of the {}) are more than {}; lower them, or make "
                    "several suites",
                    value, what, sum, most));
  }

  void ReadOne(const Node& node, const Units& units) {
    node.CheckName();
    if (!node.CheckKeys({"file", "grasp"}, {"targets"})) return;
    SuiteMechanism entry;
    entry.name = node.key();
    entry.blocks = ReadBlocksOf(node["targets"], suite_.blocks);
    if (!ReadFile(node["file"], &entry.mechanism)) return;
    entry.grasp = ReadSuiteGrasp(node["grasp"], units, entry.mechanism);
    suite_.mechanisms.push_back(std::move(entry));
  }

  /// What is wrong with the mechanism joins what is wrong with the suite, once.
  bool ReadFile(const Node& node, Mechanism* mechanism) {
    const std::string name = node.Text();
    if (name.empty()) return false;
    try {
      const std::filesystem::path path = folder_ / name;
      MechanismSource source(ReadTextFile(path), path.string());
      std::vector<ParameterSetting> known;
      for (const ParameterSetting& setting : settings_) {
        if (source.parameters().Find(setting.name) < 0) continue;
        known.push_back(setting);
        set_.insert(setting.name);
      }
      ApplySettings(known, path.string(), source.units(), &source.parameters());
      *mechanism = source.Read();
      for (const MechanismSource::File& file : source.files()) {
        suite_.digest = DigestOf(file.text, suite_.digest);
      }
      return true;
    } catch (const FileErrors& errors) {
      const bool seen = std::find(faulty_.begin(), faulty_.end(), name) != faulty_.end();
      faulty_.push_back(name);
      if (seen) return false;
      for (const FileError& error : errors.errors()) document_.Report(error);
    }
    return false;
  }

  Document document_;
  std::filesystem::path folder_;
  Suite suite_;
  std::span<const ParameterSetting> settings_;
  std::set<std::string> set_;  ///< names of settings that a mechanism has
  std::vector<std::string> faulty_;
};

}  // namespace

Suite ReadSuite(const std::filesystem::path& path, std::span<const ParameterSetting> settings) {
  return ParseSuite(ReadTextFile(path), path, settings);
}

Suite ParseSuite(std::string_view text, const std::filesystem::path& path,
                 std::span<const ParameterSetting> settings) {
  return SuiteReader(text, path, settings).Read();
}

}  // namespace vmech
