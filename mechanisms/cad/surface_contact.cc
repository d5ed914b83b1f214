#include "vmech/mechanisms/cad/surface_contact.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace vmech {
namespace {

constexpr double kLeastOverlap = 0.1;  // of the shorter length or side
constexpr double kNear = 5;            // what misses by less than this factor is told
constexpr double kMillimetres = 1e3;   // per metre

/// How much wider a bore may be than its shaft, and how much narrower [m].
struct Fit {
  double least, greatest;
};

Fit FitOf(const CadFeature& inner, const CadFeature& outer, const ContactOptions& options) {
  const double loose = options.fastener_play * outer.radius;
  if (inner.fastens || outer.fastens) {
    return {-std::max(options.tolerance, loose), std::max(options.tolerance, loose)};
  }
  return {-options.tolerance, std::max(options.tolerance, options.clearance * outer.radius)};
}

bool RadiiFit(const CadFeature& inner, const CadFeature& outer, const ContactOptions& options) {
  const Fit fit = FitOf(inner, outer, options);
  const double play = outer.radius - inner.radius;
  return play >= fit.least - kDrawn && play <= fit.greatest + kDrawn;
}

bool AreParallel(const CadFeature& a, const CadFeature& b, double angle) {
  return AxisOf(a).cross(AxisOf(b)).norm() <= angle;
}

std::optional<SurfaceContact> CylinderContact(const CadFeature& shaft, const CadFeature& bore,
                                              const ContactOptions& options) {
  if (!RadiiFit(shaft, bore, options) || !AreParallel(shaft, bore, kParallelAxes)) return {};
  if (DistanceFromAxis(shaft.X_PF.p, bore) > options.tolerance + kDrawn) return std::nullopt;
  const auto stretch = SharedStretch(shaft, bore);
  if (!stretch) return std::nullopt;
  SurfaceContact contact;
  contact.surface = CadSurface::kShaft;
  contact.axis_W = AxisOf(shaft);
  contact.p_W = shaft.X_PF.p + 0.5 * (stretch->first + stretch->second) * contact.axis_W;
  contact.radius = shaft.radius;
  contact.gap = bore.radius - shaft.radius;
  contact.length = stretch->second - stretch->first;
  return contact;
}

std::optional<SurfaceContact> BallContact(const CadFeature& ball, const CadFeature& socket,
                                          const ContactOptions& options) {
  if (!RadiiFit(ball, socket, options)) return std::nullopt;
  if ((ball.X_PF.p - socket.X_PF.p).norm() > options.tolerance + kDrawn) return std::nullopt;
  SurfaceContact contact;
  contact.surface = CadSurface::kBall;
  contact.p_W = ball.X_PF.p;
  contact.radius = ball.radius;
  contact.gap = socket.radius - ball.radius;
  return contact;
}

/// Planes that face each other, the second at most `greatest` in front of the first.
std::optional<SurfaceContact> PlaneContact(const CadFeature& a, const CadFeature& b,
                                           double greatest, const ContactOptions& options) {
  if ((AxisOf(a) + AxisOf(b)).norm() > kParallelAxes) return std::nullopt;
  const Posed X_AB = a.X_PF.inverse() * b.X_PF;
  const double gap = X_AB.p.z();
  if (gap < -options.tolerance - kDrawn || gap > greatest + kDrawn) return std::nullopt;
  Vector3d low = Vector3d::Constant(INFINITY), high = -low;
  for (const double x : {b.lower.x(), b.upper.x()}) {
    for (const double y : {b.lower.y(), b.upper.y()}) {
      low = low.cwiseMin(X_AB * Vector3d(x, y, 0));
      high = high.cwiseMax(X_AB * Vector3d(x, y, 0));
    }
  }
  const Vector3d lower = low.cwiseMax(a.lower), upper = high.cwiseMin(a.upper);
  for (int i = 0; i < 2; ++i) {
    const double side = std::min(high[i] - low[i], a.upper[i] - a.lower[i]);
    if (upper[i] - lower[i] < kLeastOverlap * side) return std::nullopt;
  }
  SurfaceContact contact;
  contact.axis_W = AxisOf(a);
  contact.gap = gap;
  for (const double x : {lower.x(), upper.x()}) {
    for (const double y : {lower.y(), upper.y()}) {
      contact.corners_W.push_back(a.X_PF * Vector3d(x, y, 0));
      contact.p_W += 0.25 * contact.corners_W.back();
    }
  }
  return contact;
}

bool IsInside(CadSurface surface) {
  return surface == CadSurface::kShaft || surface == CadSurface::kBall;
}

/// True for a shaft and a bore, or a ball and a socket.
bool AreMates(const CadFeature& inner, const CadFeature& outer) {
  return (inner.surface == CadSurface::kShaft && outer.surface == CadSurface::kBore) ||
         (inner.surface == CadSurface::kBall && outer.surface == CadSurface::kSocket);
}

std::optional<SurfaceContact> MateContact(const CadFeature& inner, const CadFeature& outer,
                                          const ContactOptions& options) {
  return inner.surface == CadSurface::kShaft ? CylinderContact(inner, outer, options)
                                             : BallContact(inner, outer, options);
}

std::optional<SurfaceContact> FindContact(const CadFeature& a, const CadFeature& b,
                                          const ContactOptions& options) {
  std::optional<SurfaceContact> contact;
  if (a.surface == CadSurface::kPlane && b.surface == CadSurface::kPlane) {
    contact = PlaneContact(a, b, options.tolerance, options);
  } else if (AreMates(a, b)) {
    contact = MateContact(a, b, options);
  } else if (AreMates(b, a)) {
    contact = MateContact(b, a, options);
  }
  if (contact) {
    contact->first_inside = IsInside(a.surface);
    contact->fastens = a.fastens || b.fastens;
  }
  return contact;
}

/// A box around a feature in world axes.
void Extend(const CadFeature& feature, Vector3d* low, Vector3d* high) {
  const Vector3d reach = Vector3d::Constant(std::max(feature.radius, 0.5 * feature.length));
  *low = low->cwiseMin(feature.X_PF.p - reach);
  *high = high->cwiseMax(feature.X_PF.p + reach);
  if (feature.surface != CadSurface::kPlane) return;
  for (const double x : {feature.lower.x(), feature.upper.x()}) {
    for (const double y : {feature.lower.y(), feature.upper.y()}) {
      *low = low->cwiseMin(feature.X_PF * Vector3d(x, y, 0));
      *high = high->cwiseMax(feature.X_PF * Vector3d(x, y, 0));
    }
  }
}

bool AreApart(const WorldFeatures& a, const WorldFeatures& b, double tolerance) {
  Vector3d low_a = Vector3d::Constant(INFINITY), high_a = -low_a, low_b = low_a, high_b = high_a;
  for (const CadFeature& feature : a) Extend(feature, &low_a, &high_a);
  for (const CadFeature& feature : b) Extend(feature, &low_b, &high_b);
  return ((low_a - high_b).array() > tolerance + kDrawn).any() ||
         ((low_b - high_a).array() > tolerance + kDrawn).any();
}

ContactOptions Widened(ContactOptions options) {
  options.tolerance *= kNear;
  options.clearance *= kNear;
  return options;
}

/// By how much a mate misses, if by a little; else nothing.
std::string MissOf(const CadFeature& inner, const CadFeature& outer,
                   const ContactOptions& options) {
  const ContactOptions wide = Widened(options);
  const bool is_shaft = inner.surface == CadSurface::kShaft;
  const double skew = is_shaft ? AxisOf(inner).cross(AxisOf(outer)).norm() : 0;
  const double offset =
      is_shaft ? DistanceFromAxis(inner.X_PF.p, outer) : (inner.X_PF.p - outer.X_PF.p).norm();
  if (skew > kNear * kParallelAxes || offset > wide.tolerance + kDrawn) return {};
  if (!RadiiFit(inner, outer, wide) || (is_shaft && !SharedStretch(inner, outer))) return {};
  const std::string what =
      fmt::format("{} of {:.6g} mm and {} of {:.6g} mm", is_shaft ? "shaft" : "ball",
                  2 * kMillimetres * inner.radius, is_shaft ? "bore" : "socket",
                  2 * kMillimetres * outer.radius);
  if (!RadiiFit(inner, outer, options)) {
    const Fit fit = FitOf(inner, outer, options);
    const double play = outer.radius - inner.radius;
    return fmt::format("{}: {} of {:.4g} mm on the radius, {:.4g} mm allowed", what,
                       play > 0 ? "play" : "overlap", kMillimetres * std::abs(play),
                       kMillimetres * std::abs(play > 0 ? fit.greatest : fit.least));
  }
  if (skew > kParallelAxes) {
    constexpr double kDegrees = 180 / std::numbers::pi;
    return fmt::format("{}: axes {:.3g} deg off parallel, {:.3g} deg allowed", what,
                       kDegrees * skew, kDegrees * kParallelAxes);
  }
  return fmt::format("{}: {} {:.4g} mm apart, {:.4g} mm allowed", what,
                     is_shaft ? "axes" : "centres", kMillimetres * offset,
                     kMillimetres * options.tolerance);
}

/// True if one of the contacts has its axis, or centre, where the feature has it.
bool IsHeldThere(const std::vector<SurfaceContact>& contacts, const CadFeature& feature,
                 double tolerance) {
  return std::any_of(contacts.begin(), contacts.end(), [&](const SurfaceContact& contact) {
    if (contact.surface == CadSurface::kPlane) return false;
    if (contact.surface == CadSurface::kBall)
      return (contact.p_W - feature.X_PF.p).norm() <= tolerance;
    return DistanceFromAxis(contact.p_W, feature) <= tolerance;
  });
}

}  // namespace

