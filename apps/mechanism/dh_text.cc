#include "vmech/apps/mechanism/dh_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "vmech/mechanisms/freedoms.h"

namespace vmech {
namespace {

using Cells = std::vector<std::string>;

std::string Figure(double value, double unit) {
  constexpr double kRounding = 1e-12;
  const double figure = value / unit;
  return std::abs(figure) < kRounding ? "0" : fmt::format("{:.15g}", figure);
}

std::string Length(double value) {
  return Figure(value, 1e-3);
}

std::string Angle(double value) {
  return Figure(value, std::numbers::pi / 180);
}

/// Where the coordinate is added: "pin: theta".
std::string Moving(const Mechanism& mechanism, const DhRow& row) {
  if (row.motion == DhMotion::kFixed) return "-";
  const Joint& joint = mechanism.joints[row.joint];
  const std::string name = NameOfFreedom(joint, row.freedom);
  switch (row.motion) {
    case DhMotion::kTranslation:
      return name + ": d";
    case DhMotion::kScrew:
      return fmt::format("{}: theta, d {} mm/deg", name,
                         Figure(row.pitch, 1e-3 / (std::numbers::pi / 180)));
    default:
      return name + ": theta";
  }
}

Cells RowCells(const Mechanism& mechanism, const DhTable& table, size_t i) {
  const DhRow& row = table.rows[i];
  std::string frame = "-";
  if (row.link >= 0) {
    frame = mechanism.links[row.link].name;
    if (table.row_of_link[row.link] != static_cast<int>(i)) frame = "on " + frame;
  }
  const DhParameters& p = row.parameters;
  return {std::to_string(i),
          row.from < 0 ? "world" : std::to_string(row.from),
          Moving(mechanism, row),
          Angle(p.theta),
          Length(p.d),
          Length(p.a),
          Angle(p.alpha),
          Angle(p.beta),
          Angle(row.gamma),
          Length(row.b),
          frame,
          row.axis,
          std::string(NameOf(row.relation))};
}

/// Leaves out beta, and gamma and b, where no row has them.
void DropUnused(std::vector<Cells>* table, size_t first, size_t last) {
  const bool used = std::any_of(table->begin() + 1, table->end(), [&](const Cells& row) {
    return std::any_of(row.begin() + first, row.begin() + last,
                       [](const std::string& cell) { return cell != "0"; });
  });
  if (used) return;
  for (Cells& row : *table) row.erase(row.begin() + first, row.begin() + last);
}

std::string Aligned(const std::vector<Cells>& table) {
  std::string text;
  std::vector<size_t> widths(table[0].size(), 0);
  for (const Cells& row : table) {
    for (size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  for (const Cells& row : table) {
    std::string line;
    for (size_t i = 0; i < row.size(); ++i) line += fmt::format("  {:<{}}", row[i], widths[i]);
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

}  // namespace

std::string DhText(const Mechanism& mechanism, const DhTable& table) {
  std::vector<Cells> cells{{"row", "from", "q", "theta", "d", "a", "alpha", "beta", "gamma", "b",
                            "link frame", "z along", "axes"}};
  for (size_t i = 0; i < table.rows.size(); ++i) cells.push_back(RowCells(mechanism, table, i));
  DropUnused(&cells, 8, 10);
  DropUnused(&cells, 7, 8);
  const bool branches = std::find(cells[0].begin(), cells[0].end(), "gamma") != cells[0].end();
  const bool hayati = std::find(cells[0].begin(), cells[0].end(), "beta") != cells[0].end();
  return fmt::format("Denavit-Hartenberg, mm and deg: {} Tx(a) Rx(alpha){}\n",
                     branches ? "Rz(theta + gamma) Tz(d + b)" : "Rz(theta) Tz(d)",
                     hayati ? " Ry(beta)" : "") +
         Aligned(cells);
}

}  // namespace vmech
