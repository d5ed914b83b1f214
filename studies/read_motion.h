#pragma once

#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "vmech/base/pose.h"
#include "vmech/dynamics/loads/load_study.h"
#include "vmech/mechanisms/files/document.h"
#include "vmech/mechanisms/files/units.h"
#include "vmech/studies/csv_table.h"

namespace vmech {

/// Reads a table that a node names, relative to a folder; reports at the node or in the table's own
/// file what is wrong. Empty (no rows) if it cannot be used.
CsvTable ReadTable(const Node& node, const std::filesystem::path& folder);

/// Reports an error in a table, at its names (row < 0) or at a row.
void ReportInTable(const Node& node, const CsvTable& table, int row, std::string message);

/// Reports columns of a table that are missing or not known.
bool CheckColumns(const Node& node, const CsvTable& table, const std::vector<std::string>& required,
                  const std::vector<std::string>& optional);

/// The index of the part that a node names in a list; -1 if there is none, which is reported.
template <typename Part>
int FindPart(const Node& node, std::string_view kind, const std::vector<Part>& parts) {
  const bool scalar = node.kind() == Node::Kind::kScalar;
  const size_t errors_before = scalar ? node.document().error_count() : 0;
  const std::string name = node.Text();
  if (!scalar || node.document().error_count() > errors_before) return -1;
  std::vector<std::string> names;
  for (const Part& part : parts) names.push_back(part.name);
  for (size_t i = 0; i < names.size(); ++i) {
    if (names[i] == name) return static_cast<int>(i);
  }
  node.Error(std::string(kind) + " " + Quoted(name) + " not found" + DidYouMean(name, names));
  return -1;
}

/// True if a freedom of a joint is a rotation.
bool IsRotation(JointType type, int freedom);

/// The value of `motion` for a structure that cannot move: one pose, no drive.
constexpr std::string_view kStill = "still";

/// The joint and the freedom that a node names by `joint` and `freedom`. False if there is none,
/// which is reported. `balls`: those of spherical joints count too, which have rates and no
/// coordinates.
bool ReadDriven(const Node& node, const Mechanism& mechanism, JointDrive* drive,
                bool balls = false);

/// A speed from `rpm` or `speed` [rad/s] or [m/s].
double ReadSpeed(const Node& node, bool rotates, const Units& units);

/// A drive that does not set the poses, added to those of a study.
void ReadFollowingDrive(const Node& node, const Units& units, const std::filesystem::path& folder,
                        LoadStudy* study);

/// A table of the hand's poses.
struct HandTable {
  HandLaw law;                ///< poses over time
  std::vector<double> times;  ///< [s]
  std::vector<Posed> poses;   ///< one for each time
  bool closed = false;        ///< it ends where it began
};
/// Nothing if the table cannot be used, which is reported.
std::optional<HandTable> ReadHandTable(const Node& node, const Units& units,
                                       const std::filesystem::path& folder, GraspKind kind);

/// Reads the block `motion` into the drives, or the hand, and the times of a study.
void ReadMotion(const Node& node, const Units& units, const std::filesystem::path& folder,
                LoadStudy* study);

/// What a sound block `motion` says in the manner of earlier studies, which counted freedoms.
std::vector<std::string> NotesOnFreedoms(const Node& node, const LoadStudy& study);

/// A sound block `motion`, read into `study`, in words: "main at 1500 rpm, 2 turns".
std::string MotionInWords(const Node& node, const LoadStudy& study);

}  // namespace vmech
