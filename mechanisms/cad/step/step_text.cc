#include "vmech/mechanisms/cad/step/step_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <regex>
#include <set>
#include <string_view>
#include <unordered_set>

#include "vmech/mechanisms/cad/step/part_name.h"
#include "vmech/mechanisms/files/document.h"

namespace vmech {
namespace {

constexpr double kSmallest = 1e-3, kLargest = 100;  // [m] of a plausible assembly

constexpr size_t kMaxStepBytes = size_t{1} << 30;
constexpr size_t kEnds = 256;  // bytes in which the first and the last words must stand

/// What the text of a STEP file defines and refers to, and the first fault of it, in words. What
/// stands in texts and comments is passed over.
class EntityScan {
 public:
  explicit EntityScan(std::string_view text) : text_(text) {
    for (size_t i = 0; i < text.size(); ++i) i = Visit(i);
    for (const long number : referenced_) {
      if (defined_.count(number) > 0) continue;
      SetFault(fmt::format("it refers to #{}, which it does not hold", number));
    }
  }

  const std::string& fault() const { return fault_; }

 private:
  /// Looks at a character; returns the last one of what begins there.
  size_t Visit(size_t i) {
    if (text_[i] == '\'') return std::min(text_.find('\'', i + 1), text_.size());
    if (text_.substr(i, 2) == "/*") return std::min(text_.find("*/", i + 2), text_.size());
    if (text_[i] == '#') return VisitEntity(i);
    if (text_[i] == '\0') SetFault("there is a zero byte", i);
    if (IsExponent(i)) CheckExponent(i);
    return i;
  }

  /// "#12" is defined if '=' follows.
  size_t VisitEntity(size_t i) {
    long number = 0;
    const auto [end, error] =
        std::from_chars(text_.data() + i + 1, text_.data() + text_.size(), number);
    if (error != std::errc()) return i;
    const auto after = static_cast<size_t>(end - text_.data());
    const size_t next = text_.find_first_not_of(" \t\r\n", after);
    if (next == std::string_view::npos || text_[next] != '=') {
      referenced_.insert(number);
    } else if (!defined_.insert(number).second) {
      SetFault(fmt::format("it defines #{} a second time", number), i);
    }
    return after - 1;
  }

  bool IsExponent(size_t i) const {
    const bool is_letter = text_[i] == 'E' || text_[i] == 'e';
    return is_letter && i > 0 && kDigits.find(text_[i - 1]) != std::string_view::npos;
  }

  void CheckExponent(size_t i) {
    const size_t first = text_.find_last_not_of(kDigits, i - 1) + 1;
    const size_t sign = text_.find_first_not_of('+', i + 1);
    const size_t end = std::min(text_.find_first_not_of(kDigits, sign), text_.size());
    if (sign == std::string_view::npos || text_[sign] == '-') return;
    int exponent = 0;
    const auto [stop, error] = std::from_chars(text_.data() + sign, text_.data() + end, exponent);
    if (error == std::errc::result_out_of_range || exponent >= kMostDigits) {
      SetFault(fmt::format("{} is beyond the range of numbers", text_.substr(first, end - first)),
               i);
    }
  }

  void SetFault(const std::string& fault, size_t i) {
    if (!fault_.empty()) return;
    const auto end = text_.begin() + static_cast<std::string_view::difference_type>(i);
    SetFault(fmt::format("{} (line {})", fault, 1 + std::count(text_.begin(), end, '\n')));
  }
  void SetFault(const std::string& fault) {
    if (fault_.empty()) fault_ = fault;
  }

  static constexpr std::string_view kDigits = "0123456789.";
  static constexpr int kMostDigits = 308;  // before the point, of a double

  const std::string_view text_;
  std::unordered_set<long> defined_, referenced_;
  std::string fault_;
};

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

bool RequireWholeStepFile(const std::filesystem::path& path) {
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
  const EntityScan scan(view);
  if (scan.fault().empty()) return IsUtf8(view);
  throw FileErrors(path.string(),
                   fmt::format("is damaged: {}; export or copy it again", scan.fault()));
}

std::string ComponentName(const std::string& component, const std::string& product) {
  static const std::regex made_up(R"(\s*|=>.*|NAUO\d*|\d+|id\d+)", std::regex::icase);
  return std::regex_match(component, made_up) && !product.empty() ? product : component;
}

void FinishAssembly(CadAssembly* assembly) {
  if (assembly->parts.empty()) {
    throw FileErrors(assembly->file, "holds no part with a surface; is the assembly empty?");
  }
  for (CadPart& part : assembly->parts) part.name = CleanName(part.name, "part");
  for (CadGroup& group : assembly->groups) group.name = CleanName(group.name, "group");
  for (CadFrame& frame : assembly->frames) frame.name = CleanName(frame.name, "frame");
  MakeUnique(&assembly->parts, "part", &assembly->remarks);
  MakeUnique(&assembly->groups, "subassembly", &assembly->remarks);
  RemarkOnUnits(assembly);
}

}  // namespace vmech
