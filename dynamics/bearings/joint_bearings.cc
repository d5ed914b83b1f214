#include "vmech/dynamics/bearings/joint_bearings.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <numbers>
#include <tuple>

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

double LifeOfAll(const std::vector<const Candidate*>& bearings) {
  std::vector<double> lives;
  std::vector<BearingKind> kinds;
  for (const Candidate* candidate : bearings) {
    lives.push_back(candidate->rating->modified_life_hours);
    kinds.push_back(candidate->bearing.kind);
  }
  return SystemLife(lives, WeibullSlope(kinds));
}

double SystemLifeHours(const JointBearings& joint) {
  if (!joint.complete()) return 0;
  std::vector<const Candidate*> chosen;
  for (const BearingSelection& selection : joint.selections) chosen.push_back(selection.best());
  return LifeOfAll(chosen);
}

/// Two bearings that fit, by their places in the two selections.
struct Pair {
  int first, second;
  double life;                     ///< of both together [h]
  double outer_diameters, widths;  ///< sums [m]

  bool IsSmallerThan(const Pair& other) const {
    return std::tie(outer_diameters, widths, first, second) <
           std::tie(other.outer_diameters, other.widths, other.first, other.second);
  }
};

std::vector<Pair> FittingPairs(const std::vector<BearingSelection>& selections) {
  std::vector<Pair> pairs;
  const std::vector<Candidate>&a = selections[0].candidates, &b = selections[1].candidates;
  for (size_t i = 0; i < a.size(); ++i) {
    for (size_t j = 0; j < b.size(); ++j) {
      if (!a[i].fits() || !b[j].fits()) continue;
      pairs.push_back({static_cast<int>(i), static_cast<int>(j), LifeOfAll({&a[i], &b[j]}),
                       a[i].bearing.outer_diameter + b[j].bearing.outer_diameter,
                       a[i].bearing.width + b[j].bearing.width});
    }
  }
  return pairs;
}

/// The smallest pair that lives long enough; if there is none, the one that lives longest.
Pair ChoosePair(const std::vector<Pair>& pairs, double asked) {
  return *std::min_element(pairs.begin(), pairs.end(), [asked](const Pair& a, const Pair& b) {
    const double life_a = std::min(a.life, asked), life_b = std::min(b.life, asked);
    return life_a != life_b ? life_a > life_b : a.IsSmallerThan(b);
  });
}

/// Two bearings of which each is long-lived enough are not, together.
void SettlePair(const BearingRequirements& requirements, JointBearings* joint) {
  joint->system_life_hours = SystemLifeHours(*joint);
  if (joint->selections.size() < 2) return;
  joint->asked_system_life = requirements.LifeOfPair();
  if (!joint->complete() || joint->met()) return;
  const Pair pair = ChoosePair(FittingPairs(joint->selections), joint->asked_system_life);
  joint->selections[0].Choose(pair.first, joint->rotation, requirements);
  joint->selections[1].Choose(pair.second, joint->rotation, requirements);
  joint->system_life_hours = pair.life;
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

void WarnOfSystemLife(JointBearings* joint) {
  if (!joint->complete() || joint->met()) return;
  joint->warnings.push_back(fmt::format(
      "both bearings together reach {} of the {} asked of them, and no pair of the catalogue that "
      "has room lives longer; give more room, or ask less of the pair (pair_life_hours)",
      FormatHours(joint->system_life_hours), FormatHours(joint->asked_system_life)));
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
    text += fmt::format(" | system life {}{}", FormatHours(system_life_hours),
                        met() ? "" : " of " + FormatHours(asked_system_life));
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
  SettlePair(requirements, &joint);
  WarnOfTilting(cycle, &joint);
  WarnOfSystemLife(&joint);
  return joint;
}

}  // namespace vmech
