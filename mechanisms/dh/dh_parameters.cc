#include "vmech/mechanisms/dh/dh_parameters.h"

#include <cmath>
#include <numbers>

namespace vmech {
namespace {

constexpr double kMeets = 1e-14;  // of the distance of the origins: a distance that is rounding

Posed Turn(double angle, const Vector3d& axis) {
  return {Eigen::AngleAxisd(angle, axis).toRotationMatrix(), Vector3d::Zero()};
}

Posed Shift(double x, double z) {
  return {Matrix3d::Identity(), Vector3d(x, 0, z)};
}

/// What is left from the end of the row to Q: a turn about and a shift along the z axis that both
/// share.
void TakeRest(const Posed& X_PQ, DhPair* pair) {
  const Posed rest = PoseOf(pair->row).inverse() * X_PQ;
  pair->theta = std::atan2(rest.R(1, 0), rest.R(0, 0));
  pair->d = rest.p.z();
}

/// u is the direction of Q's axis in P, p a point on it, n = z x u.
DhPair ByCommonNormal(const Vector3d& u, const Vector3d& p, const Vector3d& n) {
  DhPair pair;
  const double sine = n.norm();
  Vector3d x = n / sine;
  double a = x.dot(p);
  const bool meet = std::abs(a) <= kMeets * p.norm();
  pair.relation = meet ? AxesRelation::kIntersecting : AxesRelation::kSkew;
  if (meet) a = 0;
  const double side = (meet ? x.x() < -kMeets : a < 0) ? -1 : 1;
  x *= side;
  // The feet: (0, 0, d) on P's axis, p + t u on Q's; their difference has no part along z x x.
  const double t = p.dot(Vector3d::UnitZ().cross(x)) / (side * sine);
  pair.row = {std::atan2(x.y(), x.x()), p.z() + t * u.z(), side * a, std::atan2(side * sine, u.z()),
              0};
  pair.d = -t;
  return pair;
}

/// x from P's origin to where Q's axis pierces the xy plane; there is such a point, u.z() is near
/// +1 or -1. Tilts alpha and beta bring z onto u.
DhPair ByPiercingPoint(const Vector3d& u, const Vector3d& p) {
  DhPair pair;
  const Vector3d c = p - u * (p.z() / u.z());
  const double a = std::hypot(c.x(), c.y());
  const bool meet = a <= kMeets * p.norm();
  pair.relation = AxesRelation::kNearlyParallel;
  pair.row.a = meet ? 0 : a;
  pair.row.theta = meet ? 0 : std::atan2(c.y(), c.x());
  const Vector3d v = Turn(-pair.row.theta, Vector3d::UnitZ()).R * u;
  pair.row.alpha = std::atan2(-v.y(), v.z());
  pair.row.beta = std::atan2(v.x(), std::hypot(v.y(), v.z()));
  return pair;
}

/// The tilt is rounding: left out.
DhPair OfParallel(const Vector3d& u, const Vector3d& p) {
  DhPair pair = ByPiercingPoint({0, 0, u.z()}, p);
  pair.relation = pair.row.a == 0 ? AxesRelation::kCoincident : AxesRelation::kParallel;
  pair.row.alpha = u.z() > 0 ? 0 : std::numbers::pi;
  pair.row.beta = 0;
  return pair;
}

}  // namespace

std::string_view NameOf(AxesRelation relation) {
  constexpr std::string_view kNames[] = {"skew", "intersecting", "parallel", "coincident",
                                         "nearly parallel"};
  return kNames[static_cast<int>(relation)];
}

Posed PoseOf(const DhParameters& row) {
  return Turn(row.theta, Vector3d::UnitZ()) * Shift(row.a, row.d) *
         Turn(row.alpha, Vector3d::UnitX()) * Turn(row.beta, Vector3d::UnitY());
}

DhPair DeduceDh(const Posed& X_PQ) {
  const Vector3d u = X_PQ.R.col(2);
  const Vector3d n = Vector3d::UnitZ().cross(u);
  const double sine = n.norm();
  DhPair pair = sine < kParallel         ? OfParallel(u, X_PQ.p)
                : sine < kNearlyParallel ? ByPiercingPoint(u, X_PQ.p)
                                         : ByCommonNormal(u, X_PQ.p, n);
  TakeRest(X_PQ, &pair);
  return pair;
}

}  // namespace vmech
