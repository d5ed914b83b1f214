#include "vmech/apps/loads/simulated_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "vmech/apps/loads/tables.h"
#include "vmech/mechanisms/files/document.h"
#include "vmech/mechanisms/freedoms.h"
#include "vmech/studies/csv_table.h"
#include "vmech/studies/sha256.h"

namespace vmech {
namespace {

namespace fs = std::filesystem;

/// What summary.json says of a motion.
struct MotionSummary {
  std::string mechanism, digest, motion;
  std::string unfinished;
  size_t poses = 0;
  std::vector<size_t> singular_poses;  ///< whose rows hold no numbers
};

void RequireResults(const fs::path& folder) {
  for (const char* name : {"joints.csv", "summary.json"}) {
    if (fs::exists(folder / name)) continue;
    throw FileErrors(folder.string(),
                     fmt::format("has no {}: --motion takes a result folder of `vmech simulate` or "
                                 "`vmech loads`",
                                 name));
  }
}

MotionSummary ReadMotionSummary(const fs::path& path) {
  Document document(ReadTextFile(path), path.string());
  const Node root = document.root();
  MotionSummary summary;
  summary.mechanism = root["mechanism"].Text();
  summary.digest = root["mechanism_sha256"].Text();
  summary.motion = root["motion"].Text();
  constexpr int kMost = std::numeric_limits<int>::max();
  summary.poses = static_cast<size_t>(root["poses"].Integer(0, 0, kMost));
  for (const Node& pose : root["singular_poses"].List()) {
    summary.singular_poses.push_back(static_cast<size_t>(pose.Integer(0, 0, kMost)));
  }
  if (!root["mechanism_sha256"]) {
    root.Error(
        "does not say of which mechanism file it is (mechanism_sha256); run the command "
        "that made it again");
  }
  if (const Node simulation = root["simulation"]) {
    const std::string status = simulation["status"].Text();
    if (status != NameOf(SimulationStatus::kFinished) &&
        status != NameOf(SimulationStatus::kReached)) {
      summary.unfinished = fmt::format("{}: {}", status, simulation["message"].Text());
    }
  }
  document.ThrowErrors();
  return summary;
}

void RequireSameMechanism(const fs::path& folder, const MotionSummary& summary,
                          const StudyFile& file) {
  if (summary.digest == DigestOfMechanism(file)) return;
  throw FileErrors(
      folder.string(),
      fmt::format("is a motion of another mechanism: '{}', whose file had the SHA-256 {}, and not "
                  "{} as it is now ({}); simulate this one, or give the study of that one",
                  summary.mechanism, summary.digest, file.mechanism_path.string(),
                  DigestOfMechanism(file)));
}

/// Does a row say nothing but when it is?
bool IsLeftOut(std::string_view line) {
  size_t cells = 0;
  for (size_t comma = line.find(','); comma != line.npos; comma = line.find(',', comma + 1)) {
    if (line.substr(comma + 1, 3) != "nan") return false;
    ++cells;
  }
  return cells > 0;
}

/// The table with empty lines for the poses at which no loads are determined.
std::string WithoutSingularPoses(std::string_view text, const std::vector<size_t>& poses) {
  std::string kept;
  size_t line = 0;  // the first one has the names
  for (auto next = poses.begin(); !text.empty(); ++line) {
    const size_t length = std::min(text.find('\n'), text.size() - 1) + 1;
    const bool singular = next != poses.end() && line == *next + 1;
    if (singular) ++next;
    kept += singular && IsLeftOut(text.substr(0, length)) ? "\n" : text.substr(0, length);
    text.remove_prefix(length);
  }
  return kept;
}

/// The rows of a table that is whole, but for the poses at which no loads are determined.
CsvTable ReadRows(const fs::path& path, const std::string& text, const MotionSummary& summary) {
  if (!text.ends_with('\n')) {
    throw FileErrors(path.string(), "ends within a row; the file has been cut short");
  }
  CsvTable table = ParseCsvTable(WithoutSingularPoses(text, summary.singular_poses), path.string());
  const size_t rows = table.rows() + summary.singular_poses.size();
  if (summary.poses == rows) return table;
  throw FileErrors(path.string(),
                   fmt::format("has {} rows, but summary.json beside it tells of {} poses; the "
                               "folder is not whole",
                               rows, summary.poses));
}

/// A column for each freedom of each joint.
struct HistoryColumns {
  std::vector<const std::vector<double>*> positions, rates, accelerations;
};

HistoryColumns FindColumns(const CsvTable& table, const Mechanism& mechanism) {
  HistoryColumns columns;
  std::vector<FileError> errors;
  const auto find = [&](const std::string& name, std::vector<const std::vector<double>*>* to) {
    to->push_back(table.Find(name));
    if (to->back() != nullptr) return;
    errors.push_back(
        {table.file, table.names_line, 1, "", fmt::format("the column '{}' is missing", name)});
  };
  for (const Joint& joint : mechanism.joints) {
    for (int k = 0; k < FreedomsOf(joint.type); ++k) {
      const std::string freedom = NameOfFreedom(joint, k);
      find(freedom + ".position", &columns.positions);
      find(freedom + ".rate", &columns.rates);
      find(freedom + ".acceleration", &columns.accelerations);
    }
  }
  if (table.names[0] != "t") {
    errors.push_back({table.file, table.names_line, 1, "", "the first column must be 't'"});
  }
  if (!errors.empty()) throw FileErrors(errors);
  return columns;
}

std::vector<double> RowByRow(const std::vector<const std::vector<double>*>& columns, size_t rows) {
  std::vector<double> values;
  values.reserve(columns.size() * rows);
  for (size_t row = 0; row < rows; ++row) {
    for (const std::vector<double>* column : columns) values.push_back((*column)[row]);
  }
  return values;
}

JointHistory HistoryIn(const CsvTable& table, const Mechanism& mechanism) {
  const HistoryColumns columns = FindColumns(table, mechanism);
  JointHistory history;
  history.times = table.columns[0];
  history.positions = RowByRow(columns.positions, table.rows());
  history.rates = RowByRow(columns.rates, table.rows());
  history.accelerations = RowByRow(columns.accelerations, table.rows());
  return history;
}

}  // namespace

std::string TakeMotionOf(const fs::path& folder, StudyFile* file) {
  RequireResults(folder);
  const MotionSummary summary = ReadMotionSummary(folder / "summary.json");
  RequireSameMechanism(folder, summary, *file);
  if (file->study.hand) {
    throw FileErrors(file->path.string(),
                     "is moved by a hand, and --motion by a table of joints: give a study with "
                     "drives, or with a block `simulation`, whose hand is a spring");
  }
  const fs::path path = folder / "joints.csv";
  const std::string text = ReadTextFile(path, kMaxTableBytes);
  const CsvTable table = ReadRows(path, text, summary);
  file->history = HistoryIn(table, file->study.mechanism);
  file->study.times = file->history->times;
  file->study.cycle = 0;
  file->motion = fmt::format("as in {} ({})", folder.string(), summary.motion);
  if (const size_t singular = summary.singular_poses.size(); singular > 0) {
    file->motion += fmt::format(", but for {} {} at which the loops are singular", singular,
                                singular == 1 ? "pose" : "poses");
  }
  file->inputs.push_back({path, Sha256(text)});
  return summary.unfinished;
}

}  // namespace vmech
