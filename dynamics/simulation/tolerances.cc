#include "vmech/dynamics/simulation/tolerances.h"

#include <algorithm>
#include <cstddef>

#include "vmech/dynamics/rigid_body/passive.h"

namespace vmech {
namespace {

/// What energies are measured by: the weight and the inertia of all links over a characteristic
/// length, and the springs of joints [J].
double EnergyUnit(const KinematicTree& tree) {
  double unit = 0;
  for (const TreeNode& node : tree.nodes) {
    unit += node.mass * tree.length * (tree.mechanism.gravity_W.norm() + tree.length);
  }
  for (const Joint& joint : tree.mechanism.joints) {
    for (const Passive& passive : joint.passive) {
      unit += (passive.stiffness + passive.viscous) * tree.length * tree.length;
    }
  }
  return unit;
}

}  // namespace

std::vector<double> AbsoluteTolerances(const PreparedSimulation& prepared, double tolerance) {
  constexpr double kDoesNotCount = 1e30;
  const KinematicTree& tree = prepared.model.tree;
  std::vector<double> tolerances(static_cast<size_t>(tree.nq + tree.nv), tolerance);
  for (const TreeNode& node : tree.nodes) {
    if (node.motion != NodeMotion::kPrismatic) continue;
    tolerances[static_cast<size_t>(node.q)] *= tree.length;
    tolerances[static_cast<size_t>(tree.nq + node.v)] *= tree.length;
  }
  const double unit = prepared.simulation.drives.empty() ? 0 : EnergyUnit(tree);
  tolerances.insert(tolerances.end(), 2, unit > 0 ? tolerance * unit : kDoesNotCount);
  return tolerances;
}

double LargestDrift(const SimulationOptions& options, const KinematicTree& tree,
                    const VectorXd& y) {
  constexpr double kSteps = 10;
  if (options.drift_tolerance > 0) return options.drift_tolerance;
  const double largest = y.head(tree.nq).lpNorm<Eigen::Infinity>() / std::max(1.0, tree.length);
  return kSteps *
         std::max(options.relative_tolerance * std::max(1.0, largest), options.absolute_tolerance);
}

}  // namespace vmech
