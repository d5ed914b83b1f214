#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "vmech/kinematics/loops/coordinate_partition.h"
#include "vmech/kinematics/tree/tree_workspace.h"

namespace vmech {

/// What equilibrium says about one component of a joint's wrench.
enum class Certainty {
  kCertain,
  kNotDetermined,  ///< rigid links in equilibrium allow any value
  kSingular,       ///< grows without bound as this pose (a dead centre) is approached
};

/// The certainty in words.
constexpr std::string_view NameOf(Certainty certainty) {
  switch (certainty) {
    case Certainty::kCertain:
      return "certain";
    case Certainty::kNotDetermined:
      return "not determined by statics";
    case Certainty::kSingular:
      return "singular at this pose";
  }
  return "";
}

/// The verdict on every component of one joint, [fx fy fz mx my mz], axes of its first anchor.
using JointCertainty = std::array<Certainty, 6>;

/// Verdicts at one closed pose. The reactions that equilibrium leaves open are the null space of
/// C_u' (paper eq. 13); a component is certain exactly if no vector of that null space loads it. A
/// direction of multipliers that the dependent freedoms hardly feel (smallest singular value of the
/// dimensionless C_u below kSingularTolerance) marks the components that it loads as singular.
/// The verdict depends on rigid-body equilibrium alone, not on where the loops are cut.
/// `rounding`: by how much figures were off (AssembledMechanism::correction); axes that are turned
/// by no more than some of that do not carry an open load into a component that has none.
std::vector<JointCertainty> JudgeCertainty(const KinematicTree& tree,
                                           const CoordinatePartition& partition, const VectorXd& q,
                                           double rounding = 0);

/// The part of a unit load below which a component counts as touched by the rounding of axes alone:
/// the rounding, times what a mechanism may make of it.
inline double TouchOfRounding(double rounding) {
  return 30 * rounding;
}

/// Singular values of C_u below this part of the largest mark a singular pose; a pose this near to
/// a dead centre multiplies loads by the inverse.
inline constexpr double kSingularTolerance = 1e-6;

/// Least singular value of the dimensionless C_u over its largest at a closed pose; 1 without
/// loops.
double DistanceFromDeadCentre(const KinematicTree& tree, const CoordinatePartition& partition,
                              const VectorXd& q);

}  // namespace vmech
