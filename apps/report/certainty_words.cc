#include "vmech/apps/report/certainty_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "vmech/apps/html/page.h"
#include "vmech/apps/plot/scale.h"
#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/open_components.h"

namespace vmech {
namespace {

using html::Markup;

bool HasAxis(JointType type) {
  return type == JointType::kRevolute || type == JointType::kCylindrical ||
         type == JointType::kScrew;
}

/// Words for a pair of components across the axis and for the one along it.
struct Words {
  std::string_view x, y, both, z;
};

Words ForceWords(JointType type) {
  if (HasAxis(type)) {
    return {"the radial force along x", "the radial force along y", "the radial force",
            "the axial force"};
  }
  return {"the force along x", "the force along y", "the forces along x and y",
          "the force along z"};
}

Words MomentWords(JointType type) {
  if (HasAxis(type)) {
    return {"the tilting moment about x", "the tilting moment about y", "the two tilting moments",
            "the moment about the axis"};
  }
  return {"the moment about x", "the moment about y", "the moments about x and y",
          "the moment about z"};
}

void AddWords(const Words& words, bool x, bool y, bool z, std::vector<std::string>* items) {
  if (x && y) {
    items->emplace_back(words.both);
  } else if (x || y) {
    items->emplace_back(x ? words.x : words.y);
  }
  if (z) items->emplace_back(words.z);
}

bool Any(const JointCertainty& certainty, Certainty verdict) {
  return std::find(certainty.begin(), certainty.end(), verdict) != certainty.end();
}

/// Joints whose sentences are the same but for the name.
struct Group {
  JointType type;
  JointCertainty certainty, loaded;  ///< all verdicts, and those that matter
  std::vector<std::string> names;
};

std::vector<Group> GroupJoints(const LoadStudy& study, const LoadStudyResult& result) {
  std::vector<Group> groups;
  for (size_t i = 0; i < result.certainty.size(); ++i) {
    const Joint& joint = study.mechanism.joints[i];
    const JointCertainty loaded = VerdictsThatMatter(result, i);
    const auto same = std::find_if(groups.begin(), groups.end(), [&](const Group& group) {
      return group.certainty == result.certainty[i] && group.loaded == loaded &&
             HasAxis(group.type) == HasAxis(joint.type);
    });
    if (same != groups.end()) {
      same->names.push_back(joint.name);
    } else {
      groups.push_back({joint.type, result.certainty[i], loaded, {joint.name}});
    }
  }
  return groups;
}

/// Components that statics leaves open and that no load of the study reaches.
std::string UnloadedInWords(const Group& group) {
  JointCertainty unloaded = group.certainty;
  for (size_t k = 0; k < unloaded.size(); ++k) {
    if (group.loaded[k] == group.certainty[k]) unloaded[k] = Certainty::kCertain;
  }
  return ComponentsInWords(group.type, unloaded, Certainty::kNotDetermined);
}

Markup GroupInWords(const Group& group, ReactionRule rule) {
  Markup words = html::Element("strong", Enumerate(group.names)) + ": ";
  const std::string open = ComponentsInWords(group.type, group.loaded, Certainty::kNotDetermined);
  const std::string singular = ComponentsInWords(group.type, group.certainty, Certainty::kSingular);
  const std::string unloaded = UnloadedInWords(group);
  if (open.empty() && singular.empty() && unloaded.empty()) {
    return words + "every component is certain.";
  }
  if (!open.empty()) {
    words += open + " cannot be known from statics; the figures shown follow the rule ";
    words += html::Element("code", NameOf(rule)) + ". ";
  }
  if (!unloaded.empty()) {
    words += unloaded +
             ": left open by statics, but no load of this study acts there, and by every "
             "rule the figure is zero; what misalignment or preload adds is not in it. ";
  }
  if (!singular.empty()) words += singular + ": singular at this pose, no finite value is right. ";
  return words + "The other components are certain.";
}

std::string_view RuleInWords(ReactionRule rule) {
  switch (rule) {
    case ReactionRule::kStiffness:
      return "of all wrenches that keep the links in equilibrium it takes the one with the least "
             "elastic energy in the joints, which is what elastic bearings on rigid links do.";
    case ReactionRule::kMinimumNorm:
      return "of all wrenches that keep the links in equilibrium it takes the one with the least "
             "sum of squares, moments divided by a length. It is a convention, not a prediction.";
    case ReactionRule::kPaperJoint:
      return "the drive and the wrench at the cut joint are solved for in one minimum-norm step, "
             "as "
             "eq. (14) of the paper is printed. It is meant for comparison.";
  }
  return "";
}

}  // namespace

std::string Enumerate(const std::vector<std::string>& items) {
  std::string text;
  for (size_t i = 0; i < items.size(); ++i) {
    if (i > 0) text += i + 1 == items.size() ? " and " : ", ";
    text += items[i];
  }
  return text;
}

std::string ComponentsInWords(JointType type, const JointCertainty& certainty, Certainty verdict) {
  std::array<bool, 6> is;
  for (size_t i = 0; i < 6; ++i) is[i] = certainty[i] == verdict;
  std::vector<std::string> items;
  AddWords(ForceWords(type), is[0], is[1], is[2], &items);
  AddWords(MomentWords(type), is[3], is[4], is[5], &items);
  return Enumerate(items);
}

Markup CertaintyBadge(const JointCertainty& certainty) {
  if (Any(certainty, Certainty::kSingular)) return html::Badge("singular", html::Tone::kBad);
  if (!Any(certainty, Certainty::kNotDetermined)) return html::Badge("certain", html::Tone::kGood);
  if (!Any(certainty, Certainty::kCertain)) {
    return html::Badge("not determined", html::Tone::kWarning);
  }
  return html::Badge("partly determined", html::Tone::kWarning);
}

Markup CertaintySection(const LoadStudy& study, const LoadStudyResult& result) {
  Markup section = html::Heading(2, "What is certain, and what is not");
  std::vector<Markup> sentences;
  bool all_certain = true;
  for (const Group& group : GroupJoints(study, result)) {
    sentences.push_back(GroupInWords(group, study.rule));
    for (const Certainty verdict : group.certainty) {
      all_certain = all_certain && verdict == Certainty::kCertain;
    }
  }
  if (all_certain) {
    return section + html::Paragraph(
                         "Equilibrium determines every component at every joint. No rule "
                         "was needed, and no stiffness enters the figures.");
  }
  const int n = result.redundant_equations;
  section += html::Paragraph(
      n > 0
          ? fmt::format("{} of the loop equations {} what others say already. Rigid links stay in "
                        "equilibrium whatever the components named below are: alignment, "
                        "clearance and stiffness of the real parts decide.",
                        n, n == 1 ? "repeats" : "repeat")
          : std::string("Equilibrium does not determine the components named below."));
  section += html::BulletList(sentences);
  section += html::Paragraph(Markup("The rule ") + html::Element("code", NameOf(study.rule)) +
                             ": " + RuleInWords(study.rule));
  return section;
}

}  // namespace vmech
