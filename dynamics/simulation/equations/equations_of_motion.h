#pragma once

#include <memory>
#include <vector>

#include "vmech/dynamics/loads/pose/friction_iteration.h"
#include "vmech/dynamics/simulation/equations/acting_forces.h"
#include "vmech/dynamics/simulation/equations/constrained_motion.h"
#include "vmech/dynamics/simulation/equations/contacts.h"
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

  /// Numbers in y.
  int size() const { return tree_.nq + tree_.nv + 2; }
  /// Writes f [size]. False if it is not finite, or at a singular pose, over which steps lead:
  /// loops that lose rank leave little more than rounding of how they bend there. From a singular
  /// pose on inertia decides what they do not, until the first that is not.
  bool Slopes(double time, const double* y, double* slopes);

  /// Everything at a state: pose, rates, forces, accelerations; see motion() and forces(). False if
  /// friction under load has no equilibrium there: the mechanism locks.
  bool Evaluate(double time, const double* q, const double* v);
  /// Takes coordinates, rates and slopes of rates as they are, on the loops or not: forces in
  /// ws().passive, what the motion asks for in ws().tau.
  void TakeState(double time, const double* q, const double* v, const double* vdot);
  /// Pose, rates, and both of all joints. Steps go on from there.
  void Place(double time, const double* q, const double* v);
  /// Steps go on from the pose that was last evaluated, or from one next to it.
  void GoOnFromHere();
  /// Rates after an impact, in ws().v: held contacts stay, and those that hit are left.
  void Impact(double time, const double* q, const double* v,
              const std::vector<Contacts::Hit>& hits);
  /// Closes the loops of q, with the drives where their laws have them. Returns what is left.
  double Close(double time, double* q);

  /// The largest rate at which v [nv] opens loops at the pose, dimensionless [1/s].
  double RateDrift(const double* v) const;

  /// Independent freedoms as they are best at q. False if they are no better than those that there
  /// are.
  bool ChooseFreedoms(const VectorXd& q);
  /// Has the choice become bad?
  bool ChoosesBadly() const;
  /// Do loops lose rank at the pose?
  bool IsSingular() const;

  const KinematicTree& tree() const { return tree_; }     ///< of the assembled mechanism
  ConstrainedMotion& motion() { return now_->motion; }    ///< of the pose that Slopes was last at
  ActingForces& forces() { return now_->forces; }         ///< at that pose
  Contacts& contacts() { return contacts_; }              ///< what rests and what slides
  const Contacts& contacts() const { return contacts_; }  ///< the same, to read
  /// Holds what the contacts hold from now on.
  void HoldContacts();
  /// Holds what rests at a state and what stands at limits, but for what slips or opens at once.
  /// Takes rates v [nv] as that allows. Needs joint positions and rates, as of Place.
  void FindContacts(double time, const double* q, double* v);
  /// Freedoms that move as prescribed.
  int drives() const { return static_cast<int>(driven_.size()); }
  /// What a drive prescribes.
  MotionSample DriveAt(size_t drive, double time) const;
  /// The drives move like this from now on, and not by their laws [drives].
  void MoveDrives(std::vector<MotionSample> samples) { given_drives_ = std::move(samples); }
  /// Angles of cut joints continue from these [loops].
  void ContinueCutJoints(std::vector<Vector3d> positions) {
    regular_->forces.ContinueFrom(std::move(positions));
  }
  /// [joints] along the joints' freedoms beside springs and dampers: motors, friction, limits.
  std::vector<Vector3d> BesideSprings() const;
  const LoadModel& model() const { return now_->model; }  ///< what loads are computed with
  double KineticEnergyHere() const;  ///< at the pose and rates of the last Slopes [J]
  double WeightEnergyHere() const;   ///< there, against the reference height [J]

  /// From now on singular poses may be evaluated nearer than an integrator should come to them.
  void ComeNearest(bool comes) { comes_nearest_ = comes; }

  long evaluations = 0, singular_poses = 0, partitions = 1;  ///< how many there were

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
  void KeepHeldRates(const double* q, const double* v);
  std::vector<RateRow> HeldRows() const;
  bool AccelerateUnderLoad();
  void SetPose(const double* q);
  void CloseIfNearlySingular();
  double Nearest() const;

  const PreparedSimulation& prepared_;
  const KinematicTree& tree_;
  std::vector<int> driven_;
  std::vector<MotionSample> given_drives_;  ///< empty: their laws hold
  Contacts contacts_;
  FrictionIteration friction_;
  std::vector<Vector3d> held_along_;  ///< [joints] while friction under load settles
  bool under_load_ = false;           ///< any friction depends on loads
  std::unique_ptr<Choice> regular_, singular_;
  std::vector<double> closed_;  ///< [nq] where loops were closed before anything else
  Choice* now_ = nullptr;       ///< the one of these that the last pose is known by
  std::vector<double> held_rates_, held_slopes_;
  bool from_singular_ = false;    ///< the state that steps go on from is at a singular pose
  bool avoids_singular_ = false;  ///< evaluations there are not wanted, and
  bool leads_over_ = false;       ///< this one is such
  bool comes_nearest_ = false;    ///< ComeNearest
};

}  // namespace vmech
