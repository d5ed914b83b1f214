#include "vmech/dynamics/simulation/rough_places.h"

#include <algorithm>
#include <cmath>

namespace vmech {
namespace {

bool FindSlopes(EquationsOfMotion* equations, double time, const VectorXd& y, VectorXd* slopes) {
  slopes->resize(y.size());
  return equations->Slopes(time, y.data(), slopes->data());
}

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

}  // namespace

bool NearSingularPose(EquationsOfMotion& equations, double step) {
  constexpr double kNextTo = 1e-7, kInReach = 1e-6, kCreeps = 0.1;
  if (equations.tree().loops.empty()) return false;
  const double pivot = equations.motion().smallest_pivot();
  const double moved = step * equations.motion().ws().v.cwiseAbs().maxCoeff();
  return pivot < kNextTo || (pivot < kInReach && moved < kCreeps * std::sqrt(pivot));
}

bool LeapOverSingularPose(double end, EquationsOfMotion* equations, double* time, VectorXd* y) {
  constexpr double kShortest = 1e-6, kLongest = 4e-3;  // [rad]
  VectorXd slopes[4];
  if (!FindSlopes(equations, *time, *y, &slopes[0])) return false;
  const double pivot = equations->motion().smallest_pivot();
  const double speed = std::max(equations->motion().ws().v.cwiseAbs().maxCoeff(), 1e-9);
  for (double step = kShortest / speed; step < kLongest / speed; step *= 2) {
    VectorXd behind = *y, there;
    for (int k = 1; k < 4; ++k) {
      if (!StepBack(equations, *time - k * step, step, slopes[k - 1], &behind)) return false;
      if (!FindSlopes(equations, *time - k * step, behind, &slopes[k])) return false;
    }
    behind = *y + step / 24 * (55 * slopes[0] - 59 * slopes[1] + 37 * slopes[2] - 9 * slopes[3]);
    if (*time + step > end || !FindSlopes(equations, *time + step, behind, &there)) continue;
    if (equations->motion().smallest_pivot() < pivot) continue;
    if (step == kShortest / speed) return false;  // it moves away from it
    *y = behind;
    *time += step;
    return true;
  }
  return false;
}

double FastestDecay(double time, const VectorXd& y, EquationsOfMotion* equations) {
  constexpr int kIterations = 20;
  constexpr double kShare = 1e-7, kSlowest = 1e-6, kNearlyReal = 0.2;
  const Eigen::Index moving = y.size() - 2;  // energies do not act on anything
  VectorXd here(y.size()), there(y.size()), moved = y;
  if (!equations->Slopes(time, y.data(), here.data())) return 0;
  // Friction of several freedoms turns with their rates: a move is small beside these.
  const double speed = equations->motion().ws().v.cwiseAbs().maxCoeff();
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

}  // namespace vmech
