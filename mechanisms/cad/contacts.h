#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vmech/mechanisms/cad/cad_assembly.h"
#include "vmech/mechanisms/mechanism.h"

namespace vmech {

/// Joints that the geometry of two bodies suggests. Where a shaft sits in a bore, a ball in a
/// socket, or plane lies on plane, the bodies are taken to stay in contact, and each contact keeps
/// some components of the relative twist [v; w] at zero: with the axis a, the normal n and v at a
/// point of the contact
///
///   shaft in bore   v x a = 0, w x a = 0
///   ball in socket  v = 0
///   plane on plane  v.n = 0,   w x n = 0
///
/// What all contacts together leave free is the joint: a rotation (revolute), a translation
/// (prismatic), both along one axis (cylindrical), and so on.

struct ContactOptions {
  /// Greatest gap or offset between surfaces in contact [m], 1e-7..1e-2. Larger finds looser fits,
  /// and neighbours that do not touch.
  double tolerance = 1e-4;
  /// Greatest difference of the radii of bore and shaft, of the radius, 0..0.5.
  double clearance = 0.02;

  /// @throws std::invalid_argument
  void Validate() const;
};

struct ProposedJoint {
  JointType type = JointType::kRevolute;
  Posed X_WJ;         ///< of both anchors
  double radius = 0;  ///< of the shaft or ball [m]; 0 if there is none
  std::string why;    ///< "shaft of 20 mm in a bore, planes in contact"
};

/// The features of a body in world axes: X_PF is then X_WF.
using WorldFeatures = std::vector<CadFeature>;

/// What the contacts between two bodies leave free; none if they do not touch, or leave something
/// else than one joint has.
std::optional<ProposedJoint> ProposeJoint(const WorldFeatures& a, const WorldFeatures& b,
                                          const ContactOptions& options = {});

/// Shaft and seats of a bearing joint, as drawn.
struct JointSeat {
  double shaft_diameter = 0;      ///< [m]; 0: none found
  double housing_diameter = 0;    ///< of the bores around it if they are wider; 0: none found
  std::vector<double> positions;  ///< middles of the bores along z of the joint [m]; at most two
};

/// Looks for the cylinders around the axis of a joint whose frame is X_WJ: the nearest shaft of
/// either body that has a bore of the other around it, else one that holds the joint's origin.
JointSeat FindSeat(const WorldFeatures& a, const WorldFeatures& b, const Posed& X_WJ,
                   const ContactOptions& options = {});

}  // namespace vmech
