#include "vmech/dynamics/simulation/motions_without_inertia.h"

#include <fmt/format.h>

#include "vmech/kinematics/loops/dimensionless_loops.h"

namespace vmech {
namespace {

/// The freedoms that move, as "'a', 'b' and 3 more".
std::string NameFreedoms(const KinematicTree& tree, const VectorXd& motion) {
  constexpr double kMoves = 1e-6;  // beside the fastest
  constexpr int kShown = 6;
  const VectorXd moves = motion.cwiseQuotient(VelocityScale(tree)).cwiseAbs();
  std::string names;
  int found = 0;
  for (int v = 0; v < tree.nv; ++v) {
    if (moves[v] <= kMoves * moves.maxCoeff()) continue;
    if (++found > kShown) continue;
    names += fmt::format("{}'{}'", found > 1 ? ", " : "", NameOfVelocity(tree, v));
  }
  return found > kShown ? fmt::format("{} and {} more", names, found - kShown) : names;
}

}  // namespace

std::string DescribeUnresisted(const KinematicTree& tree, const ConstrainedMotion& motion) {
  constexpr double kRounding = 1e-7;
  const UnresistedForce& left = motion.unresisted();
  if (left.share <= kRounding) return {};
  return fmt::format(
      "{:.4g} N or N m act along a motion without inertia (of {}), which answers with no finite "
      "acceleration; give a link that takes part in it mass and inertia, lock one of these joints "
      "(make it a weld, or a joint without that freedom), or leave the force out",
      left.force, NameFreedoms(tree, motion.MotionWithoutInertia(left.motion)));
}

std::vector<std::string> DescribeStanding(const KinematicTree& tree,
                                          const ConstrainedMotion& motion) {
  std::vector<std::string> notes;
  for (int i = 0; i < motion.without_inertia(); ++i) {
    notes.push_back(fmt::format(
        "a motion of {} has no inertia, and no force acts along it: nothing tells how it goes, and "
        "it is taken to stand still; give a link that takes part in it mass and inertia if it "
        "matters",
        NameFreedoms(tree, motion.MotionWithoutInertia(i))));
  }
  return notes;
}

}  // namespace vmech
