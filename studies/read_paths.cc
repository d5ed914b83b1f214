#include "vmech/studies/read_paths.h"

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "vmech/mechanisms/mechanism.h"
#include "vmech/studies/csv_table.h"
#include "vmech/studies/read_motion.h"

namespace vmech {
namespace {

/// A row of a table belongs to the pose of the same number, and must be of the same time.
void CheckTimes(const Node& node, const CsvTable& table, const Units& units,
                const LoadStudy& study) {
  constexpr double kFigures = 1e-6;  // of the whole time
  const double span = study.times.back() - study.times.front();
  const std::vector<double>& times = *table.Find("t");
  for (size_t i = 0; i < times.size() && i < study.times.size(); ++i) {
    const double t = units.time.factor * times[i];
    if (std::abs(t - study.times[i]) <= kFigures * span) continue;
    ReportInTable(node, table, static_cast<int>(i),
                  fmt::format("t = {:.6g} s, but pose {} of the motion is at t = {:.6g} s; a path "
                              "has a row for every pose",
                              t, i, study.times[i]));
    return;
  }
}

std::vector<Vector3d> ReadPointTable(const Node& node, const Units& units,
                                     const std::filesystem::path& folder, const LoadStudy& study) {
  const CsvTable table = ReadTable(node, folder);
  if (table.rows() == 0 || !CheckColumns(node, table, {"t", "x", "y", "z"}, {})) return {};
  CheckTimes(node, table, units, study);
  std::vector<Vector3d> points;
  for (size_t i = 0; i < table.rows(); ++i) {
    const Vector3d p((*table.Find("x"))[i], (*table.Find("y"))[i], (*table.Find("z"))[i]);
    points.push_back(units.length.factor * p);
  }
  return points;
}

std::vector<Vector3d> ReadPointList(const Node& node, const Units& units) {
  std::vector<Vector3d> points;
  for (const Node& entry : node.List()) points.push_back(entry.Vector3(units.length));
  return points;
}

/// An entry of `paths`, whose key names a grasp.
WantedPath ReadPath(const Node& node, const Units& units, const std::filesystem::path& folder,
                    const LoadStudy& study) {
  WantedPath path;
  std::vector<std::string> names;
  for (const Grasp& grasp : study.mechanism.grasps) names.push_back(grasp.name);
  path.grasp = FindGrasp(study.mechanism, node.key());
  if (path.grasp < 0) {
    node.KeyError("grasp " + Quoted(node.key()) + " not found" + DidYouMean(node.key(), names));
    return path;
  }
  const bool in_table = node.kind() == Node::Kind::kScalar;
  path.points = in_table ? ReadPointTable(node, units, folder, study) : ReadPointList(node, units);
  if (!path.points.empty() && path.points.size() != study.times.size()) {
    node.Error(fmt::format("there are {} points, but the motion has {} poses; give one for each",
                           path.points.size(), study.times.size()));
  }
  return path;
}

}  // namespace

std::vector<WantedPath> ReadPaths(const Node& node, const Units& units,
                                  const std::filesystem::path& folder, const LoadStudy& study) {
  std::vector<WantedPath> paths;
  if (study.times.empty()) return paths;  // the motion is wrong, as reported there
  for (const Node& entry : node.Map()) paths.push_back(ReadPath(entry, units, folder, study));
  return paths;
}

}  // namespace vmech
