#include "vmech/mechanisms/cad/step/frame_name.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "vmech/mechanisms/files/document.h"

namespace vmech {
namespace {

using Role = FrameName::Role;

struct Prefix {
  std::string_view text;
  Role role;
};
constexpr std::array<Prefix, 6> kPrefixes{{{"anchor_", Role::kJoint},
                                           {"dof_", Role::kJoint},
                                           {"closing_", Role::kJoint},
                                           {"fix_", Role::kJoint},
                                           {"frame_", Role::kAnchor},
                                           {"grasp_", Role::kGrasp}}};

std::string Lower(std::string_view text) {
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return lower;
}

/// Takes off the number that FreeCAD puts behind a name that comes twice, where only a suffix can
/// stand before it: "guide__prismatic001".
void TakeNumber(std::string* name) {
  constexpr size_t kDigits = 3;
  if (name->size() <= kDigits) return;
  const auto digits = name->end() - kDigits;
  if (!std::all_of(digits, name->end(), [](unsigned char c) { return std::isdigit(c); })) return;
  const std::string rest = Lower(name->substr(0, name->size() - kDigits));
  if (rest.ends_with("_inv") || rest.find("__") != std::string::npos) name->resize(rest.size());
}

bool TakeSuffix(std::string* name, std::string_view suffix) {
  if (name->size() <= suffix.size() || !Lower(*name).ends_with(suffix)) return false;
  name->resize(name->size() - suffix.size());
  return true;
}

/// The word behind the last "__", taken off.
std::string TakeType(std::string* name) {
  const size_t at = name->rfind("__");
  if (at == std::string::npos || at == 0) return {};
  const std::string word = Lower(name->substr(at + 2));
  name->resize(at);
  return word;
}

void SetType(const std::string& word, FrameName* frame) {
  if (word.empty()) return;
  if (frame->role == Role::kGrasp) {
    if (word == "point") {
      frame->grasp = GraspKind::kPoint;
    } else if (word != "rigid") {
      frame->error = fmt::format("{} is no kind of grasp; rigid and point are", Quoted(word));
    }
    return;
  }
  frame->type = JointTypeFromWord(word);
  if (!frame->type) {
    frame->error = fmt::format(
        "{} is no type of joint that a frame can have; revolute, prismatic, cylindrical, "
        "universal, spherical, planar and weld are",
        Quoted(word));
  }
}

}  // namespace

std::optional<JointType> JointTypeFromWord(std::string_view word) {
  if (word == "ball") return JointType::kSpherical;
  if (word == "fixed") return JointType::kWeld;
  for (const JointType type :
       {JointType::kRevolute, JointType::kPrismatic, JointType::kCylindrical, JointType::kUniversal,
        JointType::kSpherical, JointType::kPlanar, JointType::kWeld}) {
    if (word == NameOf(type)) return type;
  }
  return std::nullopt;
}

FrameName ParseFrameName(std::string_view name) {
  FrameName frame;
  const std::string lower = Lower(name);
  const auto prefix = std::find_if(kPrefixes.begin(), kPrefixes.end(), [&](const Prefix& p) {
    return lower.starts_with(p.text) && lower.size() > p.text.size();
  });
  if (prefix == kPrefixes.end()) return frame;
  frame.role = prefix->role;
  frame.name = name.substr(prefix->text.size());
  TakeNumber(&frame.name);
  frame.inverted = TakeSuffix(&frame.name, "_inv");
  const std::string word = TakeType(&frame.name);
  frame.inverted = TakeSuffix(&frame.name, "_inv") || frame.inverted;
  SetType(word, &frame);
  frame.prefer_cut = prefix->text == "closing_";
  if (prefix->text == "fix_" && !frame.type) frame.type = JointType::kWeld;
  return frame;
}

}  // namespace vmech
