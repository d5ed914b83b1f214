#include "vmech/mechanisms/cad/contacts.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

namespace vmech {
namespace {

constexpr double kFreeShare = 1e-9;    // eigenvalue of a free motion, of the largest
constexpr double kNoRotation = 1e-5;   // of a twist of length one
constexpr double kWiderHousing = 1.1;  // a bore beyond it holds a bearing, not the shaft itself
constexpr size_t kMostPositions = 2;   // of bearings at one joint
constexpr double kMillimetre = 1e-3;
// How far shafts of the fits m6 to f7 are above and below their nominal diameter [m].
constexpr double kThickerShaft = 2e-5, kThinnerShaft = 3e-5;

/// The axis of a contact lies on that of another.
bool AreCoaxial(const SurfaceContact& a, const SurfaceContact& b, double tolerance) {
  return a.axis_W.cross(b.axis_W).norm() <= kParallelAxes &&
         (b.p_W - a.p_W).cross(a.axis_W).norm() <= tolerance + kDrawn;
}

/// True if all shafts among the contacts share one axis, and there is no ball.
bool TurnsAboutOneShaft(const std::vector<SurfaceContact>& contacts, double tolerance) {
  return std::all_of(contacts.begin(), contacts.end(), [&](const SurfaceContact& contact) {
    return contact.surface == CadSurface::kPlane ||
           (contact.surface == CadSurface::kShaft &&
            AreCoaxial(contacts.front(), contact, tolerance));
  });
}

/// Makes axes and normals parallel, and shafts coaxial, that are so within the tolerances, else
/// what a fit leaves free would seem to be held by two fits that are a little off.
void Align(double tolerance, std::vector<SurfaceContact>* contacts) {
  for (auto it = contacts->begin(); it != contacts->end(); ++it) {
    const auto model = std::find_if(contacts->begin(), it, [&](const SurfaceContact& earlier) {
      return earlier.surface != CadSurface::kBall && it->surface != CadSurface::kBall &&
             earlier.axis_W.cross(it->axis_W).norm() <= kParallelAxes;
    });
    if (model == it) continue;
    it->axis_W = (model->axis_W.dot(it->axis_W) < 0 ? -1 : 1) * model->axis_W;
    const bool are_shafts = model->surface == it->surface && it->surface == CadSurface::kShaft;
    if (!are_shafts || !AreCoaxial(*model, *it, tolerance)) continue;
    it->p_W = model->p_W + (it->p_W - model->p_W).dot(model->axis_W) * model->axis_W;
  }
}

/// Which turns of the first body about the axis a plane blocks: bit 1 the positive, bit 2 the
/// negative ones. The first body moves with w x r at r from the axis, and cannot move along its own
/// outward normal n: a turn is blocked where its sign times (axis x r).n is above zero.
int BlockedTurns(const SurfaceContact& plane, const SurfaceContact& shaft) {
  int blocked = 0;
  for (const Vector3d& corner_W : plane.corners_W) {
    const double arm = shaft.axis_W.cross(corner_W - shaft.p_W).dot(plane.axis_W);
    if (arm > kDrawn) blocked |= 1;
    if (arm < -kDrawn) blocked |= 2;
  }
  return blocked;
}

/// Takes out the planes of a stop: where a body turns about one shaft, and all planes along the
/// shaft block turns of one sense only.
void LeaveOutStops(double tolerance, std::vector<SurfaceContact>* contacts) {
  const SurfaceContact shaft = contacts->front();
  if (shaft.surface != CadSurface::kShaft || !TurnsAboutOneShaft(*contacts, tolerance)) return;
  const auto is_along = [&](const SurfaceContact& contact) {
    return contact.surface == CadSurface::kPlane &&
           contact.axis_W.cross(shaft.axis_W).norm() > kParallelAxes;
  };
  int blocked = 0;
  for (const SurfaceContact& contact : *contacts) {
    if (is_along(contact)) blocked |= BlockedTurns(contact, shaft);
  }
  if (blocked != 1 && blocked != 2) return;
  contacts->erase(std::remove_if(contacts->begin(), contacts->end(), is_along), contacts->end());
}

/// Adds the shoulders between which a shaft has end play, unless a shoulder is in contact already.
void AddShoulders(const WorldFeatures& a, const WorldFeatures& b, const ContactOptions& options,
                  std::vector<SurfaceContact>* contacts) {
  const SurfaceContact shaft = contacts->front();
  if (shaft.surface != CadSurface::kShaft) return;
  for (const SurfaceContact& contact : *contacts) {
    if (contact.surface == CadSurface::kPlane) return;
  }
  for (const SurfaceContact& end : FindShoulders(a, b, shaft, options)) contacts->push_back(end);
}

/// What holds two bodies together: cylinders first, then balls; they say where the joint is.
std::vector<SurfaceContact> HoldingContacts(const WorldFeatures& a, const WorldFeatures& b,
                                            const ContactOptions& options) {
  std::vector<SurfaceContact> contacts = FindContacts(a, b, options);
  if (contacts.empty()) return contacts;
  std::stable_sort(
      contacts.begin(), contacts.end(),
      [](const SurfaceContact& x, const SurfaceContact& y) { return x.surface < y.surface; });
  Align(options.tolerance, &contacts);
  LeaveOutStops(options.tolerance, &contacts);
  AddShoulders(a, b, options, &contacts);
  return contacts;
}

/// The rows of a contact, squared and summed: C'C for the twist [v; w length] at the point O.
Matrix6d SquaredRows(const SurfaceContact& contact, const Vector3d& p_WO, double length) {
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
                                     const SurfaceContact& anchor) {
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
    if (feature.surface == surface &&
        AxisOf(feature).cross(X_WJ.R.col(2)).norm() <= kParallelAxes &&
        DistanceFromAxis(X_WJ.p, feature) <= tolerance + kDrawn) {
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
    const double diameter = 2 * bore.radius;
    if (bore.radius > kWiderHousing * shaft.radius) {
      seat.housing_diameter = diameter;
    } else if (seat.bore_diameter == 0 || diameter < seat.bore_diameter) {
      seat.bore_diameter = diameter;
    }
  }
  seat.nominal_diameter = NominalDiameter(seat.shaft_diameter, seat.bore_diameter);
  std::sort(seat.positions.begin(), seat.positions.end());
  if (seat.positions.size() > kMostPositions) {
    seat.positions = {seat.positions.front(), seat.positions.back()};
  }
  return seat;
}

std::string Describe(const std::vector<SurfaceContact>& contacts) {
  std::string text;
  int planes = 0;
  double last_radius = 0;
  for (const SurfaceContact& contact : contacts) {
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

std::optional<ProposedJoint> ProposeJoint(const WorldFeatures& a, const WorldFeatures& b,
                                          const ContactOptions& options) {
  options.Validate();
  const std::vector<SurfaceContact> contacts = HoldingContacts(a, b, options);
  if (contacts.empty()) return std::nullopt;
  const Vector3d p_WO = contacts.front().p_W;
  double length = contacts.front().radius;
  for (const SurfaceContact& contact : contacts)
    length = std::max(length, (contact.p_W - p_WO).norm());
  if (length == 0) length = 1;

  Matrix6d squared = Matrix6d::Zero();
  for (const SurfaceContact& contact : contacts) squared += SquaredRows(contact, p_WO, length);
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(squared);
  int free = 0;
  while (free < 6 && eigen.eigenvalues()[free] < kFreeShare * eigen.eigenvalues()[5]) ++free;
  auto joint = JointOf(eigen.eigenvectors().leftCols(free), p_WO, length, contacts.front());
  if (!joint) return joint;
  joint->why = Describe(contacts);
  joint->fastened = std::any_of(contacts.begin(), contacts.end(),
                                [](const SurfaceContact& contact) { return contact.fastens; });
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
      if (!(rank < best) || (rank.first && rank.second > options.tolerance + kDrawn)) continue;
      best = rank;
      seat = candidate;
    }
  }
  return seat;
}

double NominalDiameter(double shaft, double bore) {
  const bool has_play = bore > shaft + kDrawn;
  const double play = has_play ? bore - shaft : 0;
  const double middle = shaft + 0.5 * play;
  const double whole = std::round(middle / kMillimetre) * kMillimetre;
  const double low = shaft - std::max(play, kThickerShaft);
  const double high = shaft + std::max(2 * play, kThinnerShaft);
  if (whole > 0 && whole >= low - kDrawn && whole <= high + kDrawn) return whole;
  return has_play ? bore : shaft;
}

}  // namespace vmech
