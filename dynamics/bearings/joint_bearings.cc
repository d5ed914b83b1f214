#include "vmech/dynamics/bearings/joint_bearings.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <numbers>

#include "vmech/dynamics/bearings/rating_life.h"

namespace vmech {
namespace {

/// Offset of the force from a single bearing [m] above which its tilting moment is worth a warning.
constexpr double kTiltingArm = 1e-6;

double Peak(const std::vector<BearingForce>& forces, double (BearingForce::*part)() const) {
  double peak = 0;
  for (const BearingForce& F : forces) peak = std::max(peak, (F.*part)());
  return peak;
}

double SystemLifeHours(const std::vector<BearingSelection>& selections) {
  std::vector<double> lives;
  double slope = WeibullSlope(BearingKind::kCylindricalRoller);
  for (const BearingSelection& selection : selections) {
    if (selection.chosen < 0) return 0;
    lives.push_back(selection.best()->rating->modified_life_hours);
    slope = std::min(slope, WeibullSlope(selection.best()->bearing.kind));
  }
  return SystemLife(lives, slope);
}

void WarnOfTilting(const DutyCycle& cycle, JointBearings* joint) {
  double peak_force = 0;
  for (const Wrenchd& wrench : cycle.wrench) {
    peak_force = std::max(peak_force, wrench.force.norm());
  }
  const std::vector<double>& moment = joint->loads.tilting_moment;
  joint->peak_tilting_moment = *std::max_element(moment.begin(), moment.end());
  if (joint->peak_tilting_moment > kTiltingArm * peak_force) {
    joint->warnings.push_back(
        fmt::format("a single bearing cannot take the tilting moment of up to {:.3g} N m: give two "
                    "positions, or "
                    "let another joint of the loop take it",
                    joint->peak_tilting_moment));
  }
}

void WarnOfSystemLife(const BearingRequirements& requirements, JointBearings* joint) {
  if (joint->complete() && joint->system_life_hours < requirements.life_hours) {
    joint->warnings.push_back(
        fmt::format("both bearings together reach {}, less than the {} that is asked of each",
                    FormatHours(joint->system_life_hours), FormatHours(requirements.life_hours)));
  }
}

std::string DescribeRotation(const RotationSummary& rotation) {
  const double rpm = rotation.mean_speed * 30 / std::numbers::pi;
  switch (rotation.rotation) {
    case Rotation::kStanding:
      return "does not turn";
    case Rotation::kTurning:
      return fmt::format("turns at {:.4g} rpm on average", rpm);
    case Rotation::kReversing:
      return fmt::format("turns and reverses, {:.4g} rpm on average", rpm);
    case Rotation::kOscillating:
      return fmt::format("oscillates by +-{:.3g} deg, as harmful as {:.4g} rpm",
                         rotation.amplitude * 180 / std::numbers::pi, rpm);
  }
  return "";
}

}  // namespace

bool JointBearings::complete() const {
  return !selections.empty() &&
         std::all_of(selections.begin(), selections.end(),
                     [](const BearingSelection& selection) { return selection.chosen >= 0; });
}

std::string JointBearings::BriefReport() const {
  std::string text;
  for (const BearingSelection& selection : selections) {
    text += (text.empty() ? "" : " | ") + selection.message;
  }
  if (complete() && selections.size() > 1) {
    text += fmt::format(" | system life {}", FormatHours(system_life_hours));
  }
  if (certainty == LoadCertainty::kDependsOnRule) text += " (depends on the chosen rule)";
  return text;
}

std::string JointBearings::FullReport() const {
  std::string text = BriefReport() + "\n";
  auto out = std::back_inserter(text);
  fmt::format_to(out, "The joint {}.\n", DescribeRotation(rotation));
  for (const std::string& warning : warnings) fmt::format_to(out, "Warning: {}.\n", warning);
  for (size_t k = 0; k < selections.size(); ++k) {
    const BearingSelection& selection = selections[k];
    fmt::format_to(out, "Position {}: radial load up to {:.4g} N, axial load up to {:.4g} N.\n", k,
                   Peak(loads.forces[k], &BearingForce::radial),
                   Peak(loads.forces[k], &BearingForce::axial));
    fmt::format_to(out, "  {}\n", selection.message);
    for (const std::string& warning : selection.warnings) {
      fmt::format_to(out, "  Warning: {}.\n", warning);
    }
    for (int i = 0; i < static_cast<int>(selection.candidates.size()); ++i) {
      if (i == selection.chosen) continue;
      fmt::format_to(out, "    {}: {}\n", selection.candidates[i].bearing.designation,
                     selection.ReasonAgainst(i));
    }
  }
  return text;
}

JointBearings SelectJointBearings(const DutyCycle& cycle, const Arrangement& arrangement,
                                  const BearingRequirements& requirements, LoadCertainty certainty,
                                  std::span<const Bearing> catalogue) {
  cycle.Validate();
  JointBearings joint;
  joint.certainty = certainty;
  joint.rotation = SummariseRotation(cycle);
  joint.loads = DistributeLoads(arrangement, cycle.wrench);
  for (const std::vector<BearingForce>& forces : joint.loads.forces) {
    joint.selections.push_back(SelectBearing(catalogue, forces, joint.rotation, requirements));
  }
  joint.system_life_hours = SystemLifeHours(joint.selections);
  WarnOfTilting(cycle, &joint);
  WarnOfSystemLife(requirements, &joint);
  return joint;
}

}  // namespace vmech