void ContactOptions::Validate() const {
  const auto require = [](const char* name, double value, double low, double high, double unit) {
    if (value >= low && value <= high) return;
    throw std::invalid_argument(fmt::format("ContactOptions: {} = {:g} is not in {:g}..{:g}", name,
                                            unit * value, unit * low, unit * high));
  };
  require("tolerance [mm]", tolerance, 1e-7, 1e-2, kMillimetres);
  require("clearance", clearance, 0, 0.5, 1);
  require("fastener_play", fastener_play, 0, 0.5, 1);
  require("end_play", end_play, 0, 0.5, 1);
}

Vector3d AxisOf(const CadFeature& feature) {
  return feature.X_PF.R.col(2);
}

double DistanceFromAxis(const Vector3d& p, const CadFeature& cylinder) {
  return (p - cylinder.X_PF.p).cross(AxisOf(cylinder)).norm();
}

std::optional<std::pair<double, double>> SharedStretch(const CadFeature& first,
                                                       const CadFeature& second) {
  const double middle = (second.X_PF.p - first.X_PF.p).dot(AxisOf(first));
  const double low = std::max(-0.5 * first.length, middle - 0.5 * second.length);
  const double high = std::min(0.5 * first.length, middle + 0.5 * second.length);
  if (high - low < kLeastOverlap * std::min(first.length, second.length)) return std::nullopt;
  return std::pair{low, high};
}

