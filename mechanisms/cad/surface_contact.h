#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vmech/mechanisms/cad/step/cad_assembly.h"

namespace vmech {

// Surfaces of two bodies that touch as drawn: shaft in bore, ball in socket, plane on plane.

/// When two surfaces count as in contact.
struct ContactOptions {
  /// Greatest gap or offset between surfaces in contact [m], 1e-7..1e-2. Larger finds looser fits,
  /// and neighbours that do not touch. A gap of exactly this is in contact.
  double tolerance = 1e-4;
  /// Greatest difference of the radii of bore and shaft, as a share of the radius [-], 0..0.5.
  double clearance = 0.02;
  /// The same for screws, rivets and pins, either way [-], 0..0.5: clearance holes are up to a
  /// quarter wider, tapped holes drawn at their core a fifth narrower.
  double fastener_play = 0.3;
  /// Greatest end play of a shaft between two shoulders, as a share of its diameter [-], 0..0.5. A
  /// larger one takes looser stops for the end of an axial motion.
  double end_play = 0.1;

  /// @throws std::invalid_argument naming field, value and range.
  void Validate() const;
};

/// The features of a body in world axes: X_PF is then X_WF.
using WorldFeatures = std::vector<CadFeature>;

/// Two surfaces of an assembly that touch, or nearly.
struct SurfaceContact {
  CadSurface surface = CadSurface::kPlane;  ///< kShaft in a bore, kBall in a socket, or kPlane
  Vector3d p_W = Vector3d::Zero();          ///< the middle of the contact
  Vector3d axis_W = Vector3d::Zero();       ///< of the shaft; normal out of the first body
  double radius = 0;                        ///< of the shaft or the ball [m]
  double gap = 0;                           ///< of the radii or planes; below zero: overlap [m]
  double length = 0;                        ///< of the shaft in the bore [m]
  bool first_inside = false;                ///< shaft or ball belong to the first body
  bool fastens = false;                     ///< one of the two is of a fastener
  std::vector<Vector3d> corners_W = {};     ///< of the area in which planes overlap
};

/// What touches between two bodies, in the order of their features.
std::vector<SurfaceContact> FindContacts(const WorldFeatures& first, const WorldFeatures& second,
                                         const ContactOptions& options = {});

/// Planes square to an axis between which a body has end play at both ends of the other: two
/// contacts, one at either end; none if it can leave.
std::vector<SurfaceContact> FindShoulders(const WorldFeatures& first, const WorldFeatures& second,
                                          const SurfaceContact& shaft,
                                          const ContactOptions& options = {});

/// Shafts in bores and balls in sockets that are no contacts by a little: the text says what they
/// are, by how much they miss, and what is allowed.
std::vector<std::string> FindNearMisses(const WorldFeatures& first, const WorldFeatures& second,
                                        const ContactOptions& options = {});

/// Two directions are taken for parallel below this angle [rad].
constexpr double kParallelAxes = 1e-3;
/// Lengths as drawn are compared to a nanometre, so that no verdict hangs on rounding [m].
constexpr double kDrawn = 1e-9;

/// The direction of a cylinder, or the outward normal of a plane.
Vector3d AxisOf(const CadFeature& feature);
/// The distance of a point from the axis of a cylinder [m].
double DistanceFromAxis(const Vector3d& p, const CadFeature& cylinder);
/// The stretch of an axis that two cylinders on it share, from the middle of the first [m].
std::optional<std::pair<double, double>> SharedStretch(const CadFeature& first,
                                                       const CadFeature& second);

}  // namespace vmech
