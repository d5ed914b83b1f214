#pragma once

#include <string>
#include <vector>

#include "vmech/kinematics/loops/assembly.h"
#include "vmech/kinematics/loops/axis_misfit.h"
#include "vmech/kinematics/loops/reconcile.h"
#include "vmech/mechanisms/mechanism.h"

namespace vmech {

/// A coordinate that the assembly moved from where the mechanism states it.
struct MovedStart {
  int joint = -1;           ///< index in Mechanism::joints
  int freedom = 0;          ///< counted from 0
  double from = 0, to = 0;  ///< [m] or [rad]
};

/// A mechanism with its loops closed, from which every computation begins.
struct AssembledMechanism {
  /// The start values of all its joints, whatever will be cut, are those of the assembled pose;
  /// anchors are moved where the rounding of their figures kept loops from closing.
  Mechanism mechanism;
  AssemblySummary summary;  ///< closed, or why not
  double correction = 0;    ///< as Reconciliation::correction; 0 if no anchor was moved
  /// The loop error, dimensionless, to which its loops close at all poses: where anchors were
  /// moved, some rounding is left between the poses that Reconcile walked over.
  double closure_tolerance = AssemblyOptions().tolerance;
  std::vector<AxisMisfit> misfits;       ///< what was moved, in words of the drawing
  std::vector<MovedStart> moved_starts;  ///< the stated ones; all, if another start had to be found

  /// What a user should know, a sentence each: starts that were moved, another start that had to be
  /// found, figures that are rounded by more than 1e-9, joints that start outside their limits.
  std::vector<std::string> Notes() const;
};

/// How AssembleMechanism closes loops, and what it leaves alone.
struct AssembleOptions {
  AssemblyOptions closing;        ///< when loops count as closed
  std::vector<int> fixed_joints;  ///< whose start values stay as given
};

/// Closes the loops of a mechanism, the same for every use of it. They are cut where no start is
/// stated (and then as FindSpanningTree cuts) and closed as Assemble does; where rounded figures
/// let them close nowhere, or only at poses at which nothing moves, Reconcile moves the anchors, by
/// no more than Mechanism::tolerance.
/// @throws std::invalid_argument as FindSpanningTree and AssemblyOptions::Validate.
AssembledMechanism AssembleMechanism(const Mechanism& mechanism,
                                     const AssembleOptions& options = {});

/// The same for those who need closed loops.
/// @throws std::runtime_error with the joint, the gap and the remedy where loops do not close;
///         std::invalid_argument as AssembleMechanism.
AssembledMechanism RequireAssembled(const Mechanism& mechanism,
                                    const AssembleOptions& options = {});

/// Gives all joints, cut or not, the start values of a closed pose q of the mechanism's tree;
/// angles of cut joints in the turn that is nearest to what they start at.
void SetStarts(const KinematicTree& tree, const VectorXd& q, Mechanism* mechanism);

/// The start values of all freedoms, joint after joint, in the order of a joint's lists; those of a
/// spherical joint are its rotation vector.
std::vector<double> StartOfFreedoms(const Mechanism& mechanism);

/// Joints whose start values are outside their limits, a sentence each.
std::vector<std::string> StartsOutsideLimits(const Mechanism& mechanism);

}  // namespace vmech
