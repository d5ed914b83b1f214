#pragma once

#include "vmech/dynamics/loads/pose/load_workspace.h"

namespace vmech {

/// Freedoms that no drive determines, such as the spin of a rod between two spherical joints. They
/// move as they would from rest, without momentum of their own and without anything that drives
/// them: with N_i their free motions,
///
///   N_i' M v = 0   and   N_i' (M v' + h - passive) = 0.
///
/// Both hold at all times for a rod whose mass is symmetric about the axis of its spin, as long as
/// nothing acts along it.

/// Those without inertia (a rod without mass, or with its mass on its axis: how a distance is often
/// drawn) have neither momentum nor force; their rates and accelerations are zero. What counts as
/// inertia is decided against that of the whole mechanism, LoadModel::no_inertia.

/// The free motions at a pose, and which of them are idle: those of the idle freedoms, or, under a
/// hand, those that it does not see. Needs a factored ws->dependents; writes ws->motions and
/// ws->idle_motions.
template <typename T>
void FindMotions(const LoadModel& model, LoadWorkspace<T>* ws);

/// Adds to ws->v the idle motion that takes its momentum away. Needs X and ws->motions.
template <typename T>
void RemoveIdleMomentum(const LoadModel& model, LoadWorkspace<T>* ws);

/// Adds to ws->vdot the idle acceleration that leaves no force open along the idle freedoms; brings
/// accelerations, F and tau up to date. Writes ws->along_idle, the force that sets them moving, and
/// ws->unresisted, the force that is left where no inertia takes it.
template <typename T>
void SettleIdleFreedoms(const LoadModel& model, LoadWorkspace<T>* ws);

/// Where an idle freedom has got to: the discrete form of the above. Between one pose and the next,
/// every link is displaced by d = [p_cm - p_cm'; log(R R'^T)], and
///
///   sum over links of [v_cm; w]_i' diag(m, I) d = 0,
///
/// with [v_cm; w]_i the links' motion in N_i. It speaks of link poses only, so that the result does
/// not depend on where loops are cut.
class IdlePositions {
 public:
  explicit IdlePositions(const LoadModel& model) : model_(model) {}  ///< keeps a reference
  /// Takes the pose in ws as the one to come from.
  void Remember(const TreeWorkspace<double>& ws);
  /// Moves q along the idle freedoms until the above holds; ws is left at q, closed to `tolerance`.
  void Settle(double tolerance, DependentSolver<double>* dependents, TreeWorkspace<double>* ws,
              VectorXd* q) const;

 private:
  const LoadModel& model_;
  std::vector<Posed> before_;  ///< per node: orientation and centre of gravity
};

/// How much velocities v shift the centre of gravity of any link, in characteristic lengths: above
/// roundoff, weight and inertia depend on them. Needs X; node velocities are scratch.
double ShiftOfCentres(const KinematicTree& tree, const VectorXd& v, TreeWorkspace<double>* ws);

}  // namespace vmech
