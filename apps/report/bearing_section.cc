#include "vmech/apps/report/bearing_section.h"

#include <fmt/format.h>

#include <cmath>

#include "vmech/apps/html/page.h"
#include "vmech/apps/plot/scale.h"

namespace vmech {
namespace {

using html::Markup;

std::string Number(double value, int digits = 3) {
  return std::isinf(value) ? "unlimited" : plot::FormatSignificant(value, digits);
}

std::string Millimetres(double length) {
  return plot::FormatShort(length * 1e3, 3);
}

std::string RequirementsInWords(const BearingRequirements& r) {
  std::string words = fmt::format("Asked for: {} at {} % reliability, static safety of at least {}",
                                  FormatHours(r.life_hours), plot::FormatShort(r.reliability, 3),
                                  plot::FormatShort(r.static_safety, 2));
  if (std::isfinite(r.shaft_max)) {
    words += fmt::format(", bore {} to {} mm", Millimetres(r.shaft_min), Millimetres(r.shaft_max));
  } else if (r.shaft_min > 0) {
    words += fmt::format(", bore of at least {} mm", Millimetres(r.shaft_min));
  }
  if (std::isfinite(r.housing_max)) {
    words += fmt::format(", outer diameter of at most {} mm", Millimetres(r.housing_max));
  }
  if (r.pair_life_hours) {
    words += fmt::format(", {} of both together", FormatHours(*r.pair_life_hours));
  }
  return words +
         fmt::format(", {} lubrication.", r.lubrication == Lubrication::kGrease ? "grease" : "oil");
}

std::string_view RotationInWords(Rotation rotation) {
  switch (rotation) {
    case Rotation::kStanding:
      return "The joint stands still: static safety alone decides.";
    case Rotation::kTurning:
      return "The joint turns in one direction.";
    case Rotation::kReversing:
      return "The joint turns in both directions.";
    case Rotation::kOscillating:
      return "The joint oscillates; the life counts the path that the rolling elements cover.";
  }
  return "";
}

std::vector<Markup> PositionRow(const Arrangement& arrangement, const BearingSelection& selection,
                                size_t position) {
  const bool locating = static_cast<size_t>(arrangement.locating) == position;
  std::vector<Markup> row = {
      fmt::format("{} mm", plot::FormatShort(arrangement.positions[position] * 1e3, 3)),
      locating ? "locating" : "floating"};
  const Candidate* best = selection.best();
  if (!best || !best->rating) {
    row.push_back(html::Badge("none fits", html::Tone::kBad));
    row.resize(9, "–");
    return row;
  }
  const Bearing& bearing = best->bearing;
  const BearingRating& rating = *best->rating;
  row.push_back(selection.chosen >= 0
                    ? html::Element("strong", bearing.designation)
                    : Markup(bearing.designation) + " " + html::Badge("closest", html::Tone::kBad));
  row.emplace_back(fmt::format("{} × {} × {}", Millimetres(bearing.bore),
                               Millimetres(bearing.outer_diameter), Millimetres(bearing.width)));
  row.emplace_back(fmt::format("{} / {}", Number(bearing.dynamic_rating * 1e-3),
                               Number(bearing.static_rating * 1e-3)));
  row.emplace_back(Number(rating.mean_load));
  row.emplace_back(Number(rating.peak_load));
  row.emplace_back(FormatHours(rating.modified_life_hours));
  row.emplace_back(Number(rating.static_safety));
  return row;
}

Markup ChoiceTable(const Arrangement& arrangement, const JointBearings& bearings) {
  html::Table table;
  table.columns = {{"Position", true},    {"Role"},
                   {"Bearing"},           {"d × D × B [mm]", true},
                   {"C / C₀ [kN]", true}, {"Mean load [N]", true},
                   {"Peak P [N]", true},  {"Life", true},
                   {"C₀ / P₀", true}};
  for (size_t i = 0; i < bearings.selections.size(); ++i) {
    table.rows.push_back(PositionRow(arrangement, bearings.selections[i], i));
  }
  return html::RenderTable(table);
}

/// The reasons against all candidates but the chosen one.
Markup PassedOver(const BearingSelection& selection) {
  html::Table table;
  table.columns = {{"Bearing"}, {"d × D × B [mm]", true}, {"Passed over because"}};
  for (size_t i = 0; i < selection.candidates.size(); ++i) {
    if (static_cast<int>(i) == selection.chosen) continue;
    const Bearing& bearing = selection.candidates[i].bearing;
    table.rows.push_back(
        {bearing.designation,
         fmt::format("{} × {} × {}", Millimetres(bearing.bore), Millimetres(bearing.outer_diameter),
                     Millimetres(bearing.width)),
         selection.ReasonAgainst(static_cast<int>(i))});
  }
  return html::RenderTable(table);
}

/// The outcome, and why the next smaller bearing that has room would not do.
Markup ReasonInWords(const BearingSelection& selection) {
  Markup words = selection.message + ".";
  for (int i = selection.chosen - 1; i >= 0; --i) {
    const Candidate& smaller = selection.candidates[static_cast<size_t>(i)];
    if (!smaller.rating) continue;
    return words + fmt::format(" The next smaller with room, {}, was passed over: {}.",
                               smaller.bearing.designation, selection.ReasonAgainst(i));
  }
  if (selection.chosen >= 0) words += " No smaller bearing of the catalogue has room.";
  return words;
}

Markup Warnings(const JointBearings& bearings) {
  std::vector<Markup> warnings(bearings.warnings.begin(), bearings.warnings.end());
  for (const BearingSelection& selection : bearings.selections) {
    warnings.insert(warnings.end(), selection.warnings.begin(), selection.warnings.end());
  }
  return warnings.empty() ? Markup()
                          : html::Notice(html::ListOrParagraph(warnings), html::Tone::kWarning);
}

Markup JointSection(const LoadStudy& study, const BearingRequest& request,
                    const JointBearings& bearings) {
  Markup section =
      html::Heading(3, study.mechanism.joints[static_cast<size_t>(request.joint)].name);
  section += html::Paragraph(std::string(RotationInWords(bearings.rotation.rotation)) + " " +
                             RequirementsInWords(request.requirements));
  section += ChoiceTable(request.arrangement, bearings);
  std::vector<Markup> reasons;
  for (const BearingSelection& selection : bearings.selections) {
    reasons.push_back(ReasonInWords(selection));
  }
  section += html::ListOrParagraph(reasons);
  if (bearings.complete() && bearings.selections.size() > 1) {
    const std::string life = fmt::format("Both together: {} of {} at the same reliability.",
                                         FormatHours(bearings.system_life_hours),
                                         FormatHours(bearings.asked_system_life));
    section += bearings.met() ? html::Paragraph(life)
                              : html::Notice(life + " That is too short.", html::Tone::kBad);
  }
  if (bearings.certainty == LoadCertainty::kDependsOnRule) {
    section += html::Notice(Markup("Statics does not determine all of this joint's load. The lives "
                                   "hold for the rule ") +
                                html::Element("code", NameOf(study.rule)) + ".",
                            html::Tone::kWarning);
  }
  section += Warnings(bearings);
  for (size_t i = 0; i < bearings.selections.size(); ++i) {
    section += html::ScreenDetails(
        fmt::format("Why not another bearing at {} mm",
                    plot::FormatShort(request.arrangement.positions[i] * 1e3, 3)),
        PassedOver(bearings.selections[i]));
  }
  return section;
}

}  // namespace

std::string ChosenBearings(const JointBearings& bearings) {
  std::vector<std::string> names;
  for (const BearingSelection& selection : bearings.selections) {
    const int chosen = selection.chosen;
    names.push_back(chosen < 0
                        ? "none fits"
                        : selection.candidates[static_cast<size_t>(chosen)].bearing.designation);
  }
  if (names.size() == 2 && names[0] == names[1]) {
    return names[0] == "none fits" ? names[0] : "2 × " + names[0];
  }
  return fmt::format("{}", fmt::join(names, " + "));
}

Markup BearingSections(const StudyFile& file, const StudyOutcome& outcome) {
  if (file.bearings.empty()) return {};
  Markup sections = html::Heading(2, "Bearings");
  sections += html::Paragraph(
      "The smallest bearing of the catalogue that has room, life, static "
      "safety and speed. Life follows ISO 281 with the mean effective load over the cycle, "
      "static safety ISO 76; lubrication and cleanliness are not rated.");
  for (size_t i = 0; i < file.bearings.size(); ++i) {
    sections += JointSection(file.study, file.bearings[i], outcome.bearings[i].bearings);
  }
  return sections;
}

}  // namespace vmech
