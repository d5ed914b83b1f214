#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "vmech/kinematics/inverse/inverse_kinematics.h"

namespace vmech {

/// A grasp that must be exactly where the hand is.
struct HandPose {
  GraspFrame grasp;  ///< on its link
  Posed X_WH;        ///< of the hand in the world
};

/// What a search for assembly modes holds, and how long it searches.
struct AssemblyModesOptions {
  /// Velocity indices of single freedoms (not of spherical joints) whose coordinates stay as given.
  std::vector<int> fixed;
  /// Where the grasp has to be, if anywhere; for a point grasp its position alone.
  std::optional<HandPose> hand;
  /// Links whose poses tell modes apart; empty: all. Leave out links whose pose does not matter,
  /// such as rods that are free to spin.
  std::vector<int> links;
  /// Random starts at most, 1..10000000.
  int max_starts = 20000;
  /// Stop after this many starts in a row without a new mode, 1..10000000. Raise it until the
  /// number of modes no longer changes.
  int patience = 2000;
  /// Largest error of loops and grasp in a mode, dimensionless as LargestLoopError, [1e-15, 1e-6].
  double tolerance = 1e-13;
  /// Modes differ if some link is shifted by this part of the characteristic length or turned by
  /// this angle [rad], [1e-9, 1].
  double separation = 1e-3;
  /// Modes outside the limits of joints do not count.
  bool joint_limits = true;
  /// The same seed gives the same modes in the same order.
  std::uint64_t seed = 1;

  /// @throws std::invalid_argument naming field, value and range
  void Validate(const KinematicTree& tree) const;
};

/// One way in which the loops of a mechanism close.
struct AssemblyMode {
  VectorXd q;        ///< angles of joints without limits within +-pi
  int found = 0;     ///< from so many of the starts
  double error = 0;  ///< largest error of loops and grasp, dimensionless
  /// The links cannot move, to first order, with `fixed` and `hand` as they are. If they can,
  /// modes are no matter of counting, and the search ends after twenty of them: hold more.
  bool isolated = true;
};

/// What a search for assembly modes found.
struct AssemblyModes {
  std::vector<AssemblyMode>
      modes;             ///< in the order of discovery, the given pose first if it is one
  int starts = 0;        ///< that were made
  int converged = 0;     ///< starts that ended in a mode
  int since_new = 0;     ///< starts since the last new mode
  bool settled = false;  ///< `patience` was reached, not `max_starts`
  /// Probability that the next start that converges finds a new mode: the share of modes found once
  /// among all findings. [Good 1953]
  double unseen = 1;

  std::string BriefReport() const;  ///< one line
};

/// All assembly modes: the closed poses with the coordinates `fixed` as in q, and the grasp at the
/// hand. Random starts over the ranges of the joints (q itself is the first), each brought to
///
///   minimise |W e2|^2 + |e1/L|^2
///
/// by Levenberg-Marquardt and, where that comes to zero, polished by Newton. Starts that end in a
/// minimum which is not zero are common and only cost time.
/// @throws std::invalid_argument as Validate.
AssemblyModes FindAssemblyModes(const KinematicTree& tree, const AssemblyModesOptions& options,
                                const VectorXd& q);

}  // namespace vmech
