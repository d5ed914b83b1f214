#include "vmech/dynamics/bearings/catalogue.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <map>
#include <numbers>
#include <set>
#include <sstream>
#include <stdexcept>

#include "vmech/mechanisms/files/document.h"

namespace vmech {

std::string_view BuiltInCatalogueText();

namespace {

constexpr std::array<std::string_view, 11> kColumns{
    "designation", "kind", "d_mm",         "D_mm",      "B_mm",       "C_kN",
    "C0_kN",       "f0",   "n_grease_rpm", "n_oil_rpm", "axial_limit"};
constexpr std::array<std::string_view, 7> kRequired{"designation", "kind", "d_mm", "D_mm",
                                                    "B_mm",        "C_kN", "C0_kN"};

std::string_view Trim(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r";
  const size_t first = text.find_first_not_of(kBlank);
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

std::vector<std::string_view> Split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  while (true) {
    const size_t end = text.find(separator);
    parts.push_back(Trim(text.substr(0, end)));
    if (end == text.npos) return parts;
    text.remove_prefix(end + 1);
  }
}

class Parser {
 public:
  explicit Parser(std::string name) : name_(std::move(name)) {}

  std::vector<Bearing> Parse(std::string_view text) {
    for (std::string_view line : Split(text, '\n')) {
      ++line_;
      if (line.empty() || line.front() == '#') continue;
      if (columns_.empty()) {
        ReadHeader(line);
      } else {
        ReadRow(line);
      }
      if (header_is_bad_) break;
    }
    if (bearings_.empty() && errors_.empty()) Report("the catalogue holds no bearings");
    if (!errors_.empty()) throw std::runtime_error(fmt::format("{}", fmt::join(errors_, "\n")));
    std::sort(bearings_.begin(), bearings_.end(), IsSmaller);
    return std::move(bearings_);
  }

 private:
  void Report(const std::string& what) {
    errors_.push_back(fmt::format("{}:{}: {}", name_, line_, what));
  }

  void ReadHeader(std::string_view line) {
    columns_ = Split(line, ',');
    std::set<std::string_view> seen;
    for (std::string_view column : columns_) {
      if (std::find(kColumns.begin(), kColumns.end(), column) == kColumns.end()) {
        const std::vector<std::string> known(kColumns.begin(), kColumns.end());
        const std::string hint = DidYouMean(column, known);
        Report(fmt::format(
            "unknown column '{}'{}", column,
            hint.empty() ? fmt::format("; the columns are {}", fmt::join(known, ", ")) : hint));
      }
      if (!seen.insert(column).second) Report(fmt::format("column '{}' appears twice", column));
    }
    for (std::string_view column : kRequired) {
      if (!seen.contains(column)) Report(fmt::format("column '{}' is missing", column));
    }
    header_is_bad_ = !errors_.empty();
  }

  void ReadRow(std::string_view line) {
    const std::vector<std::string_view> fields = Split(line, ',');
    if (fields.size() != columns_.size()) {
      Report(fmt::format("{} fields, but the header names {} columns", fields.size(),
                         columns_.size()));
      return;
    }
    row_.clear();
    for (size_t i = 0; i < fields.size(); ++i) row_[columns_[i]] = fields[i];
    bearings_.push_back(MakeBearing());
    CheckBearing(bearings_.back());
  }

  Bearing MakeBearing() {
    constexpr double kPerMilli = 1e3, kKilo = 1e3, kRpm = std::numbers::pi / 30;
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    Bearing bearing;
    bearing.designation = row_["designation"];
    bearing.kind = ReadKind();
    bearing.bore = ReadNumber("d_mm") / kPerMilli;
    bearing.outer_diameter = ReadNumber("D_mm") / kPerMilli;
    bearing.width = ReadNumber("B_mm") / kPerMilli;
    bearing.dynamic_rating = ReadNumber("C_kN") * kKilo;
    bearing.static_rating = ReadNumber("C0_kN") * kKilo;
    if (bearing.kind == BearingKind::kDeepGrooveBall) bearing.f0 = ReadNumber("f0");
    bearing.speed_grease = ReadNumberOr("n_grease_rpm", kInfinity) * kRpm;
    bearing.speed_oil = ReadNumberOr("n_oil_rpm", kInfinity) * kRpm;
    bearing.axial_limit = ReadNumberOr("axial_limit", kInfinity);
    return bearing;
  }

  BearingKind ReadKind() {
    const std::string_view word = row_["kind"];
    if (word == NameOf(BearingKind::kCylindricalRoller)) return BearingKind::kCylindricalRoller;
    if (word != NameOf(BearingKind::kDeepGrooveBall)) {
      Report(fmt::format("kind is '{}', but must be {} or {}", word,
                         NameOf(BearingKind::kDeepGrooveBall),
                         NameOf(BearingKind::kCylindricalRoller)));
    }
    return BearingKind::kDeepGrooveBall;
  }

  double ReadNumberOr(std::string_view column, double fallback) {
    return row_[column].empty() ? fallback : ReadNumber(column);
  }

  /// Every number of a catalogue is positive and finite.
  double ReadNumber(std::string_view column) {
    const std::string_view field = row_[column];
    double value = 0;
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (error != std::errc() || end != field.data() + field.size() || !std::isfinite(value) ||
        value <= 0) {
      Report(fmt::format("{} is '{}', but must be a number above 0", column, field));
    }
    return value;
  }

  void CheckBearing(const Bearing& bearing) {
    if (bearing.designation.empty()) Report("designation is empty");
    if (!designations_.insert(bearing.designation).second) {
      Report(fmt::format("designation '{}' appears twice", bearing.designation));
    }
    if (bearing.outer_diameter > 0 && bearing.bore >= bearing.outer_diameter) {
      Report(fmt::format("bore d_mm = {} is not below the outer diameter D_mm = {}", row_["d_mm"],
                         row_["D_mm"]));
    }
  }

  std::string name_;
  int line_ = 0;
  bool header_is_bad_ = false;
  std::vector<std::string_view> columns_;
  std::map<std::string_view, std::string_view> row_;
  std::set<std::string> designations_;
  std::vector<Bearing> bearings_;
  std::vector<std::string> errors_;
};

}  // namespace

std::vector<Bearing> ParseCatalogue(std::string_view text, const std::string& name) {
  return Parser(name).Parse(text);
}

std::vector<Bearing> ReadCatalogue(const std::string& path) {
  std::ifstream file(path);
  std::ostringstream text;
  if (!file || !(text << file.rdbuf())) {
    throw std::runtime_error(fmt::format("{}: cannot read the bearing catalogue", path));
  }
  return ParseCatalogue(text.str(), path);
}

const std::vector<Bearing>& BuiltInCatalogue() {
  static const std::vector<Bearing> catalogue =
      ParseCatalogue(BuiltInCatalogueText(), "built-in deep_groove_ball.csv");
  return catalogue;
}

}  // namespace vmech
