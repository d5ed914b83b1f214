#pragma once

#include <vector>

#include "vmech/dynamics/loads/pose/contact_friction.h"
#include "vmech/dynamics/simulation/equations/constrained_motion.h"
#include "vmech/dynamics/simulation/equations/contact_forces.h"
#include "vmech/dynamics/simulation/simulation.h"
#include "vmech/dynamics/simulation/simulation_result.h"

namespace vmech {

/// Where things touch: dry friction that rests or slides, and limits that are open or closed. Which
/// of both holds does not change between two events. The rates of what rests or is closed are held;
/// what holds them is found by SolveContacts.
class Contacts {
 public:
  /// @throws std::invalid_argument naming the joint that starts outside its limits.
  Contacts(const Simulation& simulation, const KinematicTree& tree);

  /// No joint has dry friction or limits.
  bool empty() const { return frictions_.empty() && stops_.empty(); }
  bool any_held() const;                   ///< something rests or is closed
  std::vector<FreedomId> Limited() const;  ///< the freedoms that have limits

  /// The held rates.
  std::vector<RateRow> Held() const;
  /// Writes ws().sliding: rates, or signs of them, of what slides.
  void SetSliding(ConstrainedMotion* motion) const;
  /// Adds what holds the held rates to forces along the joints' freedoms [joints]: multipliers of
  /// `motion`, whose held rows are `before` others and then Held.
  void AddHeldForces(const ConstrainedMotion& motion, int before,
                     std::vector<Vector3d>* along) const;

  /// At the beginning of a step.
  void Watch(const ConstrainedMotion& motion);
  /// Since then: has a contact that slides come to rest, or gone on beyond it?
  bool ComesToRest(const ConstrainedMotion& motion) const;
  /// Is a limit passed that was open?
  bool PassesLimit(const ConstrainedMotion& motion) const;
  /// After Accelerate with Held as the last rows: is anything held that cannot be?
  bool Releases(const ConstrainedMotion& motion, int before);

  /// A stop that is run into, and the rate at which it is left.
  struct Hit {
    size_t stop = 0;      ///< which one, of all
    RateRow row;          ///< rate of its freedom
    double rate = 0;      ///< after it
    double pressing = 1;  ///< 1 at an upper limit, -1 at a lower one
  };
  /// Stops that are reached at a speed into them.
  std::vector<Hit> FindHits(const ConstrainedMotion& motion) const;
  /// The stop of a hit holds from now on.
  void CloseStop(const Hit& hit) { stops_[hit.stop].closed = hit.pressing > 0 ? 1 : -1; }
  /// True if the stop of a hit holds already.
  bool IsClosed(const Hit& hit) const { return stops_[hit.stop].closed != 0; }
  /// The joint and freedom whose limit was hit.
  FreedomId FreedomOf(const Hit& hit) const { return stops_[hit.stop].at; }

  /// Friction rests where it does not slide; limits close at which a freedom stands. Needs joint
  /// positions and rates.
  void HoldAllAtRest(const ConstrainedMotion& motion);
  void ReleaseFriction();  ///< all of it slides from now on
  void OpenLimits();       ///< all limits that are closed
  /// After Accelerate with Held as the last rows: what cannot be held slips or opens. True if any.
  bool Release(const ConstrainedMotion& motion, int before);

  /// What is different in `after`.
  void Compare(const Contacts& after, double time, const ConstrainedMotion& motion,
               std::vector<SimulationEvent>* events) const;

 private:
  struct Friction {
    int joint = -1;
    JointType type = JointType::kRevolute;
    /// The freedoms of the joint that friction acts along. A ball may turn hard about two axes, and
    /// freely about the third: it rests where it turns about that alone.
    std::vector<int> freedoms;
    std::vector<RateRow> rows;  ///< of each
    bool rests = false;
    /// The rates of these freedoms, zero of the others.
    Vector3d RatesIn(const ConstrainedMotion& motion) const;
    Vector3d direction = Vector3d::Zero();  ///< of its sliding as it began, by freedom of the joint
    Vector3d last = Vector3d::Zero();       ///< RatesIn at Watch
  };
  struct Stop {
    FreedomId at;
    RateRow row;
    double lower = 0, upper = 0, restitution = 0;
    int closed = 0;  ///< -1 at the lower limit, 1 at the upper one
  };

  std::vector<HeldContact> HeldContacts(const ConstrainedMotion& motion, int before) const;
  ContactForces Solve(const ConstrainedMotion& motion, int before);
  /// visit(contact, friction or null, stop or null) for what is held, in the order of Held.
  template <typename Visit>
  void ForEachHeld(const Visit& visit);

  const KinematicTree& tree_;
  std::vector<Friction> frictions_;
  std::vector<Stop> stops_;
  VectorXd forces_;  ///< of the last solve, with which the next begins
};

}  // namespace vmech
