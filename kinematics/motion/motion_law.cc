#include "vmech/kinematics/motion/motion_law.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "vmech/base/rotation_error.h"
#include "vmech/kinematics/motion/table_dwells.h"

namespace vmech {
namespace {

void RequireTable(const std::vector<double>& times, size_t values) {
  if (times.empty()) throw std::invalid_argument("the table has no rows");
  if (times.size() != values) {
    throw std::invalid_argument(
        fmt::format("the table has {} times and {} values", times.size(), values));
  }
  for (size_t i = 0; i < times.size(); ++i) {
    if (!std::isfinite(times[i])) {
      throw std::invalid_argument(fmt::format("row {}: the time is not a finite number", i + 1));
    }
    if (i > 0 && !(times[i] > times[i - 1])) {
      throw std::invalid_argument(
          fmt::format("row {}: the time {} does not come after {}", i + 1, times[i], times[i - 1]));
    }
  }
}

void RequireFinite(const std::vector<double>& values) {
  for (size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) {
      throw std::invalid_argument(fmt::format("row {}: the value is not a finite number", i + 1));
    }
  }
}

/// The equations of the second derivatives M at the knots of a cubic spline,
///   h[i-1] M[i-1] + 2 (h[i-1] + h[i]) M[i] + h[i] M[i+1] = 6 (slope[i] - slope[i-1]),
/// and at an end at rest  2 h M[0] + h M[1] = 6 slope[0].
struct SplineEquations {
  std::vector<double> below, diagonal, above, right;
};

SplineEquations EquationsOfSpline(const std::vector<double>& h, const std::vector<double>& slope) {
  const size_t n = h.size() + 1;
  SplineEquations s;
  for (auto* list : {&s.below, &s.diagonal, &s.above, &s.right}) list->resize(n);
  for (size_t i = 1; i + 1 < n; ++i) {
    s.below[i] = h[i - 1];
    s.diagonal[i] = 2 * (h[i - 1] + h[i]);
    s.above[i] = h[i];
    s.right[i] = 6 * (slope[i] - slope[i - 1]);
  }
  s.diagonal[0] = 2 * h[0];
  s.above[0] = h[0];
  s.right[0] = 6 * slope[0];
  s.below[n - 1] = h[n - 2];
  s.diagonal[n - 1] = 2 * h[n - 2];
  s.right[n - 1] = -6 * slope[n - 2];
  return s;
}

/// M at the knots; an end that does not rest is not a knot, that is, third derivatives are equal on
/// either side of the second and last but one knot. Four knots or more, or three with an end at
/// rest, or two with both.
std::vector<double> SplineCurvatures(const std::vector<double>& t, const std::vector<double>& y,
                                     bool rests_before, bool rests_after) {
  const size_t n = t.size();
  std::vector<double> h(n - 1), slope(n - 1);
  for (size_t i = 0; i + 1 < n; ++i) {
    h[i] = t[i + 1] - t[i];
    slope[i] = (y[i + 1] - y[i]) / h[i];
  }
  SplineEquations s = EquationsOfSpline(h, slope);
  const double head = rests_before ? 0 : h[0] / h[1], tail = rests_after ? 0 : h[n - 2] / h[n - 3];
  if (!rests_before) {  // M[0] = (1 + head) M[1] - head M[2]
    s.diagonal[1] += h[0] * (1 + head);
    s.above[1] -= h[0] * head;
  }
  if (!rests_after) {
    s.diagonal[n - 2] += h[n - 2] * (1 + tail);
    s.below[n - 2] -= h[n - 2] * tail;
  }
  const size_t first = rests_before ? 0 : 1, last = rests_after ? n - 1 : n - 2;
  for (size_t i = first + 1; i <= last; ++i) {
    const double factor = s.below[i] / s.diagonal[i - 1];
    s.diagonal[i] -= factor * s.above[i - 1];
    s.right[i] -= factor * s.right[i - 1];
  }
  std::vector<double> M(n);
  M[last] = s.right[last] / s.diagonal[last];
  for (size_t i = last; i-- > first;) M[i] = (s.right[i] - s.above[i] * M[i + 1]) / s.diagonal[i];
  if (!rests_before) M[0] = (1 + head) * M[1] - head * M[2];
  if (!rests_after) M[n - 1] = (1 + tail) * M[n - 2] - tail * M[n - 3];
  return M;
}

std::vector<double> Curvatures(const std::vector<double>& t, const std::vector<double>& y,
                               bool rests_before, bool rests_after) {
  if (t.size() > 3) return SplineCurvatures(t, y, rests_before, rests_after);
  if (t.size() == 3) {
    if (rests_before || rests_after) return SplineCurvatures(t, y, rests_before, rests_after);
    const double bend =
        ((y[2] - y[1]) / (t[2] - t[1]) - (y[1] - y[0]) / (t[1] - t[0])) / (t[2] - t[0]);
    return std::vector<double>(3, 2 * bend);
  }
  if (rests_before && rests_after) return SplineCurvatures(t, y, true, true);
  if (!rests_before && !rests_after) return std::vector<double>(t.size(), 0.0);
  const double bend = 2 * (y[1] - y[0]) / ((t[1] - t[0]) * (t[1] - t[0]));  // a parabola
  return std::vector<double>(2, rests_before ? bend : -bend);
}

/// Angular velocity and acceleration, in the moving frame, of exp(r(t)) from r, r', r'':
///   w = J r',  J = 1 - A S + B S^2,  A = (1 - cos)/angle^2,  B = (angle - sin)/angle^3,  S = S(r)
///   w' = J r'' - A' r x r' + B' r x (r x r') + B r' x (r x r')
struct RotationRates {
  Vector3d w, alpha;
};

RotationRates RatesOfRotationVector(const Vector3d& r, const Vector3d& rd, const Vector3d& rdd) {
  constexpr double kSmall = 1e-2;  // [rad]; below, the next terms of the series are under 1e-12
  const double x = r.norm(), xx = x * x;
  double A, B, dA, dB;  // dA = (dA/dx)/x, likewise dB
  if (x < kSmall) {
    A = 1.0 / 2 - xx / 24 + xx * xx / 720;
    B = 1.0 / 6 - xx / 120 + xx * xx / 5040;
    dA = -1.0 / 12 + xx / 180;
    dB = -1.0 / 60 + xx / 1260;
  } else {
    A = (1 - std::cos(x)) / xx;
    B = (x - std::sin(x)) / (xx * x);
    dA = (x * std::sin(x) - 2 * (1 - std::cos(x))) / (xx * xx);
    dB = (3 * std::sin(x) - 2 * x - x * std::cos(x)) / (xx * xx * x);
  }
  const Vector3d r_rd = r.cross(rd);
  const double stretch = r.dot(rd);
  auto J = [&](const Vector3d& u) -> Vector3d {
    return u - A * r.cross(u) + B * r.cross(r.cross(u));
  };
  return {J(rd), J(rdd) - dA * stretch * r_rd + dB * stretch * r.cross(r_rd) + B * rd.cross(r_rd)};
}

}  // namespace

