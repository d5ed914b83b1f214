#include "vmech/dynamics/simulation/rough_places.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "vmech/dynamics/rigid_body/passive.h"
#include "vmech/mechanisms/joint_type.h"

namespace vmech {
namespace {

bool FindSlopes(EquationsOfMotion* equations, double time, const VectorXd& y, VectorXd* slopes) {
  slopes->resize(y.size());
  return equations->Slopes(time, y.data(), slopes->data());
}

/// Beside this any speed counts [1/s].
constexpr double kSlowest = 1e-9;

/// By the fourth-order rule of Runge and Kutta, to `time` from a step later.
bool StepBack(EquationsOfMotion* equations, double time, double step, const VectorXd& k1,
              VectorXd* y) {
  VectorXd k2, k3, k4;
  const double middle = time + 0.5 * step;
  const bool found = FindSlopes(equations, middle, *y - 0.5 * step * k1, &k2) &&
                     FindSlopes(equations, middle, *y - 0.5 * step * k2, &k3) &&
                     FindSlopes(equations, time, *y - step * k3, &k4);
  if (found) *y -= step / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  return found;
}

/// The way to where loops lose rank.
struct Approach {
  double time_left = 0;   ///< [s]; none if loops do not lose rank ahead
  double pivot = 0;       ///< here
  double speed = 0;       ///< of the fastest freedom [1/s]
  VectorXd slopes;        ///< here
  VectorXd their_slopes;  ///< [1/s]
};

/// The pivot is the square of a distance, and a parabola of time near a singular pose: is there one
/// ahead at which it vanishes?
bool FindSingularPose(EquationsOfMotion* equations, double time, const VectorXd& y,
                      Approach* approach) {
  constexpr double kShare = 0.25;  // of the distance, as freedoms move
  constexpr double kVanishes = 1e-8, kOfItself = 0.05;
  VectorXd behind = y, slopes;
  if (!FindSlopes(equations, time, y, &approach->slopes)) return false;
  const double here = approach->pivot = equations->motion().smallest_pivot();
  approach->speed = std::max(equations->motion().ws().v.lpNorm<Eigen::Infinity>(), kSlowest);
  const double step = kShare * std::sqrt(here) / approach->speed;
  double pivots[2];
  for (int k = 0; k < 2; ++k) {
    const VectorXd& from = k == 0 ? approach->slopes : slopes;
    if (!StepBack(equations, time - (k + 1) * step, step, VectorXd(from), &behind)) return false;
    if (!FindSlopes(equations, time - (k + 1) * step, behind, &slopes)) return false;
    pivots[k] = equations->motion().smallest_pivot();
    if (k == 0) approach->their_slopes = (approach->slopes - slopes) / step;
  }
  const double rate = (3 * here - 4 * pivots[0] + pivots[1]) / (2 * step);
  const double bend = (here - 2 * pivots[0] + pivots[1]) / (step * step);
  if (!(rate < 0 && bend > 0)) return false;
  approach->time_left = -rate / bend;
  return here - 0.5 * rate * rate / bend < std::max(kVanishes, kOfItself * here);
}

/// From y over `step`. False if its stages do not settle, or meet a singular pose.
bool Collocate(EquationsOfMotion* equations, double time, const Approach& approach,
               const VectorXd& y, Leap* leap) {
  constexpr int kIterations = 20;
  constexpr double kSettled = 1e-14, kRounding = 1e-8;  // of the state
  VectorXd stage = y, slopes;
  leap->slopes[0] = approach.slopes;
  for (int i = 1; i < Leap::kStages; ++i) {
    const double ahead = Leap::kAt[i] * leap->step;
    leap->slopes[i] = approach.slopes + ahead * approach.their_slopes;
  }
  double before = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    double change = 0;
    for (int i = 1; i < Leap::kStages; ++i) {
      const double at = time + Leap::kAt[i] * leap->step;
      leap->At(at, &stage);
      if (!FindSlopes(equations, at, stage, &slopes)) return false;
      const double fastest = equations->motion().ws().v.lpNorm<Eigen::Infinity>();
      change = std::max(change, leap->step * (slopes - leap->slopes[i]).lpNorm<Eigen::Infinity>() /
                                    std::max(fastest, kSlowest));
      leap->slopes[i] = slopes;
    }
    if (change < kSettled || (change < kRounding && change > 0.5 * before)) return true;
    before = change;
  }
  return false;
}

/// The shortest one that settles and ends no nearer to where loops lose rank than it begins.
std::optional<Leap> ShortestLeap(EquationsOfMotion* equations, double time,
                                 const Approach& approach, const VectorXd& y) {
  constexpr double kLongest = 0.05;            // [rad]
  constexpr double kFirst = 2.2, kMore = 1.3;  // of the way to the pose
  Leap leap{time, kFirst * approach.time_left, y, {}};
  for (; leap.step * approach.speed < kLongest; leap.step *= kMore) {
    const bool settles = Collocate(equations, time, approach, y, &leap);
    if (settles && equations->motion().smallest_pivot() >= approach.pivot) return leap;
  }
  return std::nullopt;
}

/// Loops that only nearly lose rank part next to the pose: a leap over them would lead through what
/// they do not allow.
bool StaysOnLoops(EquationsOfMotion* equations, const Approach& approach, const Leap& leap) {
  constexpr double kClosed = 1e-8;
  const double time = leap.from + approach.time_left;
  VectorXd y;
  leap.At(time, &y);
  const double* const v = y.data() + equations->tree().nq;
  equations->TakeState(time, y.data(), v, v);
  return equations->motion().closure() <= kClosed;
}

/// Does anything act against velocities? Nothing decays in a mechanism that keeps its energy: what
/// looks like it for a while is how its inertia changes as it moves.
bool Decays(const Simulation& simulation) {
  const std::vector<Joint>& joints = simulation.mechanism.joints;
  const auto damps = [](const Passive& passive) { return passive.viscous != 0; };
  return simulation.hand || HasDryFriction(simulation.mechanism) ||
         std::any_of(simulation.motors.begin(), simulation.motors.end(),
                     [](const JointMotor& motor) { return motor.damping != 0; }) ||
         std::any_of(joints.begin(), joints.end(), [&](const Joint& joint) {
           return std::any_of(joint.passive.begin(), joint.passive.end(), damps);
         });
}

}  // namespace

