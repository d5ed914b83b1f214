#pragma once

#include <functional>
#include <vector>

#include "vmech/dynamics/simulation/equations/equations_of_motion.h"
#include "vmech/dynamics/simulation/simulation.h"
#include "vmech/dynamics/simulation/simulation_result.h"

namespace vmech {

/// What happens at once in a run, found within a step that has been taken: contacts that come to
/// rest or slip, limits that close, open or throw back, coordinates that are watched for. States
/// are those of EquationsOfMotion::Slopes.
class SuddenEvents {
 public:
  /// The state at a time within the last step, until it is asked for again.
  using StateAt = std::function<const double*(double time)>;

  /// Keeps references; enters what happens into `events`.
  SuddenEvents(const Simulation& simulation, EquationsOfMotion* equations, StateAt state_at,
               std::vector<SimulationEvent>* events);

  /// What rests at the start, and what slips or opens there at once. Takes the rates of y as that
  /// allows.
  void Start(double time, VectorXd* y);
  /// The next step, from this state, is looked at.
  void LookAround(double time, const VectorXd& y);
  /// When something happens, and what.
  struct Found {
    double time = 0;        ///< [s]
    bool changes = false;   ///< what rests or is closed: Pass goes on from there
    bool ends_run = false;  ///< a watched coordinate does
  };
  /// The first of them in (from, to], or `to`.
  Found FindFirst(double from, double to);
  /// Impacts at a state on the loops, and what rests, slips or opens from there on.
  void Pass(double time, VectorXd* y);

 private:
  /// A hit that takes all speed: an event of its own where the freedom does not stay at its limit.
  struct StoppedHit {
    Contacts::Hit hit;
    SimulationEvent event;
  };

  void Place(double time, const double* y);
  bool IsBeyondEvent(double time);
  double RateOf(const FreedomId& at) const;
  double DistanceFrom(const CoordinateWatch& watch) const;
  void LookAtWatches();
  std::vector<double> TurningPoints(double from, double to);
  bool PassWatches(double from, double* to);
  void FindContacts(double time, VectorXd* y);
  std::vector<StoppedHit> Rebound(double time, VectorXd* y);
  SimulationEvent EventOf(const Contacts::Hit& hit, double time);
  bool LetRest(double time, const VectorXd& y, std::vector<Contacts::Hit>* hits);
  void Impact(double time, const std::vector<Contacts::Hit>& hits, const VectorXd& v, VectorXd* y);

  const Simulation& simulation_;
  EquationsOfMotion& equations_;
  StateAt state_at_;
  std::vector<SimulationEvent>& events_;
  std::vector<double> watched_;     ///< of each watch, how far it was where the section begins
  std::vector<FreedomId> bounded_;  ///< freedoms with limits, and those that are watched
  std::vector<double> rates_;       ///< of each of these at LookAround
};

}  // namespace vmech