MotionLaw MotionLaw::Uniform(double start, double speed, double acceleration) {
  if (!std::isfinite(start) || !std::isfinite(speed) || !std::isfinite(acceleration)) {
    throw std::invalid_argument(fmt::format(
        "a drive without a table: start = {}, speed = {}, acceleration = {}; all must be finite",
        start, speed, acceleration));
  }
  MotionLaw law;
  law.pieces_.push_back({0, 0, {start, speed, acceleration / 2, 0}});
  return law;
}

MotionLaw MotionLaw::Table(const std::vector<double>& times, const std::vector<double>& values) {
  RequireTable(times, values.size());
  RequireFinite(values);
  return TableWithDwells(times, values, FindDwells(times, {values}));
}

MotionLaw MotionLaw::TableWithDwells(const std::vector<double>& times,
                                     const std::vector<double>& values,
                                     const std::vector<bool>& dwells) {
  MotionLaw law;
  law.roughness_ = FindRoughness(times, values);
  const size_t last = times.size() - 1;
  if (last == 0) return Uniform(values[0], 0);
  law.begins_ = times.front();
  law.ends_ = times.back();
  for (size_t i = 0; i < last;) {
    const size_t first = i;
    const bool dwells_here = dwells[i];
    while (i < last && dwells[i] == dwells_here) ++i;
    const auto part = [&](const std::vector<double>& all) {
      return std::vector<double>(all.begin() + static_cast<std::ptrdiff_t>(first),
                                 all.begin() + static_cast<std::ptrdiff_t>(i + 1));
    };
    if (dwells_here) {
      law.pieces_.push_back({times[first], times[first], {values[first], 0, 0, 0}});
    } else {
      law.AddSpline(part(times), part(values), first > 0, i < last);
    }
  }
  return law;
}

