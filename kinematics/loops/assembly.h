#pragma once

#include <string>
#include <vector>

#include "vmech/kinematics/tree/kinematic_tree.h"

namespace vmech {

/// When loops count as closed, and how Assemble gets there.
struct AssemblyOptions {
  double tolerance =
      1e-13;  ///< largest loop error, dimensionless, that counts as closed, (0, 1e-3]
  int max_iterations = 200;  ///< more for bad guesses, 1..10000
  /// Weight of a loop error against a departure from the wanted coordinates (paper's lambda,
  /// squared), [1, 1e8]. The multiplier update makes the result independent of it.
  double penalty = 1e4;
  /// Velocity indices whose coordinates stay as given (the driven ones).
  std::vector<int> fixed;
  /// Other starts that are tried when the given one leads nowhere, 0..1000: first beside the pose
  /// where the iteration ends, along the directions that it cannot see (a flat pose, links in
  /// line), then ever farther all around. More find poses farther off and cost time where there is
  /// none.
  int other_starts = 48;

  void Validate() const;  ///< @throws std::invalid_argument naming field, value and range
  /// From the given coordinates only: for poses near to closed ones.
  static AssemblyOptions Nearby();
};

/// What came of closing loops.
struct AssemblySummary {
  bool closed = false;        ///< within the tolerance
  int iterations = 0;         ///< of all starts together
  double start_error = 0;     ///< largest loop error of the given coordinates
  double error = 0;           ///< and of the returned ones; dimensionless as LargestLoopError
  int starts = 1;             ///< that were tried
  int worst_joint = -1;       ///< cut joint with the largest error
  double worst_distance = 0;  ///< that is left between its anchors [m]
  double worst_angle = 0;     ///< that is left between its anchors [rad]
  /// What is wrong, at which joint and by how much; empty if closed.
  std::string message;
};

/// Brings the anchors of all cut joints together, as near to the given coordinates as the loops
/// allow: minimise |q - q_given|^2 subject to e2(q) = 0, by the penalty iteration of paper eq. (8)
/// with J = 1, e1 = q_given - q and a multiplier update after each step, damped until it descends.
/// Of the poses to which other starts lead, the one nearest to the given coordinates is taken.
///
/// For one tree; AssembleMechanism does the same for whatever cuts, and for files whose figures are
/// rounded.
/// @throws std::invalid_argument as AssemblyOptions::Validate.
AssemblySummary Assemble(const KinematicTree& tree, const AssemblyOptions& options, VectorXd* q);

}  // namespace vmech
