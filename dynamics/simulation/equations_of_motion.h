#pragma once

#include <memory>
#include <vector>

#include "vmech/dynamics/simulation/acting_forces.h"
#include "vmech/dynamics/simulation/constrained_motion.h"
#include "vmech/dynamics/simulation/prepared_simulation.h"

namespace vmech {

/// The motion of a simulated mechanism as a problem for an integrator, y' = f(t, y), with the state
///
///   y = [q; v; supplied; dissipated]    coordinates and rates of the tree, energies [J]
///
/// f is that of the nearest rates that the loops allow, so that y leaves them by the errors of the
/// integrator alone. Nothing allocates in f, but at singular poses.
class EquationsOfMotion {
 public:
  /// Keeps a reference.
  explicit EquationsOfMotion(const PreparedSimulation& prepared);

  int size() const { return tree_.nq + tree_.nv + 2; }
  /// Writes f [size]. False if it is not finite, or at a singular pose, over which steps lead:
  /// loops that lose rank leave little more than rounding of how they bend there. From a singular
  /// pose on inertia decides what they do not, until the first that is not.
  bool Slopes(double time, const double* y, double* slopes);

  /// Everything at a state: pose, rates, forces, accelerations; see motion() and forces().
  void Evaluate(double time, const double* q, const double* v);
  /// The same without forces and accelerations. Steps go on from there.
  void Place(double time, const double* q, const double* v);
  /// Closes the loops of q, with the drives where their laws have them. Returns what is left.
  double Close(double time, double* q);

  /// Independent freedoms as they are best at q. False if they are no better than those that there
  /// are.
  bool ChooseFreedoms(const VectorXd& q);
  /// Has the choice become bad?
  bool ChoosesBadly() const;

  const KinematicTree& tree() const { return tree_; }
  ConstrainedMotion& motion() { return now_->motion; }
  ActingForces& forces() { return now_->forces; }
  const LoadModel& model() const { return now_->model; }
  double Energy() const;  ///< kinetic, weight, springs [J]
  double KineticEnergyHere() const;
  double WeightEnergyHere() const;

  long evaluations = 0, singular_poses = 0, partitions = 1;

 private:
  /// What depends on the choice of independent freedoms.
  struct Choice {
    Choice(const PreparedSimulation& prepared, const CoordinatePartition& partition);
    LoadModel model;
    ActingForces forces;
    ConstrainedMotion motion;
    double best_pivot = 0;
  };

  std::unique_ptr<Choice> MakeChoice(const VectorXd& q, double tolerance) const;
  void FindDriveMotion(double time);
  void SetPose(const double* q);
  void CloseIfNearlySingular();

  const PreparedSimulation& prepared_;
  const KinematicTree& tree_;
  std::vector<int> driven_;
  std::unique_ptr<Choice> regular_, singular_;
  std::vector<double> closed_;  ///< [nq] where loops were closed before anything else
  Choice* now_ = nullptr;       ///< the one of these that the last pose is known by
  std::vector<double> held_rates_, held_slopes_;
  bool from_singular_ = false;
};

}  // namespace vmech
