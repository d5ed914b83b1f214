#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "vmech/mechanisms/cad/mechanism_from_cad.h"

namespace vmech {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;
constexpr double kRoundoff = 1e-9;  // [mm, kg mm^2, deg]: beside figures of four digits

double Clean(double value) {
  return std::abs(value) < kRoundoff ? 0 : value;
}

void AddBodies(const CadImport& import, std::string* text) {
  const Mechanism& mechanism = import.mechanism;
  *text += fmt::format("\n{} bodies\n", import.bodies.size());
  for (const ImportedBody& body : import.bodies) {
    const Link& link = mechanism.links[body.link];
    const MassProperties& mass = link.mass_properties;
    const bool is_ground = body.link == mechanism.ground;
    *text += fmt::format(
        "  {}{}: {:.6g} kg, centre of gravity [{:.4g}, {:.4g}, {:.4g}] mm, inertia [{:.4g}, "
        "{:.4g}, "
        "{:.4g}] kg mm^2\n",
        link.name, is_ground ? " (ground)" : "", mass.mass, Clean(1e3 * mass.p_LoLcm.x()),
        Clean(1e3 * mass.p_LoLcm.y()), Clean(1e3 * mass.p_LoLcm.z()), 1e6 * mass.I_Lcm(0, 0),
        1e6 * mass.I_Lcm(1, 1), 1e6 * mass.I_Lcm(2, 2));
    for (const BodyMass::Part& part : body.mass.parts) {
      *text += fmt::format("    part {}: {:.6g} mm^3 at {:g} kg/m^3, {}\n", part.name,
                           1e9 * part.volume, part.density, part.source);
    }
  }
}

std::string SeatText(const JointSeat& seat) {
  if (seat.shaft_diameter == 0) return {};
  std::string text = fmt::format(", shaft {:.6g} mm", 1e3 * seat.shaft_diameter);
  if (seat.bore_diameter > seat.shaft_diameter + kDrawn) {
    text += fmt::format(" in a bore of {:.6g} mm", 1e3 * seat.bore_diameter);
  }
  if (std::abs(seat.nominal_diameter - seat.shaft_diameter) > kDrawn) {
    text += fmt::format(", nominal {:.6g} mm", 1e3 * seat.nominal_diameter);
  }
  if (seat.housing_diameter > 0) {
    text += fmt::format(" in a housing of {:.6g} mm", 1e3 * seat.housing_diameter);
  }
  return text;
}

void AddJoints(const CadImport& import, std::string* text) {
  const Mechanism& mechanism = import.mechanism;
  *text += fmt::format("\n{} joints\n", import.joints.size());
  for (const ImportedJoint& imported : import.joints) {
    const Joint& joint = mechanism.joints[imported.joint];
    *text += fmt::format("  {}: {}{}, {} - {}; anchors {:.4g} mm and {:.3g} deg apart{}{}\n",
                         joint.name, NameOf(joint.type), imported.type_assumed ? " (assumed)" : "",
                         mechanism.links[joint.first.link].name,
                         mechanism.links[joint.second.link].name, Clean(1e3 * imported.distance),
                         Clean(kDegrees * imported.angle), SeatText(imported.seat),
                         imported.from_geometry ? ", by its geometry: " + imported.why : "");
  }
}

void AddMerges(const CadImport& import, std::string* text) {
  if (import.merges.empty()) return;
  *text += "\nNo links of their own\n";
  for (const BodyMerge& merge : import.merges) {
    *text += fmt::format("  {} belongs to {}, {}{}\n", merge.body, merge.into, merge.why,
                         merge.is_guess ? fmt::format(" (--moving {})", merge.body) : "");
  }
}

void AddNearMisses(const CadImport& import, std::string* text) {
  if (import.near_misses.empty()) return;
  *text += "\nNo fits by a little (--tolerance)\n";
  for (const NearMiss& miss : import.near_misses) {
    *text += fmt::format("  {} - {}, {}\n", miss.first_body, miss.second_body, miss.what);
  }
}

void AddUnmatched(const CadImport& import, std::string* text) {
  for (const UnmatchedAnchor& anchor : import.unmatched) {
    *text += fmt::format("  {} of {} has no partner", anchor.frame, anchor.body);
    if (!anchor.nearest_frame.empty()) {
      *text +=
          fmt::format("; nearest: {} of {}, {:.4g} mm and {:.3g} deg away", anchor.nearest_frame,
                      anchor.nearest_body, 1e3 * anchor.distance, kDegrees * anchor.angle);
    }
    *text += "\n";
  }
  for (const JointHint& hint : import.hints) {
    *text += fmt::format("  not taken: {} - {}, {} by its geometry ({})\n", hint.first_body,
                         hint.second_body, NameOf(hint.joint.type), hint.joint.why);
  }
}

void AddLines(const char* heading, const std::vector<std::string>& lines, std::string* text) {
  if (lines.empty()) return;
  *text += fmt::format("\n{}\n", heading);
  for (const std::string& line : lines) *text += fmt::format("  {}\n", line);
}

}  // namespace

std::string CadImport::FullReport() const {
  std::string text = fmt::format("{}: {}, unit of length {}\n", mechanism.name, file,
                                 unit.empty() ? "not given" : unit);
  AddBodies(*this, &text);
  AddMerges(*this, &text);
  AddJoints(*this, &text);
  AddUnmatched(*this, &text);
  AddNearMisses(*this, &text);
  if (!mechanism.grasps.empty()) {
    text += fmt::format("\n{} grasp{}\n", mechanism.grasps.size(),
                        mechanism.grasps.size() > 1 ? "s" : "");
    for (const Grasp& grasp : mechanism.grasps) {
      text += fmt::format("  {}: {}, {}\n", grasp.name, mechanism.links[grasp.link].name,
                          grasp.kind == GraspKind::kPoint ? "point" : "rigid");
    }
  }
  AddLines("Guessed", guesses, &text);
  AddLines("Remarks", remarks, &text);
  return text;
}

}  // namespace vmech
