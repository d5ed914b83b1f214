#include "vmech/studies/study_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "vmech/dynamics/bearings/catalogue.h"
#include "vmech/mechanisms/files/mechanism_source.h"
#include "vmech/mechanisms/files/parameters.h"
#include "vmech/mechanisms/freedoms.h"
#include "vmech/studies/read_bearings.h"
#include "vmech/studies/read_motion.h"
#include "vmech/studies/read_paths.h"
#include "vmech/studies/read_simulation.h"
#include "vmech/studies/sha256.h"

namespace vmech {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr const char* kComponents[] = {"fx", "fy", "fz", "mx", "my", "mz"};

/// The wrench in a row of a table, or in the keys `force` and `moment`.
Wrenchd WrenchOfRow(const CsvTable& table, const Units& units, size_t row) {
  Vector6d w = Vector6d::Zero();
  for (int i = 0; i < 6; ++i) {
    if (const std::vector<double>* column = table.Find(kComponents[i])) w[i] = (*column)[row];
  }
  return {units.force.factor * w.head<3>(), units.torque.factor * w.tail<3>()};
}

/// A table over the angle of a drive repeats if it fills whole turns: its last row is a whole
/// number of turns after the first, or the next turn begins within its widest step. Else 0.
double PeriodOfTurns(const std::vector<double>& at) {
  if (at.size() < 2) return 0;
  double widest = 0;
  for (size_t i = 1; i < at.size(); ++i) widest = std::max(widest, at[i] - at[i - 1]);
  const double span = at.back() - at.front();
  const double turns = std::max(1.0, std::ceil(span / kTurn - 1e-9));
  return turns * kTurn - span <= widest * (1 + 1e-9) ? turns * kTurn : 0;
}

/// What a table is over, time or the coordinate of the first drive: fills `over` and `at`. Returns
/// the unit of the first column; none if the columns are wrong.
std::optional<Unit> ReadArgument(const Node& node, const CsvTable& table, const Units& units,
                                 const LoadStudy& study, ExternalLoad* load) {
  std::string argument = "t";
  std::string known = "'t'";
  Unit unit = units.time;
  if (study.times.empty()) return {};  // the motion is wrong, as reported there
  load->over = ExternalLoad::Over::kTime;
  if (!study.drives.empty()) {
    const JointDrive& drive = study.drives[0];
    const Joint& joint = study.mechanism.joints[drive.joint];
    const std::string driven = NameOfFreedom(joint, drive.freedom);
    known = fmt::format("'t' or the driven joint '{}'", driven);
    if (table.names[0] == driven) {
      argument = driven;
      unit = IsRotation(joint.type, drive.freedom) ? units.angle : units.length;
      load->over = ExternalLoad::Over::kDriveCoordinate;
    }
  }
  if (table.names[0] != argument) {
    ReportInTable(
        node, table, -1,
        fmt::format("the first column must be {}, not {}", known, Quoted(table.names[0])));
    return {};
  }
  if (!CheckColumns(node, table, {argument}, {std::begin(kComponents), std::end(kComponents)})) {
    return {};
  }
  for (const double at : table.columns[0]) load->at.push_back(unit.factor * at);
  return unit;
}

/// The period of a table: as stated, or whole turns of a drive that rotates.
double ReadPeriod(const Node& period, const Unit& unit, const LoadStudy& study,
                  const ExternalLoad& load) {
  if (period) return period.Positive(unit);
  if (load.over != ExternalLoad::Over::kDriveCoordinate) return 0;
  const JointDrive& drive = study.drives[0];
  const JointType type = study.mechanism.joints[drive.joint].type;
  return IsRotation(type, drive.freedom) ? PeriodOfTurns(load.at) : 0;
}

/// A table must not reach beyond its period, nor jump where it meets itself again.
void CheckPeriod(const Node& node, const CsvTable& table, const ExternalLoad& load) {
  const double span = load.at.back() - load.at.front();
  if (load.period == 0 || span < load.period * (1 - 1e-9)) return;
  const int last = static_cast<int>(table.rows()) - 1;
  if (span > load.period * (1 + 1e-9)) {
    ReportInTable(node, table, last, "this row is beyond one period of the table");
    return;
  }
  const Vector6d a = load.wrenches.front().Stacked(), b = load.wrenches.back().Stacked();
  if ((a - b).norm() > 1e-6 * std::max(a.norm(), b.norm())) {
    ReportInTable(node, table, last, "one period after the first row, but with other values");
  }
}

void ReadLoadTable(const Node& node, const Units& units, const std::filesystem::path& folder,
                   const LoadStudy& study, ExternalLoad* load) {
  for (const char* key : {"force", "moment"}) {
    if (const Node extra = node[key]) extra.KeyError("give either this or a table");
  }
  const CsvTable table = ReadTable(node["table"], folder);
  if (table.rows() == 0) return;
  const std::optional<Unit> unit = ReadArgument(node["table"], table, units, study, load);
  if (!unit) return;
  for (size_t i = 0; i < table.rows(); ++i) load->wrenches.push_back(WrenchOfRow(table, units, i));
  load->period = ReadPeriod(node["period"], *unit, study, *load);
  CheckPeriod(node["table"], table, *load);
}

ExternalLoad ReadExternalLoad(const Node& node, const Units& units,
                              const std::filesystem::path& folder, const LoadStudy& study) {
  ExternalLoad load;
  if (!node.CheckKeys({"link"},
                      {"description", "at", "axes", "force", "moment", "table", "period"})) {
    return load;
  }
  node["description"].Text();
  load.link = FindPart(node["link"], "link", study.mechanism.links);
  load.p_L = node["at"].Vector3(units.length);
  load.axes = node["axes"].Word<ExternalLoad::Axes>(
      {{"world", ExternalLoad::Axes::kWorld}, {"link", ExternalLoad::Axes::kLink}},
      ExternalLoad::Axes::kWorld);
  if (node["table"]) {
    ReadLoadTable(node, units, folder, study, &load);
    return load;
  }
  if (!node["force"] && !node["moment"]) node.KeyError("give 'force', 'moment' or 'table'");
  if (const Node period = node["period"]) period.KeyError("used with a table only");
  load.at = {0};
  load.wrenches = {{node["force"].Vector3(units.force), node["moment"].Vector3(units.torque)}};
  return load;
}

ReactionRule ReadRule(const Node& node) {
  return node.Word<ReactionRule>({{NameOf(ReactionRule::kStiffness), ReactionRule::kStiffness},
                                  {NameOf(ReactionRule::kMinimumNorm), ReactionRule::kMinimumNorm},
                                  {NameOf(ReactionRule::kPaperJoint), ReactionRule::kPaperJoint}},
                                 ReactionRule::kStiffness);
}

/// What refers to the parts of the mechanism.
void ReadReferences(const Node& root, const Units& units, const std::filesystem::path& folder,
                    StudyFile* file) {
  LoadStudy& loads = file->study;
  if (root["simulation"]) {
    ReadSimulation(root["simulation"], units, folder, file);
  } else {
    ReadMotion(root["motion"], units, folder, &loads);
  }
  for (const Node& entry : root["external"].List()) {
    loads.external.push_back(ReadExternalLoad(entry, units, folder, loads));
  }
  if (const Node length = root["norm_length"]) loads.norm_length = length.Positive(units.length);
  for (const Node& entry : root["bearings"].Map()) {
    file->bearings.push_back(ReadBearings(entry, units, loads.mechanism));
  }
  if (root["paths"] && root["simulation"]) {
    root["paths"].KeyError("used with a motion only, which has its poses");
  } else {
    file->paths = ReadPaths(root["paths"], units, folder, loads);
  }
}

/// The catalogue that a study names, or the built-in one.
std::vector<Bearing> ReadNamedCatalogue(const Node& node, const std::filesystem::path& folder) {
  if (!node) return BuiltInCatalogue();
  try {
    const std::filesystem::path path = folder / node.Text();
    std::vector<Bearing> catalogue = ReadCatalogue(path.string());
    node.document().NoteNamedFile({path, Sha256(ReadTextFile(path))});
    return catalogue;
  } catch (const std::runtime_error& defect) {
    node.Error(defect.what());
  }
  return {};
}

/// The study's own text and the files that it names, each once.
std::vector<InputFile> InputsOf(std::string_view text, const std::filesystem::path& path,
                                const Document& document) {
  std::vector<InputFile> inputs = {{path, Sha256(text)}};
  for (const Document::NamedFile& named : document.named_files()) {
    const bool known = std::any_of(inputs.begin(), inputs.end(), [&](const InputFile& input) {
      return input.path == named.path;
    });
    if (!known) inputs.push_back({named.path, named.digest});
  }
  return inputs;
}

void CheckVersion(const Node& version) {
  const std::string text = version.Text(std::string(kStudyFormat));
  if (text == kStudyFormat) return;
  version.Error(fmt::format("this is format {}; only {} can be read", Quoted(text), kStudyFormat));
}

/// Either a motion that is given, or one that is simulated.
void CheckMotion(const Node& root) {
  const Node motion = root["motion"], simulation = root["simulation"];
  if (!motion && !simulation) root.KeyError("the key 'motion' is missing, or 'simulation'");
  if (motion && simulation) simulation.KeyError("give either a motion or a simulation");
}

/// A study with the mechanism that it names; both see the parameters of both.
class StudyReader {
 public:
  StudyReader(std::string_view text, std::filesystem::path path)
      : text_(text), document_(text, path.string()), root_(document_.root()) {
    file_.path = std::move(path);
  }