std::vector<SurfaceContact> FindContacts(const WorldFeatures& first, const WorldFeatures& second,
                                         const ContactOptions& options) {
  std::vector<SurfaceContact> contacts;
  if (AreApart(first, second, options.tolerance)) return contacts;
  for (const CadFeature& one : first) {
    for (const CadFeature& other : second) {
      if (const auto contact = FindContact(one, other, options)) contacts.push_back(*contact);
    }
  }
  return contacts;
}

std::vector<SurfaceContact> FindShoulders(const WorldFeatures& first, const WorldFeatures& second,
                                          const SurfaceContact& shaft,
                                          const ContactOptions& options) {
  const double most = 2 * shaft.radius * options.end_play;
  std::optional<SurfaceContact> ends[2];
  for (const CadFeature& one : first) {
    if (one.surface != CadSurface::kPlane) continue;
    const double along = AxisOf(one).dot(shaft.axis_W);
    if (AxisOf(one).cross(shaft.axis_W).norm() > kParallelAxes) continue;
    std::optional<SurfaceContact>& end = ends[along > 0 ? 1 : 0];
    for (const CadFeature& other : second) {
      if (other.surface != CadSurface::kPlane) continue;
      const auto contact = PlaneContact(one, other, most, options);
      if (contact && (!end || contact->gap < end->gap)) end = contact;
    }
  }
  if (!ends[0] || !ends[1] || ends[0]->gap + ends[1]->gap > most + kDrawn) return {};
  return {*ends[0], *ends[1]};
}

std::vector<std::string> FindNearMisses(const WorldFeatures& first, const WorldFeatures& second,
                                        const ContactOptions& options) {
  std::vector<std::string> misses;
  const ContactOptions wide = Widened(options);
  if (AreApart(first, second, wide.tolerance)) return misses;
  const std::vector<SurfaceContact> contacts = FindContacts(first, second, options);
  for (const CadFeature& one : first) {
    for (const CadFeature& other : second) {
      const bool is_inside = AreMates(one, other);
      if (!is_inside && !AreMates(other, one)) continue;
      const CadFeature &inner = is_inside ? one : other, &outer = is_inside ? other : one;
      if (IsHeldThere(contacts, inner, wide.tolerance)) continue;
      const std::string miss = MissOf(inner, outer, options);
      if (!miss.empty()) misses.push_back(miss);
    }
  }
  return misses;
}

}  // namespace vmech