void Leap::At(double time, VectorXd* y) const {
  // Integrals of the polynomials that are 1 at one stage and 0 at the others.
  const double x = (time - from) / step;
  for (int i = 0; i < kStages; ++i) {
    double c[kStages] = {1, 0, 0, 0}, size = 1;
    int degree = 0;
    for (int j = 0; j < kStages; ++j) {
      if (j == i) continue;
      for (int k = ++degree; k > 0; --k) c[k] = c[k - 1] - kAt[j] * c[k];
      c[0] *= -kAt[j];
      size *= kAt[i] - kAt[j];
    }
    double integral = 0;
    for (int k = kStages; k-- > 0;) integral = x * (c[k] / (k + 1) + integral);
    if (i == 0) *y = start;
    *y += step * integral / size * slopes[i];
  }
}

bool NearSingularPose(EquationsOfMotion& equations, double step) {
  constexpr double kNextTo = 1e-4, kInReach = 1e-3, kCreeps = 0.1;
  if (equations.tree().loops.empty()) return false;
  const double pivot = equations.motion().smallest_pivot();
  const double moved = step * equations.motion().ws().v.lpNorm<Eigen::Infinity>();
  return pivot < kNextTo || (pivot < kInReach && moved < kCreeps * std::sqrt(pivot));
}