  StudyFile Read(std::span<const ParameterSetting> settings) {
    if (root_.CheckKeys(
            {"vmech_study", "mechanism"},
            {"motion", "simulation", "name", "description", "units", "parameters", "external",
             "rule", "norm_length", "bearings", "catalogue", "limits", "paths"})) {
      ReadOwn();
      if (OpenMechanism()) ReadRest(settings);
    }
    document_.ThrowErrors();
    file_.motion = file_.simulation ? SimulationInWords(root_["simulation"], file_)
                                    : MotionInWords(root_["motion"], file_.study);
    file_.inputs = InputsOf(text_, file_.path, document_);
    if (!file_.simulation) file_.notes = NotesOnFreedoms(root_["motion"], file_.study);
    return std::move(file_);
  }

 private:
  /// What does not refer to the mechanism.
  void ReadOwn() {
    CheckVersion(root_["vmech_study"]);
    CheckMotion(root_);
    file_.name = root_["name"].Text(file_.path.stem().string());
    file_.description = root_["description"].Text();
    file_.study.rule = ReadRule(root_["rule"]);
    units_ = ReadUnits(root_["units"]);
    file_.study.units = DisplayUnitsOf(root_["units"], units_);
    file_.study.stop_at_limits =
        root_["limits"].Word<bool>({{"warn", false}, {"stop", true}}, false);
    if (const Node limits = root_["limits"]; limits && root_["simulation"]) {
      limits.Error(
          "is for a motion that is prescribed: in a simulation joints stop at their limits and "
          "rebound; leave it out, and give `restitution`, or end the run there by `watch`");
    }
    file_.catalogue = ReadNamedCatalogue(root_["catalogue"], folder());
  }

