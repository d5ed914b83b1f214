#include "vmech/dynamics/simulation/sudden_events.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vmech {
namespace {

struct Interval {
  double before = 0, after = 0;
};

/// The narrowest interval at whose end, but not at whose beginning, `beyond` holds.
template <typename Beyond>
Interval Bisect(double from, double to, const Beyond& beyond) {
  constexpr double kRounding = 1e-15;
  while (to - from > kRounding * std::max(std::abs(from), std::abs(to))) {
    const double middle = from + 0.5 * (to - from);
    if (middle <= from || middle >= to) break;
    (beyond(middle) ? to : from) = middle;
  }
  return {from, to};
}

}  // namespace

SuddenEvents::SuddenEvents(const Simulation& simulation, EquationsOfMotion* equations,
                           StateAt state_at, std::vector<SimulationEvent>* events)
    : simulation_(simulation),
      equations_(*equations),
      state_at_(std::move(state_at)),
      events_(*events),
      bounded_(equations->contacts().Limited()) {
  for (const CoordinateWatch& watch : simulation.watches) bounded_.push_back(watch.at);
}

void SuddenEvents::Place(double time, const double* y) {
  equations_.Place(time, y, y + equations_.tree().nq);
}

void SuddenEvents::Start(double time, VectorXd* y) {
  const Contacts before = equations_.contacts();
  FindContacts(time, y);
  before.Compare(equations_.contacts(), time, equations_.motion(), &events_);
}

void SuddenEvents::LookAround(double time, const VectorXd& y) {
  if (equations_.contacts().empty() && simulation_.watches.empty()) return;
  Place(time, y.data());
  equations_.forces().Remember(equations_.motion());
  equations_.contacts().Watch(equations_.motion());
  LookAtWatches();
  rates_.clear();
  for (const FreedomId& at : bounded_) rates_.push_back(RateOf(at));
}

void SuddenEvents::LookAtWatches() {
  watched_.clear();
  for (const CoordinateWatch& watch : simulation_.watches) watched_.push_back(DistanceFrom(watch));
}

/// Section by section, between which freedoms turn back that may have been beyond a limit.
SuddenEvents::Found SuddenEvents::FindFirst(double from, double to) {
  for (double end : TurningPoints(from, to)) {
    const bool changes = IsBeyondEvent(end);
    if (changes) end = Bisect(from, end, [this](double time) { return IsBeyondEvent(time); }).after;
    const bool ends = PassWatches(from, &end);
    if (changes || ends) return {end, changes && !ends, ends};
    from = end;
  }
  return {to, false, false};
}

/// Where freedoms with limits or watches turn back in (from, to), just before they do; then `to`.
std::vector<double> SuddenEvents::TurningPoints(double from, double to) {
  std::vector<double> turning;
  for (size_t i = 0; i < bounded_.size(); ++i) {
    const auto turned = [&](double time) {
      Place(time, state_at_(time));
      return rates_[i] * RateOf(bounded_[i]) < 0;
    };
    if (rates_[i] != 0 && turned(to)) turning.push_back(Bisect(from, to, turned).before);
  }
  std::sort(turning.begin(), turning.end());
  turning.push_back(to);
  return turning;
}

/// Is the state at a time within the last step beyond an event?
bool SuddenEvents::IsBeyondEvent(double time) {
  Contacts& contacts = equations_.contacts();
  if (contacts.empty()) return false;
  const double* const y = state_at_(time);
  Place(time, y);
  if (contacts.ComesToRest(equations_.motion())) return true;
  if (contacts.PassesLimit(equations_.motion())) return true;
  if (!contacts.any_held()) return false;
  equations_.Evaluate(time, y, y + equations_.tree().nq);
  return contacts.Releases(equations_.motion(), equations_.drives());
}

double SuddenEvents::RateOf(const FreedomId& at) const {
  return equations_.motion().ws().loads[at.joint].rate[at.freedom];
}

double SuddenEvents::DistanceFrom(const CoordinateWatch& watch) const {
  return equations_.motion().ws().loads[watch.at.joint].position[watch.at.freedom] - watch.value;
}

