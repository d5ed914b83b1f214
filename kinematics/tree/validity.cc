#include "vmech/kinematics/tree/validity.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace vmech {

void RequireCoordinates(std::string_view field, const KinematicTree& tree, const VectorXd& q) {
  if (q.size() != tree.nq) {
    throw std::invalid_argument(
        fmt::format("{} has {} entries, but the tree of '{}' has {} coordinates "
                    "(StartCoordinates gives a first guess)",
                    field, q.size(), tree.mechanism.name, tree.nq));
  }
  for (int i = 0; i < tree.nq; ++i) {
    if (std::isfinite(q[i])) continue;
    throw std::invalid_argument(fmt::format("{}[{}] = {}, must be finite", field, i, q[i]));
  }
}

void RequireVelocities(std::string_view field, const KinematicTree& tree,
                       const std::vector<int>& indices) {
  for (int v : indices) {
    if (v >= 0 && v < tree.nv) continue;
    throw std::invalid_argument(
        fmt::format("{} has {}, but the tree's velocities are 0..{}; VelocityIndex gives -1 for a "
                    "joint that is cut (SpanningTreeOptions::keep keeps it whole)",
                    field, v, tree.nv - 1));
  }
}

void RequireClosed(std::string_view field, double error, double tolerance) {
  if (error <= tolerance) return;
  throw std::invalid_argument(
      fmt::format("{}: the loops are open by {:.3g} of the characteristic length at the start; "
                  "close them first (Assemble)",
                  field, error));
}

void RequireNode(std::string_view field, const KinematicTree& tree, int node) {
  if (node >= -1 && node < static_cast<int>(tree.nodes.size())) return;
  throw std::invalid_argument(
      fmt::format("{} = {}, but the tree's nodes are 0..{}, and -1 for the "
                  "ground (GraspFrameOf makes a frame of a grasp)",
                  field, node, tree.nodes.size() - 1));
}

}  // namespace vmech
