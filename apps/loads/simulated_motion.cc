#include "vmech/apps/loads/simulated_motion.h"

#include <fmt/format.h>

#include <limits>
#include <string>
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
  int poses = 0;
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
  summary.poses = root["poses"].Integer(0, 0, std::numeric_limits<int>::max());
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
  const CsvTable table = ParseCsvTable(text, path.string());
  if (static_cast<size_t>(summary.poses) != table.rows()) {
    throw FileErrors(path.string(),
                     fmt::format("has {} rows, but summary.json beside it tells of {} poses; the "
                                 "folder is not whole",
                                 table.rows(), summary.poses));
  }
  file->history = HistoryIn(table, file->study.mechanism);
  file->study.times = file->history->times;
  file->study.cycle = 0;
  file->motion = fmt::format("as in {} ({})", folder.string(), summary.motion);
  file->inputs.push_back({path, Sha256(text)});
  return summary.unfinished;
}

}  // namespace vmech