/// Enters watches that are reached in (from, *to]. Where one of them ends the run, *to is there.
bool SuddenEvents::PassWatches(double from, double* to) {
  bool ends = false;
  for (size_t i = 0; i < simulation_.watches.size(); ++i) {
    const CoordinateWatch& watch = simulation_.watches[i];
    const double before = watched_[i];
    const auto beyond = [&](double time) {
      Place(time, state_at_(time));
      return before * DistanceFrom(watch) <= 0;
    };
    if (before == 0 || !beyond(*to)) continue;
    const double time = Bisect(from, *to, beyond).after;
    beyond(time);
    events_.push_back(
        {time, SimulationEvent::Kind::kReached, watch.at, watch.value, RateOf(watch.at)});
    if (!watch.ends_run) continue;
    ends = true;
    *to = time;
  }
  if (!simulation_.watches.empty()) {
    Place(*to, state_at_(*to));
    LookAtWatches();
  }
  return ends;
}

void SuddenEvents::Pass(double time, VectorXd* y) {
  Place(time, y->data());
  const Contacts before = equations_.contacts();
  const std::vector<StoppedHit> stopped = Rebound(time, y);
  FindContacts(time, y);
  for (const StoppedHit& hit : stopped) {
    if (!equations_.contacts().IsClosed(hit.hit)) events_.push_back(hit.event);
  }
  before.Compare(equations_.contacts(), time, equations_.motion(), &events_);
}

void SuddenEvents::FindContacts(double time, VectorXd* y) {
  if (equations_.contacts().empty()) return;
  Place(time, y->data());
  equations_.FindContacts(time, y->data(), y->data() + equations_.tree().nq);
}

SimulationEvent SuddenEvents::EventOf(const Contacts::Hit& hit, double time) {
  const FreedomId at = equations_.contacts().FreedomOf(hit);
  const JointLoad<double>& joint = equations_.motion().ws().loads[at.joint];
  return {time, SimulationEvent::Kind::kRebound, at, joint.position[at.freedom],
          joint.rate[at.freedom]};
}

std::vector<SuddenEvents::StoppedHit> SuddenEvents::Rebound(double time, VectorXd* y) {
  std::vector<Contacts::Hit> hits = equations_.contacts().FindHits(equations_.motion());
  std::vector<StoppedHit> stopped;
  if (hits.empty()) return stopped;
  const double before = equations_.KineticEnergyHere();
  const VectorXd v = equations_.motion().ws().v;
  std::vector<SimulationEvent> rebounds;
  for (const Contacts::Hit& hit : hits) rebounds.push_back(EventOf(hit, time));
  equations_.contacts().ReleaseFriction();
  Impact(time, hits, v, y);
  if (LetRest(time, *y, &hits)) Impact(time, hits, v, y);
  for (size_t i = 0; i < hits.size(); ++i) {
    if (hits[i].rate != 0) {
      events_.push_back(rebounds[i]);
    } else {
      stopped.push_back({hits[i], rebounds[i]});
    }
  }
  equations_.HoldContacts();
  Place(time, y->data());
  (*y)[equations_.size() - 1] += before - equations_.KineticEnergyHere();
  return stopped;
}

/// From rates v to those after the hits, in *y.
void SuddenEvents::Impact(double time, const std::vector<Contacts::Hit>& hits, const VectorXd& v,
                          VectorXd* y) {
  equations_.Impact(time, y->data(), v.data(), hits);
  y->segment(equations_.tree().nq, equations_.tree().nv) = equations_.motion().ws().v;
}

/// Freedoms that would be back at their limit within a microsecond stay there. True if any.
bool SuddenEvents::LetRest(double time, const VectorXd& y, std::vector<Contacts::Hit>* hits) {
  constexpr double kFlight = 1e-6;  // [s]
  equations_.HoldContacts();
  equations_.Evaluate(time, y.data(), y.data() + equations_.tree().nq);
  bool rests = false;
  for (Contacts::Hit& hit : *hits) {
    const double pressing = hit.pressing * equations_.motion().SlopeOf(hit.row);
    if (hit.rate == 0 || !(2 * std::abs(hit.rate) < kFlight * pressing)) continue;
    hit.rate = 0;
    rests = true;
  }
  return rests;
}

}  // namespace vmech