/// Appends the spline through some rows, from or into a dwell where it rests.
void MotionLaw::AddSpline(const std::vector<double>& times, const std::vector<double>& values,
                          bool rests_before, bool rests_after) {
  const std::vector<double> M = Curvatures(times, values, rests_before, rests_after);
  for (size_t i = 0; i + 1 < times.size(); ++i) {
    const bool leaves_rest = i == 0 && rests_before;
    const double h = times[i + 1] - times[i];
    const double slope = (values[i + 1] - values[i]) / h - h * (2 * M[i] + M[i + 1]) / 6;
    // The last row of a dwell belongs to the dwell.
    const double from =
        leaves_rest ? std::nextafter(times[i], std::numeric_limits<double>::infinity()) : times[i];
    pieces_.push_back(
        {from,
         times[i],
         {values[i], leaves_rest ? 0 : slope, M[i] / 2, (M[i + 1] - M[i]) / (6 * h)}});
  }
}

MotionSample MotionLaw::At(double t) const {
  auto after = std::upper_bound(pieces_.begin(), pieces_.end(), t,
                                [](double time, const Piece& piece) { return time < piece.from; });
  const Piece& piece = after == pieces_.begin() ? pieces_.front() : *(after - 1);
  const double s = t - piece.t0;
  const double* c = piece.c;
  return {c[0] + s * (c[1] + s * (c[2] + s * c[3])), c[1] + s * (2 * c[2] + s * 3 * c[3]),
          2 * c[2] + 6 * c[3] * s};
}

HandLaw HandLaw::Table(const std::vector<double>& times, const std::vector<Posed>& poses) {
  RequireTable(times, poses.size());
  HandLaw law;
  law.R_W0_ = poses[0].R;
  std::vector<std::vector<double>> p(3), r(3);
  for (size_t i = 0; i < poses.size(); ++i) {
    const Eigen::AngleAxisd turn(Matrix3d(poses[0].R.transpose() * poses[i].R));
    constexpr double kTooFar = 0.99 * std::numbers::pi;  // the rotation vector jumps at pi
    if (turn.angle() > kTooFar) {
      throw std::invalid_argument(fmt::format(
          "row {}: the orientation is {:.1f} degrees away from that of the first row; split the "
          "table before 178 degrees",
          i + 1, turn.angle() * 180 / std::numbers::pi));
    }
    const Vector3d rotation_vector = turn.angle() * turn.axis();
    for (int k = 0; k < 3; ++k) {
      p[k].push_back(poses[i].p[k]);
      r[k].push_back(rotation_vector[k]);
    }
  }
  for (const auto* columns : {&p, &r}) {
    for (const std::vector<double>& column : *columns) RequireFinite(column);
  }
  const std::vector<bool> halts = FindDwells(times, p), stops = FindDwells(times, r);
  for (int k = 0; k < 3; ++k) {
    law.position_.push_back(MotionLaw::TableWithDwells(times, p[k], halts));
    law.rotation_vector_.push_back(MotionLaw::TableWithDwells(times, r[k], stops));
  }
  return law;
}

TableRoughness HandLaw::Together(const std::vector<MotionLaw>& axes) {
  TableRoughness together;
  for (const MotionLaw& axis : axes) {
    together.acceleration = std::hypot(together.acceleration, axis.roughness().acceleration);
    together.noise = std::hypot(together.noise, axis.roughness().noise);
  }
  return together;
}

HandSample HandLaw::At(double t) const {
  Vector3d p, v, a, r, rd, rdd;
  for (int k = 0; k < 3; ++k) {
    const MotionSample s = position_[k].At(t);
    const MotionSample u = rotation_vector_[k].At(t);
    p[k] = s.position, v[k] = s.velocity, a[k] = s.acceleration;
    r[k] = u.position, rd[k] = u.velocity, rdd[k] = u.acceleration;
  }
  HandSample hand;
  hand.X_WH = {R_W0_ * RotationBy(r), p};
  const RotationRates rates = RatesOfRotationVector(r, rd, rdd);
  hand.V_WH << v, hand.X_WH.R * rates.w;
  hand.A_WH << a, hand.X_WH.R * rates.alpha;
  return hand;
}

}  // namespace vmech
