#include "vmech/dynamics/simulation/equations/contacts.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "vmech/dynamics/rigid_body/passive.h"

namespace vmech {
namespace {

/// Of the slopes of rates that there are: less is rounding.
constexpr double kNoSlope = 1e-9;
/// Of rates: [1/s], and of the largest.
constexpr double kNoRate = 1e-9;
/// Where a freedom stands at its limit, of a radian and of the characteristic length.
constexpr double kAtLimit = 1e-10;

double PositionOf(const ConstrainedMotion& motion, const FreedomId& at) {
  return motion.ws().loads[at.joint].position[at.freedom];
}

double RateOf(const ConstrainedMotion& motion, const FreedomId& at) {
  return motion.ws().loads[at.joint].rate[at.freedom];
}

double Along(const Vector3d& way, const Vector3d& rate, const SlidingContact& freedoms) {
  const auto [first, count] = freedoms;
  return way.segment(first, count).dot(rate.segment(first, count));
}

double RestitutionAt(const Simulation& simulation, const FreedomId& at) {
  for (const LimitRebound& rebound : simulation.rebounds) {
    const bool same = rebound.at.joint == at.joint && rebound.at.freedom == at.freedom;
    if (same) return rebound.restitution;
  }
  return 0;
}

void RequireInside(const Joint& joint, int freedom) {
  const double start = joint.start[freedom];
  if (start >= joint.lower[freedom] - kAtLimit && start <= joint.upper[freedom] + kAtLimit) return;
  throw std::invalid_argument(fmt::format(
      "joint '{}' starts at {:.9g}, outside its limits {:.9g} to {:.9g}; start inside, or widen "
      "them",
      NameOfFreedom(joint, freedom), start, joint.lower[freedom], joint.upper[freedom]));
}

/// Those freedoms of a contact that friction acts along, under any load: a tube may turn hard and
/// shift freely.
SlidingContact FreedomsThatRub(const Joint& joint, const SlidingContact& contact) {
  const Wrenchd any{Vector3d::Ones(), Vector3d::Ones()};
  const Vector3d limits = FrictionLimits(joint, any, Vector3d::Zero(), Vector3d::Zero());
  int first = contact.first, end = contact.first + contact.count;
  while (first < end && limits[first] == 0) ++first;
  while (first < end && limits[end - 1] == 0) --end;
  return {first, end - first};
}

double LargestRate(const ConstrainedMotion& motion) {
  return motion.ws().v.size() == 0 ? 0 : motion.ws().v.cwiseAbs().maxCoeff();
}

}  // namespace

Contacts::Contacts(const Simulation& simulation, const KinematicTree& tree) : tree_(tree) {
  const std::vector<Joint>& joints = tree.mechanism.joints;
  for (size_t j = 0; j < joints.size(); ++j) {
    const int joint = static_cast<int>(j);
    for (const SlidingContact& contact : ContactsOf(joints[j].type)) {
      const SlidingContact freedoms = FreedomsThatRub(joints[j], contact);
      if (freedoms.count == 0) continue;
      Friction friction{joint, joints[j].type, freedoms, {}};
      for (int k = 0; k < freedoms.count; ++k) {
        friction.rows.push_back(RateRowOf(tree, {joint, freedoms.first + k}));
      }
      frictions_.push_back(friction);
    }
    if (joints[j].type == JointType::kSpherical) continue;
    for (int k = 0; k < FreedomsOf(joints[j].type); ++k) {
      const double lower = joints[j].lower[k], upper = joints[j].upper[k];
      if (std::isinf(lower) && std::isinf(upper)) continue;
      RequireInside(joints[j], k);
      const FreedomId at{joint, k};
      stops_.push_back({at, RateRowOf(tree, at), lower, upper, RestitutionAt(simulation, at)});
    }
  }
}

bool Contacts::any_held() const {
  return std::any_of(frictions_.begin(), frictions_.end(),
                     [](const Friction& friction) { return friction.rests; }) ||
         std::any_of(stops_.begin(), stops_.end(),
                     [](const Stop& stop) { return stop.closed != 0; });
}

std::vector<RateRow> Contacts::Held() const {
  std::vector<RateRow> rows;
  for (const Friction& friction : frictions_) {
    if (friction.rests) rows.insert(rows.end(), friction.rows.begin(), friction.rows.end());
  }
  for (const Stop& stop : stops_) {
    if (stop.closed != 0) rows.push_back(stop.row);
  }
  return rows;
}

void Contacts::SetSliding(ConstrainedMotion* motion) const {
  constexpr double kBegins = 1e-12;  // tells the direction until there is speed
  LoadWorkspace<double>& ws = motion->ws();
  for (Vector3d& rates : ws.sliding) rates.setZero();
  for (const Friction& friction : frictions_) {
    if (friction.rests) continue;
    const auto [first, count] = friction.freedoms;
    auto rates = ws.sliding[friction.joint].segment(first, count);
    // Of a single freedom the sign stays until the next event, so that steps may look beyond it.
    rates = friction.direction.segment(first, count);
    if (count > 1) rates = kBegins * rates + ws.loads[friction.joint].rate.segment(first, count);
  }
}

void Contacts::AddHeldForces(const ConstrainedMotion& motion, int before,
                             std::vector<Vector3d>* along) const {
  Eigen::Index row = before;
  for (const Friction& friction : frictions_) {
    for (int k = 0; friction.rests && k < friction.freedoms.count; ++k) {
      (*along)[friction.joint][friction.freedoms.first + k] += motion.held_forces()[row++];
    }
  }
  for (const Stop& stop : stops_) {
    if (stop.closed == 0) continue;
    (*along)[stop.at.joint][stop.at.freedom] += motion.held_forces()[row++];
  }
}

void Contacts::Watch(const ConstrainedMotion& motion) {
  for (Friction& friction : frictions_) friction.last = motion.ws().loads[friction.joint].rate;
}

bool Contacts::ComesToRest(const ConstrainedMotion& motion) const {
  const double rounding = 1e-15 * LargestRate(motion);
  return std::any_of(frictions_.begin(), frictions_.end(), [&](const Friction& friction) {
    if (friction.rests) return false;
    const auto [first, count] = friction.freedoms;
    const Vector3d& rate = motion.ws().loads[friction.joint].rate;
    const Vector3d& way = count == 1 ? friction.direction : friction.last;
    // Rounding may have left it behind its way; then it must go further back.
    const double from = std::min(0.0, Along(way, friction.last, friction.freedoms));
    const double size = way.segment(first, count).norm();
    return Along(way, rate, friction.freedoms) < from - rounding * size;
  });
}

std::vector<Contacts::Hit> Contacts::FindHits(const ConstrainedMotion& motion) const {
  std::vector<Hit> hits;
  for (size_t i = 0; i < stops_.size(); ++i) {
    const Stop& stop = stops_[i];
    if (stop.closed != 0) continue;
    const double position = PositionOf(motion, stop.at), rate = RateOf(motion, stop.at);
    if (position >= stop.upper && rate > 0)
      hits.push_back({i, stop.row, -stop.restitution * rate, 1});
    if (position <= stop.lower && rate < 0)
      hits.push_back({i, stop.row, -stop.restitution * rate, -1});
  }
  return hits;
}

bool Contacts::PassesLimit(const ConstrainedMotion& motion) const {
  return !FindHits(motion).empty();
}

template <typename Visit>
void Contacts::ForEachHeld(const Visit& visit) {
  for (Friction& friction : frictions_) {
    if (friction.rests) visit(&friction, static_cast<Stop*>(nullptr));
  }
  for (Stop& stop : stops_) {
    if (stop.closed != 0) visit(static_cast<Friction*>(nullptr), &stop);
  }
}

std::vector<HeldContact> Contacts::HeldContacts(const ConstrainedMotion& motion, int before) const {
  std::vector<HeldContact> held;
  for (int i = 0; i < before; ++i) held.push_back({HeldContact::Kind::kGiven, i, 1});
  int row = before;
  for (const Friction& friction : frictions_) {
    if (!friction.rests) continue;
    const auto [first, count] = friction.freedoms;
    const JointLoad<double>& load = motion.ws().loads[friction.joint];
    const Vector3d limits = FrictionLimits(tree_.mechanism.joints[friction.joint], load.W_F,
                                           load.position, Vector3d::Zero());
    HeldContact contact{HeldContact::Kind::kFriction, row, count};
    contact.limits.head(count) = limits.segment(first, count);
    held.push_back(contact);
    row += count;
  }
  for (const Stop& stop : stops_) {
    if (stop.closed == 0) continue;
    held.push_back({HeldContact::Kind::kStop, row++, 1, Vector3d::Zero(), stop.closed});
  }
  return held;
}

ContactForces Contacts::Solve(const ConstrainedMotion& motion, int before) {
  constexpr double kNoInertia = 1e-13;
  MatrixXd A = motion.inertia();
  A.diagonal().array() += kNoInertia * A.diagonal().maxCoeff();
  const Eigen::LDLT<MatrixXd> factors(A);
  const MatrixXd& B = motion.held_motions();
  const MatrixXd W = B * factors.solve(B.transpose());
  const VectorXd b = B * factors.solve(motion.driving()) - motion.held_slopes();
  if (forces_.size() != b.size()) forces_ = VectorXd::Zero(b.size());
  const ContactForces solved = SolveContacts(W, b, HeldContacts(motion, before), forces_);
  forces_ = solved.F;
  ContactForces result = solved;
  // What is rounding beside the slopes that there would be is none.
  const double least =
      kNoSlope * (b.cwiseAbs().maxCoeff() + motion.held_slopes().cwiseAbs().maxCoeff());
  for (double& u : result.u) u = std::abs(u) <= least ? 0 : u;
  return result;
}

bool Contacts::Releases(const ConstrainedMotion& motion, int before) {
  if (!any_held()) return false;
  return !Solve(motion, before).u.tail(static_cast<Eigen::Index>(Held().size())).isZero(0);
}

bool Contacts::Release(const ConstrainedMotion& motion, int before) {
  if (!any_held()) return false;
  const VectorXd u = Solve(motion, before).u;
  Eigen::Index row = before;
  bool released = false;
  ForEachHeld([&](Friction* friction, Stop* stop) {
    const int count = friction ? friction->freedoms.count : 1;
    const auto slopes = u.segment(row, count);
    row += count;
    if (slopes.isZero(0)) return;
    released = true;
    if (stop) stop->closed = 0;
    if (!friction) return;
    friction->rests = false;
    friction->direction.setZero();
    friction->direction.segment(friction->freedoms.first, count) = slopes.normalized();
    friction->last = friction->direction;
  });
  return released;
}

void Contacts::HoldAllAtRest(const ConstrainedMotion& motion) {
  const double slowest = kNoRate * (1 + LargestRate(motion));
  for (Friction& friction : frictions_) {
    const auto [first, count] = friction.freedoms;
    Vector3d rate = Vector3d::Zero();
    rate.segment(first, count) = motion.ws().loads[friction.joint].rate.segment(first, count);
    const Vector3d sliding = SlidingRates(friction.type, rate, slowest, tree_.length);
    friction.rests = sliding.segment(first, count).isZero(0);
    friction.direction.setZero();
    if (friction.rests) continue;
    friction.direction.segment(first, count) = rate.segment(first, count).normalized();
    friction.last = rate;
  }
  for (Stop& stop : stops_) {
    if (std::abs(RateOf(motion, stop.at)) > slowest) continue;
    const double position = PositionOf(motion, stop.at);
    if (position >= stop.upper - kAtLimit) stop.closed = 1;
    if (position <= stop.lower + kAtLimit) stop.closed = -1;
  }
}

void Contacts::ReleaseFriction() {
  for (Friction& friction : frictions_) friction.rests = false;
}

void Contacts::OpenLimits() {
  for (Stop& stop : stops_) stop.closed = 0;
}

void Contacts::Compare(const Contacts& after, double time, const ConstrainedMotion& motion,
                       std::vector<SimulationEvent>* events) const {
  using Kind = SimulationEvent::Kind;
  const auto add = [&](Kind kind, const FreedomId& at) {
    events->push_back({time, kind, at, PositionOf(motion, at), RateOf(motion, at)});
  };
  for (size_t i = 0; i < frictions_.size(); ++i) {
    const Friction& now = after.frictions_[i];
    const FreedomId at{now.joint, now.freedoms.first};
    if (now.rests != frictions_[i].rests) add(now.rests ? Kind::kSticks : Kind::kSlips, at);
  }
  for (size_t i = 0; i < stops_.size(); ++i) {
    const int closed = after.stops_[i].closed;
    if (closed == stops_[i].closed) continue;
    add(closed != 0 ? Kind::kLimitCloses : Kind::kLimitOpens, stops_[i].at);
  }
}

}  // namespace vmech
