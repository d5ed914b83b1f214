#include "vmech/mechanisms/cad/contacts.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

namespace vmech {
namespace {

constexpr double kParallel = 1e-3;     // [rad] between axes of a fit, normals in contact
constexpr double kLeastOverlap = 0.1;  // of the shorter length or side
constexpr double kFreeShare = 1e-9;    // eigenvalue of a free motion, of the largest
constexpr double kNoRotation = 1e-5;   // of a twist of length one
constexpr double kWiderHousing = 1.1;  // a bore beyond it holds a bearing, not the shaft itself
constexpr size_t kMostPositions = 2;   // of bearings at one joint

struct Contact {
  CadSurface surface;  ///< of one side
  Vector3d p_W, axis_W;
  double radius = 0;
};

Vector3d AxisOf(const CadFeature& feature) {
  return feature.X_PF.R.col(2);
}

double DistanceFromAxis(const Vector3d& p, const CadFeature& cylinder) {
  return (p - cylinder.X_PF.p).cross(AxisOf(cylinder)).norm();
}

bool RadiiFit(double inner, double outer, const ContactOptions& options) {
  return outer - inner > -options.tolerance &&
         outer - inner < std::max(options.tolerance, options.clearance * outer);
}

/// The stretch of an axis that two cylinders on it share, from the middle of the first.
std::optional<std::pair<double, double>> SharedStretch(const CadFeature& a, const CadFeature& b) {
  const double middle = (b.X_PF.p - a.X_PF.p).dot(AxisOf(a));
  const double low = std::max(-0.5 * a.length, middle - 0.5 * b.length);
  const double high = std::min(0.5 * a.length, middle + 0.5 * b.length);
  if (high - low < kLeastOverlap * std::min(a.length, b.length)) return std::nullopt;
  return std::pair{low, high};
}

std::optional<Contact> CylinderContact(const CadFeature& shaft, const CadFeature& bore,
                                       const ContactOptions& options) {
  if (!RadiiFit(shaft.radius, bore.radius, options)) return std::nullopt;
  if (AxisOf(shaft).cross(AxisOf(bore)).norm() > kParallel) return std::nullopt;
  if (DistanceFromAxis(shaft.X_PF.p, bore) > options.tolerance) return std::nullopt;
  const auto stretch = SharedStretch(shaft, bore);
  if (!stretch) return std::nullopt;
  const double middle = 0.5 * (stretch->first + stretch->second);
  return Contact{CadSurface::kShaft, shaft.X_PF.p + middle * AxisOf(shaft), AxisOf(shaft),
                 shaft.radius};
}

std::optional<Contact> BallContact(const CadFeature& ball, const CadFeature& socket,
                                   const ContactOptions& options) {
  if (!RadiiFit(ball.radius, socket.radius, options)) return std::nullopt;
  if ((ball.X_PF.p - socket.X_PF.p).norm() > options.tolerance) return std::nullopt;
  return Contact{CadSurface::kBall, ball.X_PF.p, Vector3d::Zero(), ball.radius};
}

std::optional<Contact> PlaneContact(const CadFeature& a, const CadFeature& b,
                                    const ContactOptions& options) {
  if ((AxisOf(a) + AxisOf(b)).norm() > kParallel) return std::nullopt;
  const Posed X_AB = a.X_PF.inverse() * b.X_PF;
  if (std::abs(X_AB.p.z()) > options.tolerance) return std::nullopt;
  Vector3d low = Vector3d::Constant(INFINITY), high = -low;
  for (int corner = 0; corner < 4; ++corner) {
    const Vector3d p_B{(corner & 1) != 0 ? b.upper.x() : b.lower.x(),
                       (corner & 2) != 0 ? b.upper.y() : b.lower.y(), 0};
    low = low.cwiseMin(X_AB * p_B);
    high = high.cwiseMax(X_AB * p_B);
  }
  const Vector3d lower = low.cwiseMax(a.lower), upper = high.cwiseMin(a.upper);
  for (int i = 0; i < 2; ++i) {
    const double side = std::min(high[i] - low[i], a.upper[i] - a.lower[i]);
    if (upper[i] - lower[i] < kLeastOverlap * side) return std::nullopt;
  }
  Vector3d middle = 0.5 * (lower + upper);
  middle.z() = 0;
  return Contact{CadSurface::kPlane, a.X_PF * middle, AxisOf(a)};
}

std::optional<Contact> FindContact(const CadFeature& a, const CadFeature& b,
                                   const ContactOptions& options) {
  const auto are = [&](CadSurface first, CadSurface second) {
    return a.surface == first && b.surface == second;
  };
  if (are(CadSurface::kShaft, CadSurface::kBore)) return CylinderContact(a, b, options);
  if (are(CadSurface::kBore, CadSurface::kShaft)) return CylinderContact(b, a, options);
  if (are(CadSurface::kBall, CadSurface::kSocket)) return BallContact(a, b, options);
  if (are(CadSurface::kSocket, CadSurface::kBall)) return BallContact(b, a, options);
  if (are(CadSurface::kPlane, CadSurface::kPlane)) return PlaneContact(a, b, options);
  return std::nullopt;
}

/// A box around a feature in world axes.
void Extend(const CadFeature& feature, Vector3d* low, Vector3d* high) {
  const Vector3d reach = Vector3d::Constant(std::max(feature.radius, 0.5 * feature.length));
  *low = low->cwiseMin(feature.X_PF.p - reach);
  *high = high->cwiseMax(feature.X_PF.p + reach);
  for (int corner = 0; corner < 4 && feature.surface == CadSurface::kPlane; ++corner) {
    const Vector3d p =
        feature.X_PF * Vector3d((corner & 1) != 0 ? feature.upper.x() : feature.lower.x(),
                                (corner & 2) != 0 ? feature.upper.y() : feature.lower.y(), 0);
    *low = low->cwiseMin(p);
    *high = high->cwiseMax(p);
  }
}

bool AreApart(const WorldFeatures& a, const WorldFeatures& b, double tolerance) {
  Vector3d low_a = Vector3d::Constant(INFINITY), high_a = -low_a, low_b = low_a, high_b = high_a;
  for (const CadFeature& feature : a) Extend(feature, &low_a, &high_a);
  for (const CadFeature& feature : b) Extend(feature, &low_b, &high_b);
  return ((low_a - high_b).array() > tolerance).any() ||
         ((low_b - high_a).array() > tolerance).any();
}

std::vector<Contact> FindContacts(const WorldFeatures& a, const WorldFeatures& b,
                                  const ContactOptions& options) {
  std::vector<Contact> contacts;
  if (AreApart(a, b, options.tolerance)) return contacts;
  for (const CadFeature& one : a) {
    for (const CadFeature& other : b) {
      if (const auto contact = FindContact(one, other, options)) contacts.push_back(*contact);
    }
  }
  return contacts;
}

/// The rows of a contact, squared and summed: C'C for the twist [v; w length] at the point O.
Matrix6d SquaredRows(const Contact& contact, const Vector3d& p_WO, double length) {
  const Matrix3d one = Matrix3d::Identity();
  const Matrix3d along = contact.axis_W * contact.axis_W.transpose();
  Eigen::Matrix<double, 3, 6> velocity;  // v at the contact = v + w x p
  velocity << one, -CrossMatrix<double>((contact.p_W - p_WO) / length);
  Eigen::Matrix<double, 3, 6> rotation;
  rotation << Matrix3d::Zero(), one;
  const bool is_plane = contact.surface == CadSurface::kPlane;
  const bool is_ball = contact.surface == CadSurface::kBall;
  const Matrix3d held_v = is_ball ? one : is_plane ? along : Matrix3d(one - along);
  const Matrix3d held_w = is_ball ? Matrix3d(Matrix3d::Zero()) : Matrix3d(one - along);
  return velocity.transpose() * held_v * velocity + rotation.transpose() * held_w * rotation;
}

Posed FrameOnAxis(const Vector3d& p, const Vector3d& z) {
  Vector3d x = Vector3d::Zero();
  int least = 0;
  z.cwiseAbs().minCoeff(&least);
  x[least] = 1;
  return {AxesFromZX(z, x), p};
}

/// The joint of the free twists: columns [v; w length] at O. `anchor` is where its frame should be.
std::optional<ProposedJoint> JointOf(const MatrixXd& free, const Vector3d& p_WO, double length,
                                     const Contact& anchor) {
  ProposedJoint joint;
  joint.radius = anchor.radius;
  joint.X_WJ =
      FrameOnAxis(anchor.p_W, anchor.axis_W.norm() > 0 ? anchor.axis_W : Vector3d(0, 0, 1));
  if (free.cols() == 0) {
    joint.type = JointType::kWeld;
  } else if (free.cols() == 1) {
    const Vector3d v = free.col(0).head<3>(), w = free.col(0).tail<3>() / length;
    if (w.norm() * length < kNoRotation) {
      joint.type = JointType::kPrismatic;
      joint.X_WJ = FrameOnAxis(anchor.p_W, v);
      return joint;
    }
    if (std::abs(v.dot(w)) > kNoRotation * w.squaredNorm() * length) return std::nullopt;
    const Vector3d p_on_axis = p_WO + w.cross(v) / w.squaredNorm();
    const Vector3d z = w.normalized();
    joint.type = JointType::kRevolute;
    joint.X_WJ = FrameOnAxis(p_on_axis + (anchor.p_W - p_on_axis).dot(z) * z, z);
  } else if (free.cols() == 2 && anchor.surface == CadSurface::kShaft) {
    joint.type = JointType::kCylindrical;
  } else if (free.cols() == 3 && anchor.surface != CadSurface::kShaft) {
    joint.type = anchor.surface == CadSurface::kBall ? JointType::kSpherical : JointType::kPlanar;
  } else {
    return std::nullopt;
  }
  return joint;
}

/// The cylinders whose axis is that of the joint.
WorldFeatures AroundAxis(const WorldFeatures& features, CadSurface surface, const Posed& X_WJ,
                         double tolerance) {
  WorldFeatures found;
  for (const CadFeature& feature : features) {
    if (feature.surface == surface && AxisOf(feature).cross(X_WJ.R.col(2)).norm() < kParallel &&
        DistanceFromAxis(X_WJ.p, feature) < tolerance) {
      found.push_back(feature);
    }
  }
  return found;
}

JointSeat SeatOn(const CadFeature& shaft, const WorldFeatures& bores, const Posed& X_WJ,
                 double tolerance) {
  JointSeat seat;
  seat.shaft_diameter = 2 * shaft.radius;
  for (const CadFeature& bore : bores) {
    if (bore.radius < shaft.radius - tolerance || !SharedStretch(shaft, bore)) continue;
    seat.positions.push_back((bore.X_PF.p - X_WJ.p).dot(X_WJ.R.col(2)));
    if (bore.radius > kWiderHousing * shaft.radius) seat.housing_diameter = 2 * bore.radius;
  }
  std::sort(seat.positions.begin(), seat.positions.end());
  if (seat.positions.size() > kMostPositions) {
    seat.positions = {seat.positions.front(), seat.positions.back()};
  }
  return seat;
}

std::string Describe(const std::vector<Contact>& contacts) {
  std::string text;
  int planes = 0;
  double last_radius = 0;
  for (const Contact& contact : contacts) {
    planes += contact.surface == CadSurface::kPlane;
    if (contact.radius == 0 || contact.radius == last_radius) continue;
    last_radius = contact.radius;
    const bool is_ball = contact.surface == CadSurface::kBall;
    text +=
        fmt::format("{}{} of {:.6g} mm in a {}", text.empty() ? "" : ", ",
                    is_ball ? "ball" : "shaft", 2e3 * contact.radius, is_ball ? "socket" : "bore");
  }
  if (planes > 0) {
    text += fmt::format("{}plane on plane in {} place{}", text.empty() ? "" : ", ", planes,
                        planes > 1 ? "s" : "");
  }
  return text;
}

}  // namespace

void ContactOptions::Validate() const {
  const auto require = [](const char* name, double value, double low, double high) {
    if (value >= low && value <= high) return;
    throw std::invalid_argument(
        fmt::format("ContactOptions: {} = {} is not in {:g}..{:g}", name, value, low, high));
  };
  require("tolerance [m]", tolerance, 1e-7, 1e-2);
  require("clearance", clearance, 0, 0.5);
}

std::optional<ProposedJoint> ProposeJoint(const WorldFeatures& a, const WorldFeatures& b,
                                          const ContactOptions& options) {
  options.Validate();
  std::vector<Contact> contacts = FindContacts(a, b, options);
  if (contacts.empty()) return std::nullopt;
  // Cylinders first, then balls: they say where the joint is.
  std::stable_sort(contacts.begin(), contacts.end(),
                   [](const Contact& x, const Contact& y) { return x.surface < y.surface; });
  const Vector3d p_WO = contacts.front().p_W;
  double length = contacts.front().radius;
  for (const Contact& contact : contacts) length = std::max(length, (contact.p_W - p_WO).norm());
  if (length == 0) length = 1;

  Matrix6d squared = Matrix6d::Zero();
  for (const Contact& contact : contacts) squared += SquaredRows(contact, p_WO, length);
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(squared);
  int free = 0;
  while (free < 6 && eigen.eigenvalues()[free] < kFreeShare * eigen.eigenvalues()[5]) ++free;
  auto joint = JointOf(eigen.eigenvectors().leftCols(free), p_WO, length, contacts.front());
  if (joint) joint->why = Describe(contacts);
  return joint;
}

JointSeat FindSeat(const WorldFeatures& a, const WorldFeatures& b, const Posed& X_WJ,
                   const ContactOptions& options) {
  // First those with a bore around them, then the nearest.
  std::pair<bool, double> best{true, INFINITY};
  JointSeat seat;
  for (const auto& [own, other] : {std::pair{&a, &b}, std::pair{&b, &a}}) {
    const WorldFeatures bores = AroundAxis(*other, CadSurface::kBore, X_WJ, options.tolerance);
    for (const CadFeature& shaft : AroundAxis(*own, CadSurface::kShaft, X_WJ, options.tolerance)) {
      const JointSeat candidate = SeatOn(shaft, bores, X_WJ, options.tolerance);
      const double middle = (shaft.X_PF.p - X_WJ.p).dot(X_WJ.R.col(2));
      const std::pair<bool, double> rank{candidate.positions.empty(),
                                         std::abs(middle) - 0.5 * shaft.length};
      if (!(rank < best) || (rank.first && rank.second > options.tolerance)) continue;
      best = rank;
      seat = candidate;
    }
  }
  return seat;
}

}  // namespace vmech
