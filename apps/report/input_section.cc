#include "vmech/apps/report/input_section.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "vmech/apps/html/page.h"
#include "vmech/apps/plot/scale.h"
#include "vmech/apps/report/certainty_words.h"
#include "vmech/mechanisms/freedoms.h"

namespace vmech {
namespace {

using html::Markup;

constexpr double kDegreesPerRadian = 180 / std::numbers::pi;

std::string Number(double value, int digits = 6) {
  return plot::FormatShort(value == 0 ? 0 : value, digits);
}

/// "1, −2, 0" in a unit.
std::string Triple(const Vector3d& v, double unit = 1) {
  return fmt::format("{}, {}, {}", Number(unit * v.x()), Number(unit * v.y()),
                     Number(unit * v.z()));
}

std::string AnchorName(const Mechanism& mechanism, AnchorId id) {
  return mechanism.links[id.link].name + "/" + mechanism.anchor(id).name;
}

Markup FileTable(const StudyFile& file) {
  if (file.inputs.empty()) return {};
  html::Table table;
  table.columns = {{"File"}, {"SHA-256"}};
  for (const InputFile& input : file.inputs) {
    table.rows.push_back({input.path.filename().string(), html::Element("code", input.sha256)});
  }
  return html::RenderTable(table);
}

Markup ParameterTableOf(const StudyFile& file) {
  if (file.parameters.empty()) return {};
  html::Table table;
  table.columns = {{"Parameter"}, {"Value"}};
  for (const StatedParameter& parameter : file.parameters) {
    const std::string unit = parameter.unit.empty() ? "" : " " + parameter.unit;
    table.rows.push_back({parameter.name, Number(parameter.figure, 12) + unit});
  }
  return html::RenderTable(table);
}

std::string ChoicesInWords(const StudyFile& file, std::string_view version, std::string_view date) {
  const LoadStudy& study = file.study;
  std::string words = fmt::format("Computed by vmech {}", version);
  if (!date.empty()) words += fmt::format(" on {} (UTC)", date);
  words += fmt::format(". Rule for what statics does not determine: {}", NameOf(study.rule));
  if (study.norm_length > 0) {
    words += fmt::format(", moments divided by {} mm", Number(1e3 * study.norm_length));
  }
  words += fmt::format(
      ". Rounded figures may keep loops open by {} of the mechanism's length. Where a joint leaves "
      "its limits, {}.",
      Number(study.mechanism.tolerance, 3),
      study.stop_at_limits ? "the study ends" : "a warning is given");
  return words;
}

Markup LinkTable(const Mechanism& mechanism) {
  html::Table table;
  table.caption =
      "Links: centre of gravity in the link's drawing frame, inertia about it in the same axes. "
      "The ground is " +
      mechanism.links[mechanism.ground].name + ".";
  table.columns = {{"Link"},
                   {"Mass [kg]", true},
                   {"Centre x, y, z [mm]", true},
                   {"Inertia xx, yy, zz [kg mm²]", true},
                   {"xy, xz, yz [kg mm²]", true}};
  for (const Link& link : mechanism.links) {
    const MassProperties& m = link.mass_properties;
    const Matrix3d& I = m.I_Lcm;
    table.rows.push_back({link.name, Number(m.mass), Triple(m.p_LoLcm, 1e3),
                          Triple(I.diagonal(), 1e6), Triple({I(0, 1), I(0, 2), I(1, 2)}, 1e6)});
  }
  return html::RenderTable(table);
}

Markup AnchorTable(const Mechanism& mechanism) {
  html::Table table;
  table.columns = {{"Anchor"}, {"Origin x, y, z [mm]", true}, {"z axis", true}, {"x axis", true}};
  for (const Link& link : mechanism.links) {
    for (const Anchor& anchor : link.anchors) {
      table.rows.push_back({link.name + "/" + anchor.name, Triple(anchor.X_LA.p, 1e3),
                            Triple(anchor.X_LA.R.col(2)), Triple(anchor.X_LA.R.col(0))});
    }
  }
  return html::Details("Anchors, at which joints are made, in the drawing frames of their links",
                       html::RenderTable(table));
}

/// What a freedom has beside being free: limits, spring, friction.
std::string FreedomInWords(const Joint& joint, size_t k) {
  const bool turns = FreedomsOfType(joint.type).rotates[k];
  const double unit = turns ? kDegreesPerRadian : 1e3;
  const std::string_view name = turns ? "°" : " mm";
  std::vector<std::string> words;
  if (std::isfinite(joint.lower[k]) || std::isfinite(joint.upper[k])) {
    words.push_back(fmt::format("limits {} to {}{}", Number(unit * joint.lower[k]),
                                Number(unit * joint.upper[k]), name));
  }
  const Passive& p = joint.passive[k];
  if (p.stiffness != 0) {
    words.push_back(fmt::format("spring {} {}, slack at {}{}", Number(p.stiffness),
                                turns ? "N m/rad" : "N/m", Number(unit * p.rest), name));
  }
  if (p.viscous != 0) {
    words.push_back(fmt::format("viscous {} {}", Number(p.viscous), turns ? "N m s/rad" : "N s/m"));
  }
  if (p.coulomb != 0) {
    words.push_back(fmt::format("dry friction {} {}", Number(p.coulomb), turns ? "N m" : "N"));
  }
  if (words.empty()) return "";
  const bool several = FreedomsOf(joint.type) > 1;
  return (several ? NameOfFreedom(joint.type, static_cast<int>(k)) + ": " : std::string()) +
         Enumerate(words);
}

std::string JointInWords(const Joint& joint) {
  std::vector<std::string> words;
  if (joint.type == JointType::kScrew) {
    words.push_back(
        fmt::format("pitch {} mm a turn", Number(2e3 * std::numbers::pi * joint.pitch)));
  }
  for (size_t k = 0; k < joint.passive.size(); ++k) {
    if (std::string freedom = FreedomInWords(joint, k); !freedom.empty()) words.push_back(freedom);
  }
  const LoadFriction& f = joint.load_friction;
  if (f.coefficient != 0) {
    std::string friction = fmt::format("friction coefficient {}", Number(f.coefficient));
    for (const auto& [name, length] :
         {std::pair("radius", f.radius), std::pair("thrust radius", f.thrust_radius),
          std::pair("length", f.length), std::pair("width", f.width)}) {
      if (length > 0) friction += fmt::format(", {} {} mm", name, Number(1e3 * length));
    }
    words.push_back(friction);
  }
  if (joint.stiffness) {
    words.push_back(fmt::format("stiffness {} N/m and {} N m/rad",
                                Triple(joint.stiffness->head<3>()),
                                Triple(joint.stiffness->tail<3>())));
  }
  return fmt::format("{}", fmt::join(words, "; "));
}

Markup JointTable(const Mechanism& mechanism) {
  html::Table table;
  table.columns = {{"Joint"}, {"Type"}, {"First anchor"}, {"Second anchor"}, {"With"}};
  for (const Joint& joint : mechanism.joints) {
    const std::string with = JointInWords(joint);
    table.rows.push_back({joint.name, NameOf(joint.type), AnchorName(mechanism, joint.first),
                          AnchorName(mechanism, joint.second), with.empty() ? "–" : with});
  }
  return html::RenderTable(table);
}

/// The wrench of a load, or the span of each component that a table has.
std::string WrenchInWords(const ExternalLoad& load) {
  constexpr const char* kNames[] = {"fx", "fy", "fz", "mx", "my", "mz"};
  std::vector<std::string> words;
  for (int k = 0; k < 6; ++k) {
    double least = load.wrenches.front().Stacked()[k], greatest = least;
    for (const Wrenchd& wrench : load.wrenches) {
      least = std::min(least, wrench.Stacked()[k]);
      greatest = std::max(greatest, wrench.Stacked()[k]);
    }
    if (least == 0 && greatest == 0) continue;
    const std::string span = least == greatest
                                 ? Number(least)
                                 : fmt::format("{} to {}", Number(least), Number(greatest));
    words.push_back(fmt::format("{} {} {}", kNames[k], span, k < 3 ? "N" : "N m"));
  }
  return words.empty() ? "nothing" : fmt::format("{}", fmt::join(words, ", "));
}

std::string CourseInWords(const ExternalLoad& load) {
  if (load.over == ExternalLoad::Over::kConstant) return "constant";
  const bool time = load.over == ExternalLoad::Over::kTime;
  return fmt::format("{} rows over {}{}", load.at.size(),
                     time ? "time" : "the coordinate of the first drive",
                     load.period > 0 ? ", repeating" : "");
}

Markup LoadTable(const LoadStudy& study) {
  if (study.external.empty()) return html::Paragraph("No load from outside but gravity.");
  html::Table table;
  table.caption = "Loads from outside";
  table.columns = {{"On link"}, {"At x, y, z [mm]", true}, {"Axes"}, {"Course"}, {"Wrench"}};
  for (const ExternalLoad& load : study.external) {
    table.rows.push_back({study.mechanism.links[load.link].name, Triple(load.p_L, 1e3),
                          load.axes == ExternalLoad::Axes::kWorld ? "world" : "link",
                          CourseInWords(load), WrenchInWords(load)});
  }
  return html::RenderTable(table);
}

std::string UpTo(double least, double greatest) {
  if (std::isfinite(greatest)) {
    return fmt::format("{} to {}", Number(1e3 * least), Number(1e3 * greatest));
  }
  return least > 0 ? fmt::format("{} or more", Number(1e3 * least)) : "any";
}

Markup BearingTable(const StudyFile& file) {
  if (file.bearings.empty()) return {};
  html::Table table;
  table.caption = "Bearings asked for: positions along the axis from the second anchor";
  table.columns = {{"Joint"},           {"Positions [mm]", true},  {"Locating [mm]", true},
                   {"Life [h]", true},  {"Reliability [%]", true}, {"C₀ / P₀", true},
                   {"Bore [mm]", true}, {"Outside [mm]", true},    {"Lubrication"}};
  for (const BearingRequest& request : file.bearings) {
    const BearingRequirements& asked = request.requirements;
    const Arrangement& arrangement = request.arrangement;
    std::vector<std::string> positions;
    for (const double at : arrangement.positions) positions.push_back(Number(1e3 * at));
    std::string life = Number(asked.life_hours);
    if (asked.pair_life_hours) life += ", both " + Number(*asked.pair_life_hours);
    table.rows.push_back({file.study.mechanism.joints[request.joint].name,
                          fmt::format("{}", fmt::join(positions, ", ")),
                          positions[arrangement.locating], life, Number(asked.reliability),
                          Number(asked.static_safety), UpTo(asked.shaft_min, asked.shaft_max),
                          UpTo(0, asked.housing_max),
                          asked.lubrication == Lubrication::kGrease ? "grease" : "oil"});
  }
  return html::RenderTable(table);
}

std::string MotionInWords(const StudyFile& file) {
  const LoadStudy& study = file.study;
  const Vector3d& g = study.mechanism.gravity_W;
  std::string words = g.isZero()
                          ? "No gravity."
                          : fmt::format("Gravity {} m/s² along the axes of the world.", Triple(g));
  if (!file.motion.empty()) words += fmt::format(" Motion: {}", file.motion);
  words += fmt::format("; {} poses", study.times.size());
  if (study.cycle > 0) words += fmt::format(", a cycle of {} s", Number(study.cycle));
  if (study.hand && !study.hand->stiffness.isZero()) {
    words += fmt::format("; the hand weighs errors by {} N/m and {} N m/rad",
                         Triple(study.hand->stiffness.head<3>()),
                         Triple(study.hand->stiffness.tail<3>()));
  }
  return words + ".";
}

}  // namespace

Markup InputSection(const StudyFile& file, std::string_view version, std::string_view date) {
  const Mechanism& mechanism = file.study.mechanism;
  Markup section = html::Heading(2, "What it was computed from");
  section += html::Paragraph(ChoicesInWords(file, version, date));
  section += FileTable(file);
  section += ParameterTableOf(file);
  section += html::Paragraph(MotionInWords(file));
  section += LinkTable(mechanism);
  section += JointTable(mechanism);
  section += AnchorTable(mechanism);
  section += LoadTable(file.study);
  return section + BearingTable(file);
}

}  // namespace vmech
