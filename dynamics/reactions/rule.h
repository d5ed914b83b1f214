#pragma once

#include <string_view>

namespace vmech {

/// How the reaction components that statics leaves open are settled.
enum class ReactionRule {
  kStiffness,    ///< least elastic energy of the joints: elastic bearings on rigid links
  kMinimumNorm,  ///< least sum of |force|^2 + |moment|^2 / length^2 over all joints
  kPaperJoint,   ///< paper eq. (14) as printed: drive and cut wrenches in one minimum-norm step
};

/// The rule as files and options have it.
constexpr std::string_view NameOf(ReactionRule rule) {
  switch (rule) {
    case ReactionRule::kStiffness:
      return "stiffness";
    case ReactionRule::kMinimumNorm:
      return "minimum_norm";
    case ReactionRule::kPaperJoint:
      return "paper_joint";
  }
  return "";
}

}  // namespace vmech