  /// What is wrong with the mechanism joins what is wrong with the study.
  bool OpenMechanism() {
    const std::string name = root_["mechanism"].Text();
    if (name.empty()) return false;
    file_.mechanism_path = folder() / name;
    try {
      source_.emplace(ReadTextFile(file_.mechanism_path), file_.mechanism_path.string());
      return true;
    } catch (const FileErrors& errors) {
      TakeErrors(errors);
    }
    return false;
  }

  void ReadRest(std::span<const ParameterSetting> settings) {
    file_.settings.assign(settings.begin(), settings.end());
    ParameterTable& table = source_->parameters();
    const std::vector<std::string> of_mechanism = table.names();
    const CountingUnits units = units_.counting();
    ReadParameters(root_["parameters"], units, &table);
    ApplySettings(settings, file_.path.string(), units, &table);
    const StudyFile begun = file_;
    const size_t errors_before = document_.error_count();
    while (true) {
      try {
        file_.study.mechanism = source_->Read();
      } catch (const FileErrors& errors) {
        return TakeErrors(errors);
      }
      for (const MechanismSource::File& file : source_->files()) {
        document_.NoteNamedFile({file.path, Sha256(file.text)});
      }
      document_.SetScope({units, table.names(), source_->values(), {}});
      ReadReferences(root_, units_, folder(), &file_);
      for (const ParameterUse& use : document_.uses()) {
        if (use.alone) table.NoteUse(use.parameter, use.asked);
      }
      if (!table.learned()) break;
      file_ = begun;
      document_.ForgetErrorsAfter(errors_before);
    }
    file_.parameters = source_->stated();
    RefuseUnused(of_mechanism);
  }

  /// A parameter that the mechanism has not, and that nothing here names, is a slip of the pen.
  void RefuseUnused(const std::vector<std::string>& of_mechanism) {
    const ParameterTable& table = source_->parameters();
    std::set<std::string> used(of_mechanism.begin(), of_mechanism.end());
    for (const ParameterUse& use : document_.uses()) used.insert(use.parameter);
    for (int i = 0; i < table.size(); ++i) {
      const std::vector<std::string>& names = table.holding(i).expression.names();
      used.insert(names.begin(), names.end());
    }
    if (!root_["parameters"]) return;
    for (const Node& entry : root_["parameters"].Map()) {
      if (used.contains(entry.key())) continue;
      entry.KeyError(fmt::format("{} has no parameter {}, and nothing in this study names it{}",
                                 file_.mechanism_path.string(), Quoted(entry.key()),
                                 DidYouMean(entry.key(), of_mechanism)));
    }
  }

  void TakeErrors(const FileErrors& errors) {
    for (const FileError& error : errors.errors()) document_.Report(error);
  }
  std::filesystem::path folder() const { return file_.path.parent_path(); }

  std::string_view text_;
  Document document_;
  Node root_;
  Units units_;
  StudyFile file_;
  std::optional<MechanismSource> source_;
};

}  // namespace

StudyFile ReadStudy(const std::filesystem::path& path, std::span<const ParameterSetting> settings) {
  return ParseStudy(ReadTextFile(path), path, settings);
}

StudyFile ParseStudy(std::string_view text, const std::filesystem::path& path,
                     std::span<const ParameterSetting> settings) {
  return StudyReader(text, path).Read(settings);
}

}  // namespace vmech
