#include "vmech/apps/import/study_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "vmech/mechanisms/files/document.h"
#include "vmech/mechanisms/files/flow_map.h"

namespace vmech {
namespace {

/// Millimetres to a nanometre: 20 mm as drawn are 20 in the file.
std::string Millimetres(double metres) {
  return YamlNumber(std::round(1e9 * metres) / 1e6 + 0.0);
}

std::string FirstThatTurns(const Mechanism& mechanism) {
  for (const bool at_ground : {true, false}) {
    for (const Joint& joint : mechanism.joints) {
      if (joint.type == JointType::kRevolute &&
          (!at_ground || joint.first.link == mechanism.ground)) {
        return joint.name;
      }
    }
  }
  throw std::invalid_argument("there is no revolute joint to drive; name a joint (--drive)");
}

std::string MotionText(const Mechanism& mechanism, std::vector<std::string> drives, double rpm,
                       std::vector<std::string>* guesses) {
  if (drives.empty()) {
    drives = {FirstThatTurns(mechanism)};
    guesses->push_back(
        fmt::format("joint {} is driven at {:g} rpm (--drive, --rpm)", Quoted(drives[0]), rpm));
  }
  std::vector<std::string> names;
  for (const Joint& joint : mechanism.joints) names.push_back(joint.name);
  std::string text = drives.size() == 1 ? "motion: " : "motion:\n";
  for (size_t i = 0; i < drives.size(); ++i) {
    const int joint = FindJoint(mechanism, drives[i]);
    if (joint < 0) {
      throw std::invalid_argument(fmt::format("there is no joint {} to drive (--drive){}",
                                              Quoted(drives[i]), DidYouMean(drives[i], names)));
    }
    if (mechanism.joints[joint].type != JointType::kRevolute) {
      throw std::invalid_argument(fmt::format("joint {} is {}; only a revolute one turns at rpm",
                                              Quoted(drives[i]),
                                              NameOf(mechanism.joints[joint].type)));
    }
    text += fmt::format("{}{{joint: \"{}\", rpm: {}{}}}\n", drives.size() == 1 ? "" : "  - ",
                        drives[i], YamlNumber(rpm), i == 0 ? ", turns: 1, steps: 360" : "");
  }
  return text;
}

std::string BearingText(const Joint& joint, const JointSeat& seat) {
  std::vector<std::string> positions;
  for (const double z : seat.positions) positions.push_back(Millimetres(z));
  if (positions.empty()) positions = {"0"};
  const std::string shaft = Millimetres(seat.nominal_diameter);
  std::string text = fmt::format("  \"{}\": {{positions: [{}], locating: 0, shaft: [{}, {}]",
                                 joint.name, fmt::join(positions, ", "), shaft, shaft);
  if (seat.housing_diameter > 0) text += ", housing: " + Millimetres(seat.housing_diameter);
  return text + "}\n";
}

}  // namespace

std::string StudyText(const CadImport& import, const std::vector<std::string>& drives, double rpm,
                      std::vector<std::string>* guesses) {
  std::string text = "units: {length: mm, angle: deg}\n";
  text += MotionText(import.mechanism, drives, rpm, guesses);
  std::string bearings;
  for (const ImportedJoint& imported : import.joints) {
    if (imported.seat.shaft_diameter == 0) continue;
    bearings += BearingText(import.mechanism.joints[imported.joint], imported.seat);
  }
  if (!bearings.empty()) text += "bearings:\n" + bearings;
  return text;
}

}  // namespace vmech
