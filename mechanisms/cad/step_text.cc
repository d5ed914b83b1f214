#include "vmech/mechanisms/cad/step_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <regex>
#include <set>
#include <string_view>
#include <unordered_set>

#include "vmech/mechanisms/cad/step_reader.h"
#include "vmech/mechanisms/document.h"

namespace vmech {
namespace {

constexpr double kSmallest = 1e-3, kLargest = 100;  // [m] of a plausible assembly
constexpr size_t kLongestName = 80;                 // leaves room for numbers behind it

constexpr size_t kMaxStepBytes = size_t{1} << 30;
constexpr size_t kEnds = 256;  // bytes in which the first and the last words must stand

struct Entities {
  std::unordered_set<long> defined, referenced;
};

/// The entities "#12" of a STEP file; what stands in texts and comments is passed over. One that is
/// followed by '=' is defined there.
Entities FindEntities(std::string_view text) {
  Entities entities;
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\'') {
      i = std::min(text.find('\'', i + 1), text.size());
    } else if (text.substr(i, 2) == "/*") {
      i = std::min(text.find("*/", i + 2), text.size());
    } else if (text[i] == '#') {
      long number = 0;
      const auto [end, error] =
          std::from_chars(text.data() + i + 1, text.data() + text.size(), number);
      if (error != std::errc()) continue;
      i = static_cast<size_t>(end - text.data()) - 1;
      const size_t next = text.find_first_not_of(" \t\r\n", i + 1);
      const bool is_definition = next != std::string_view::npos && text[next] == '=';
      (is_definition ? entities.defined : entities.referenced).insert(number);
    }
  }
  return entities;
}

/// A name that files can hold (Node::CheckName).
std::string Clean(std::string name, const std::string& fallback) {
  for (char& c : name) {
    const bool refused = c == '/' || c == ',' || c == '"' || c == '\\';
    if (refused || std::iscntrl(static_cast<unsigned char>(c))) c = '_';
  }
  if (name.size() > kLongestName) name.resize(kLongestName);
  while (!name.empty() && (static_cast<unsigned char>(name.back()) & 0xC0) == 0x80) name.pop_back();
  while (!name.empty() && name.back() == ' ') name.pop_back();
  name.erase(0, name.find_first_not_of(' '));
  return name.empty() ? fallback : name;
}

/// Gives every item a name of its own: "bolt", "bolt-2", "bolt-3".
template <typename Item>
void MakeUnique(std::vector<Item>* items, const char* kind, std::vector<std::string>* remarks) {
  std::set<std::string> taken;
  for (Item& item : *items) {
    std::string name = item.name;
    for (int number = 2; !taken.insert(name).second; ++number) {
      name = fmt::format("{}-{}", item.name, number);
    }
    if (name != item.name) {
      remarks->push_back(fmt::format("{} {} is there more than once; one is called {} here", kind,
                                     Quoted(item.name), Quoted(name)));
    }
    item.name = name;
  }
}

/// The largest distance of a feature from another, which is about the size of the assembly.
double Size(const CadAssembly& assembly) {
  Vector3d low = Vector3d::Constant(INFINITY), high = -low;
  for (const CadPart& part : assembly.parts) {
    for (const CadFeature& feature : assembly.shapes[part.shape].features) {
      const Vector3d reach = Vector3d::Constant(std::max(feature.radius, 0.5 * feature.length));
      const Vector3d p_W = part.X_WP * feature.X_PF.p;
      low = low.cwiseMin(p_W - reach);
      high = high.cwiseMax(p_W + reach);
    }
  }
  return (high - low).maxCoeff();
}

void RemarkOnUnits(CadAssembly* assembly) {
  if (assembly->unit.empty()) {
    assembly->remarks.push_back("the file names no unit of length; millimetres are assumed");
  }
  const double size = Size(*assembly);
  if (std::isfinite(size) && (size < kSmallest || size > kLargest)) {
    assembly->remarks.push_back(
        fmt::format("the assembly measures {:.3g} mm; is the unit of the file right ({})?",
                    1e3 * size, assembly->unit.empty() ? "none" : assembly->unit));
  }
}

}  // namespace

void StepReadOptions::Validate() const {
  const bool in_range = mesh_deflection == 0 || (mesh_deflection >= 1e-7 && mesh_deflection <= 1);
  if (!in_range) {
    throw std::invalid_argument(fmt::format(
        "StepReadOptions: mesh_deflection [m] = {} is not 0 or 1e-7..1", mesh_deflection));
  }
}

void RequireWholeStepFile(const std::filesystem::path& path) {
  const std::string text = ReadTextFile(path, kMaxStepBytes);
  const std::string_view view = text;
  if (view.substr(0, kEnds).find("ISO-10303-21") == std::string::npos) {
    throw FileErrors(path.string(), "is not a STEP file: it does not begin with ISO-10303-21");
  }
  if (view.substr(view.size() - std::min(view.size(), kEnds)).find("END-ISO-10303-21") ==
      std::string::npos) {
    throw FileErrors(path.string(),
                     "is cut off: END-ISO-10303-21 is missing at its end; export or copy it again");
  }
  if (view.find("CARTESIAN_TRANSFORMATION_OPERATOR_3D") != std::string::npos) {
    throw FileErrors(
        path.string(),
        "places components by a mirror or a scale (CARTESIAN_TRANSFORMATION_OPERATOR_3D); "
        "make the mirrored or scaled component a part of its own in the CAD system");
  }
  const Entities entities = FindEntities(view);
  for (const long reference : entities.referenced) {
    if (entities.defined.count(reference) > 0) continue;
    throw FileErrors(path.string(),
                     fmt::format("is damaged: it refers to #{}, which it does not hold; export or "
                                 "copy it again",
                                 reference));
  }
}

std::string ComponentName(const std::string& component, const std::string& product) {
  static const std::regex made_up(R"(\s*|=>.*|NAUO\d*|\d+|id\d+)", std::regex::icase);
  return std::regex_match(component, made_up) && !product.empty() ? product : component;
}

void FinishAssembly(CadAssembly* assembly) {
  if (assembly->parts.empty()) {
    throw FileErrors(assembly->file, "holds no part with a surface; is the assembly empty?");
  }
  for (CadPart& part : assembly->parts) part.name = Clean(part.name, "part");
  for (CadGroup& group : assembly->groups) group.name = Clean(group.name, "group");
  for (CadFrame& frame : assembly->frames) frame.name = Clean(frame.name, "frame");
  MakeUnique(&assembly->parts, "part", &assembly->remarks);
  MakeUnique(&assembly->groups, "subassembly", &assembly->remarks);
  RemarkOnUnits(assembly);
}

}  // namespace vmech
