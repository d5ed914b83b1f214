#include "vmech/dynamics/bearings/selection.h"

#include <fmt/format.h>

#include <algorithm>

#include "vmech/dynamics/bearings/rating_life.h"

namespace vmech {
namespace {

std::string Join(const std::vector<Shortfall>& shortfalls) {
  std::string text;
  for (const Shortfall& shortfall : shortfalls) {
    text += (text.empty() ? "" : "; ") + shortfall.text;
  }
  return text;
}

/// The least ratio of what there is to what is asked.
double WorstRatio(const Candidate& candidate) {
  double worst = 1;
  for (const Shortfall& shortfall : candidate.shortfalls) worst = std::min(worst, shortfall.ratio);
  return worst;
}

int FindClosest(const std::vector<Candidate>& candidates) {
  const auto closest = std::max_element(candidates.begin(), candidates.end(),
                                        [](const Candidate& a, const Candidate& b) {
                                          return std::pair(a.rating.has_value(), WorstRatio(a)) <
                                                 std::pair(b.rating.has_value(), WorstRatio(b));
                                        });
  return closest == candidates.end() ? -1 : static_cast<int>(closest - candidates.begin());
}

Candidate Examine(const Bearing& bearing, std::span<const BearingForce> forces,
                  const RotationSummary& rotation, const BearingRequirements& requirements) {
  Candidate candidate{bearing, std::nullopt, DimensionShortfalls(bearing, requirements)};
  if (!candidate.fits()) return candidate;
  candidate.rating = RateBearing(bearing, forces, rotation, requirements.reliability);
  candidate.shortfalls = LoadShortfalls(bearing, *candidate.rating, rotation, requirements);
  return candidate;
}

std::string DescribeChoice(const Candidate& choice) {
  return fmt::format("{}: life {}, static safety {:.3g}", choice.bearing.designation,
                     FormatHours(choice.rating->modified_life_hours), choice.rating->static_safety);
}

std::string DescribeFailure(const Candidate& closest, const RotationSummary& rotation,
                            const BearingRequirements& requirements) {
  std::string text = fmt::format("no bearing of the catalogue fits; {} comes closest: {}",
                                 closest.bearing.designation, Join(closest.shortfalls));
  const auto short_of_life = [](const Shortfall& s) { return s.criterion == Criterion::kLife; };
  if (std::any_of(closest.shortfalls.begin(), closest.shortfalls.end(), short_of_life)) {
    const double life = requirements.life_hours / ReliabilityFactor(requirements.reliability) /
                        HoursOf(1, rotation.mean_speed);
    text += fmt::format(
        " (a rating C of {:.3g} kN would do)",
        RequiredDynamicRating(closest.rating->mean_load, life, closest.bearing.kind) / 1e3);
  }
  return text;
}

}  // namespace

const Candidate* BearingSelection::best() const {
  const int index = chosen >= 0 ? chosen : closest;
  return index >= 0 ? &candidates[index] : nullptr;
}

std::string BearingSelection::ReasonAgainst(int candidate) const {
  if (!candidates[candidate].fits()) return Join(candidates[candidate].shortfalls);
  if (candidate == chosen) return "";
  if (candidate < chosen) return "fits, but not in the smallest pair that lives long enough";
  return "fits, but is larger than " + candidates[chosen].bearing.designation;
}

void BearingSelection::Choose(int candidate, const RotationSummary& rotation,
                              const BearingRequirements& requirements) {
  const Candidate& choice = candidates[candidate];
  chosen = candidate;
  message = DescribeChoice(choice);
  warnings = RatingWarnings(choice.bearing, *choice.rating, rotation, requirements);
}

BearingSelection SelectBearing(std::span<const Bearing> catalogue,
                               std::span<const BearingForce> forces,
                               const RotationSummary& rotation,
                               const BearingRequirements& requirements) {
  requirements.Validate();
  BearingSelection selection;
  std::vector<Candidate>& candidates = selection.candidates;
  for (const Bearing& bearing : catalogue) {
    candidates.push_back(Examine(bearing, forces, rotation, requirements));
  }
  std::sort(candidates.begin(), candidates.end(),
            [](const Candidate& a, const Candidate& b) { return IsSmaller(a.bearing, b.bearing); });
  const auto smallest = std::find_if(candidates.begin(), candidates.end(),
                                     [](const Candidate& c) { return c.fits(); });
  if (smallest != candidates.end()) {
    selection.Choose(static_cast<int>(smallest - candidates.begin()), rotation, requirements);
    return selection;
  }
  selection.closest = FindClosest(candidates);
  selection.message = candidates.empty()
                          ? "the catalogue is empty"
                          : DescribeFailure(*selection.best(), rotation, requirements);
  return selection;
}

}  // namespace vmech
