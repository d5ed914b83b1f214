#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vmech/mechanisms/cad/surface_contact.h"
#include "vmech/mechanisms/mechanism.h"

namespace vmech {

// Joints that the geometry of two bodies suggests. Where a shaft sits in a bore, a ball in a
// socket, or plane lies on plane, the bodies are taken to stay in contact, and each contact keeps
// some components of the relative twist [v; w] at zero: with the axis a, the normal n and v at a
// point of the contact
//
//   shaft in bore   v x a = 0, w x a = 0
//   ball in socket  v = 0
//   plane on plane  v.n = 0,   w x n = 0
//
// What all contacts together leave free is the joint: a rotation (revolute), a translation
// (prismatic), both along one axis (cylindrical), and so on. A shaft with end play between two
// shoulders counts as held by them. Planes by which a body on one shaft is drawn at its stop, from
// which it can turn away, do not count.

/// A joint that the geometry of two bodies suggests.
struct ProposedJoint {
  JointType type = JointType::kRevolute;  ///< that leaves free what the contacts do
  Posed X_WJ;                             ///< of both anchors
  double radius = 0;                      ///< of the shaft or ball [m]; 0 if there is none
  std::string why;                        ///< "shaft of 20 mm in a bore, planes in contact"
  bool fastened = false;                  ///< screws, rivets or pins are among the contacts
};

/// What the contacts between two bodies leave free; none if they do not touch, or leave something
/// else than one joint has.
std::optional<ProposedJoint> ProposeJoint(const WorldFeatures& a, const WorldFeatures& b,
                                          const ContactOptions& options = {});

/// Shaft and seats of a bearing joint, as drawn.
struct JointSeat {
  double shaft_diameter = 0;      ///< [m]; 0: none found
  double housing_diameter = 0;    ///< of the bores around it if they are wider; 0: none found
  std::vector<double> positions;  ///< middles of the bores along z of the joint [m]; at most two
  double bore_diameter = 0;       ///< of the narrowest bore that the shaft fits into; 0: none found
  /// What a fit of 9.98 mm in 10.00 mm is called [m]: 0.010. NominalDiameter().
  double nominal_diameter = 0;
};

/// The diameter by which a fit of a shaft in a bore is known [m]; `bore` 0: none is drawn. It is
/// the whole millimetre between the two, or outside them by no more than their play, or 0.02 mm
/// below to 0.03 mm above the shaft (fits m6 to f7); else that of the bore, as in the hole-basis
/// system (ISO 286-1), if there is play; else that of the shaft.
double NominalDiameter(double shaft, double bore);

/// Looks for the cylinders around the axis of a joint whose frame is X_WJ: the nearest shaft of
/// either body that has a bore of the other around it, else one that holds the joint's origin.
JointSeat FindSeat(const WorldFeatures& a, const WorldFeatures& b, const Posed& X_WJ,
                   const ContactOptions& options = {});

}  // namespace vmech