std::optional<Leap> LeapOverSingularPose(double time, const VectorXd& y,
                                         EquationsOfMotion* equations) {
  Approach approach;
  if (!FindSingularPose(equations, time, y, &approach)) return std::nullopt;
  // Far from the pose accelerations are known best; where they do not settle, nearer.
  for (const bool nearest : {false, true}) {
    equations->ComeNearest(nearest);
    std::optional<Leap> leap = ShortestLeap(equations, time, approach, y);
    equations->ComeNearest(false);
    if (leap) return StaysOnLoops(equations, approach, *leap) ? leap : std::nullopt;
  }
  return std::nullopt;
}

std::string DescribePlace(double time, const VectorXd& y, const DisplayUnits& units,
                          EquationsOfMotion* equations) {
  constexpr double kNextTo = 1e-5, kBeyondBounds = 1e5;
  constexpr size_t kShown = 12;  // joints
  const KinematicTree& tree = equations->tree();
  const double* const v = y.data() + tree.nq;
  const bool settles = equations->Evaluate(time, y.data(), v);
  equations->Place(time, y.data(), v);
  const LoadWorkspace<double>& ws = equations->motion().ws();
  std::string text = "the accelerations change faster than steps can follow";
  if (!settles) {
    text = "friction in proportion to loads has no equilibrium: the mechanism locks";
  } else if (!tree.loops.empty() && equations->motion().smallest_pivot() < kNextTo) {
    text = "its loops lose rank: at this pose they do not decide how it moves on";
  } else if (tree.nv > 0 && ws.v.lpNorm<Eigen::Infinity>() > kBeyondBounds) {
    text = "it moves beyond all bounds";
  }
  text += ". There";
  const std::vector<Joint>& joints = tree.mechanism.joints;
  for (size_t j = 0, shown = 0; j < joints.size() && shown < kShown; ++j) {
    if (joints[j].type == JointType::kSpherical) continue;
    for (int k = 0; k < FreedomsOf(joints[j].type); ++k, ++shown) {
      text += fmt::format("{} {} is at {}", shown > 0 ? "," : "", NameOfFreedom(joints[j], k),
                          FormatCoordinate(units, joints[j], k, ws.loads[j].position[k]));
    }
  }
  return text;
}

double FastestDecay(double time, const VectorXd& y, EquationsOfMotion* equations) {
  constexpr int kIterations = 20;
  constexpr double kShare = 1e-7, kSlowest = 1e-6, kNearlyReal = 0.2;
  const Eigen::Index moving = y.size() - 2;  // energies do not act on anything
  VectorXd here(y.size()), there(y.size()), moved = y;
  if (!equations->Slopes(time, y.data(), here.data())) return 0;
  // Friction of several freedoms turns with their rates: a move is small beside these.
  const double speed = equations->motion().ws().v.lpNorm<Eigen::Infinity>();
  const double move = kShare * std::clamp(speed, kSlowest, 1.0);
  VectorXd d = here.head(moving);
  double rate = 0;
  for (int i = 0; i < kIterations && d.norm() > 0; ++i) {
    d.normalize();
    moved.head(moving) = y.head(moving) + move * d;
    if (!equations->Slopes(time, moved.data(), there.data())) return 0;
    const VectorXd Jd = (there - here).head(moving) / move;
    rate = d.dot(Jd);
    const bool real = (Jd - rate * d).norm() < kNearlyReal * std::abs(rate);
    if (!real) rate = 0;
    d = Jd;
  }
  return std::max(0.0, -rate);
}

StiffnessWatch::StiffnessWatch(const Simulation& simulation) : decays_(Decays(simulation)) {}

bool StiffnessWatch::Limits(long steps, double time, const VectorXd& y,
                            EquationsOfMotion* equations) {
  constexpr double kShort = 0.3;
  if (!decays_ || steps < next_look_) return false;
  const double step = (time - last_look_) / static_cast<double>(steps - looked_at_);
  last_look_ = time;
  looked_at_ = steps;
  next_look_ = 2 * steps;
  return FastestDecay(time, y, equations) * step >= kShort;
}

}  // namespace vmech
