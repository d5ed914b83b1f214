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

/// Those freedoms of a contact that friction acts along, under any load.
std::vector<int> FreedomsThatRub(const Joint& joint, const SlidingContact& contact) {
  const Wrenchd any{Vector3d::Ones(), Vector3d::Ones()};
  const Vector3d limits = FrictionLimits(joint, any, Vector3d::Zero(), Vector3d::Zero());
  std::vector<int> freedoms;
  for (int k = contact.first; k < contact.first + contact.count; ++k) {
    if (limits[k] != 0) freedoms.push_back(k);
  }
  return freedoms;
}

double LargestRate(const ConstrainedMotion& motion) {
  return motion.ws().v.size() == 0 ? 0 : motion.ws().v.lpNorm<Eigen::Infinity>();
}

}  // namespace

Contacts::Contacts(const Simulation& simulation, const KinematicTree& tree) : tree_(tree) {
  const std::vector<Joint>& joints = tree.mechanism.joints;
  for (size_t j = 0; j < joints.size(); ++j) {
    const int joint = static_cast<int>(j);
    for (const SlidingContact& contact : ContactsOf(joints[j].type)) {
      const std::vector<int> freedoms = FreedomsThatRub(joints[j], contact);
      if (freedoms.empty()) continue;
      Friction friction{joint, joints[j].type, freedoms, {}};
      for (const int k : freedoms) friction.rows.push_back(RateRowOf(tree, {joint, k}));
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

Vector3d Contacts::Friction::RatesIn(const ConstrainedMotion& motion) const {
  Vector3d rates = Vector3d::Zero();
  for (const int k : freedoms) rates[k] = motion.ws().loads[joint].rate[k];
  return rates;
}

bool Contacts::any_held() const {
  return std::any_of(frictions_.begin(), frictions_.end(),
                     [](const Friction& friction) { return friction.rests; }) ||
         std::any_of(stops_.begin(), stops_.end(),
                     [](const Stop& stop) { return stop.closed != 0; });
}

std::vector<FreedomId> Contacts::Limited() const {
  std::vector<FreedomId> limited;
  for (const Stop& stop : stops_) limited.push_back(stop.at);
  return limited;
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
  if (frictions_.empty()) return;
  LoadWorkspace<double>& ws = motion->ws();
  for (Vector3d& rates : ws.sliding) rates.setZero();
  for (const Friction& friction : frictions_) {
    if (friction.rests) continue;
    // Of a single freedom the sign stays until the next event, so that steps may look beyond it.
    Vector3d rates = friction.direction;
    if (friction.freedoms.size() > 1) rates = kBegins * rates + friction.RatesIn(*motion);
    ws.sliding[friction.joint] += rates;
  }
}

void Contacts::AddHeldForces(const ConstrainedMotion& motion, int before,
                             std::vector<Vector3d>* along) const {
  Eigen::Index row = before;
  for (const Friction& friction : frictions_) {
    if (!friction.rests) continue;
    for (const int k : friction.freedoms)
      (*along)[friction.joint][k] += motion.held_forces()[row++];
  }
  for (const Stop& stop : stops_) {
    if (stop.closed == 0) continue;
    (*along)[stop.at.joint][stop.at.freedom] += motion.held_forces()[row++];
  }
}

void Contacts::Watch(const ConstrainedMotion& motion) {
  for (Friction& friction : frictions_) friction.last = friction.RatesIn(motion);
}

bool Contacts::ComesToRest(const ConstrainedMotion& motion) const {
  const double rounding = 1e-15 * LargestRate(motion);
  return std::any_of(frictions_.begin(), frictions_.end(), [&](const Friction& friction) {
    if (friction.rests) return false;
    const Vector3d& way = friction.freedoms.size() == 1 ? friction.direction : friction.last;
    // Rounding may have left it behind its way; then it must go further back.
    const double from = std::min(0.0, way.dot(friction.last));
    return way.dot(friction.RatesIn(motion)) < from - rounding * way.norm();
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
    const int count = static_cast<int>(friction.freedoms.size());
    const JointLoad<double>& load = motion.ws().loads[friction.joint];
    const Vector3d limits = FrictionLimits(tree_.mechanism.joints[friction.joint], load.W_F,
                                           load.position, Vector3d::Zero());
    HeldContact contact{HeldContact::Kind::kFriction, row, count};
    for (int k = 0; k < count; ++k) contact.limits[k] = limits[friction.freedoms[k]];
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
      kNoSlope * (b.lpNorm<Eigen::Infinity>() + motion.held_slopes().lpNorm<Eigen::Infinity>());
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
    const Eigen::Index count = friction ? std::ssize(friction->freedoms) : 1;
    const VectorXd slopes = u.segment(row, count);
    row += count;
    if (slopes.isZero(0)) return;
    released = true;
    if (stop) stop->closed = 0;
    if (!friction) return;
    friction->rests = false;
    friction->direction.setZero();
    friction->direction(friction->freedoms) = slopes.normalized();
    friction->last = friction->direction;
  });
  return released;
}

void Contacts::HoldAllAtRest(const ConstrainedMotion& motion) {
  const double slowest = kNoRate * (1 + LargestRate(motion));
  for (Friction& friction : frictions_) {
    friction.last = friction.RatesIn(motion);
    friction.rests = SlidingRates(friction.type, friction.last, slowest, tree_.length).isZero(0);
    friction.direction.setZero();
    if (!friction.rests) friction.direction = friction.last.normalized();
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
    const FreedomId at{now.joint, now.freedoms.front()};
    if (now.rests != frictions_[i].rests) add(now.rests ? Kind::kSticks : Kind::kSlips, at);
  }
  for (size_t i = 0; i < stops_.size(); ++i) {
    const int closed = after.stops_[i].closed;
    if (closed == stops_[i].closed) continue;
    add(closed != 0 ? Kind::kLimitCloses : Kind::kLimitOpens, stops_[i].at);
  }
}

}  // namespace vmech
