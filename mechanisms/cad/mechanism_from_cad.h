#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "vmech/mechanisms/cad/bodies.h"
#include "vmech/mechanisms/cad/body_mass.h"
#include "vmech/mechanisms/cad/contacts.h"
#include "vmech/mechanisms/cad/fasteners.h"
#include "vmech/mechanisms/mechanism.h"

namespace vmech {

// From an assembly to a mechanism: bodies become links, named frames become anchors, two anchors
// of the same name on two bodies a joint. The anchors need not coincide in the file; how far they
// are apart is reported.

/// What a user says about an assembly that becomes a mechanism.
struct CadImportOptions {
  std::string name;          ///< of the mechanism; empty: that of the file
  BodyOptions bodies;        ///< which parts are one body
  DensityOptions densities;  ///< of materials and parts
  ContactOptions contacts;   ///< what counts as a fit
  /// The body that stands still. Empty: the one called ground, frame, base, housing or stand; else
  /// a link "ground" if there are frames directly in the file; else the first body.
  std::string ground;
  /// [m/s^2], in the axes of the file; none: 9.81 against z, said to be guessed.
  std::optional<Vector3d> gravity_W;
  /// Types by joint, before what the frames say.
  std::vector<std::pair<std::string, JointType>> joint_types;
  /// Take the joints that the geometry suggests, too. They are taken anyway if no frame is an
  /// anchor; and so are the welds of what screws hold together.
  bool propose = false;
  bool allow_unmatched = false;  ///< keep anchors without a partner as anchors
};

/// A link of a mechanism that was made of an assembly.
struct ImportedBody {
  int link = -1;  ///< index in Mechanism::links
  Posed X_WL;     ///< the axes of the link in those of the file, as drawn
  BodyMass mass;  ///< with the share of every part
};

/// A joint of a mechanism that was made of an assembly, and how far off it was drawn.
struct ImportedJoint {
  int joint = -1;              ///< index in Mechanism::joints
  bool from_geometry = false;  ///< no frames named it
  bool type_assumed = false;   ///< neither the user nor a frame named it
  double distance = 0;         ///< between the origins of the anchors, as drawn [m]
  double angle = 0;            ///< between their axes, as drawn [rad]
  /// What the joint cannot take up of it, at its start coordinates: these the assembly must close.
  double gap = 0;   ///< [m]
  double skew = 0;  ///< [rad]
  JointSeat seat;   ///< where it sits on the shaft
  std::string why;  ///< of a joint from geometry
};

/// An anchor whose name no other body carries, with the nearest one that is free, or else the
/// nearest of all.
struct UnmatchedAnchor {
  std::string frame, body;                  ///< names as in the file
  std::string nearest_frame, nearest_body;  ///< empty if there is no other
  double distance = 0;                      ///< [m]
  double angle = 0;                         ///< between the axes, without their sense [rad]
};

/// A joint that the geometry suggests and that was not asked for.
struct JointHint {
  std::string first_body, second_body;  ///< names of links to be
  ProposedJoint joint;                  ///< with its type and place
};

/// A shaft and a bore, or a ball and a socket, that are no fit by a little.
struct NearMiss {
  std::string first_body, second_body;  ///< names of bodies
  std::string what;  ///< "shaft of 10 mm and bore of 10 mm: axes 0.12 mm apart, 0.1 mm allowed"
};

/// A mechanism made of an assembly, and how each of its numbers was found.
struct CadImport {
  std::string file;                        ///< that was read
  std::string unit;                        ///< of the file's lengths
  Mechanism mechanism;                     ///< SI, its loops not closed yet
  std::vector<ImportedBody> bodies;        ///< in the order of the links
  std::vector<ImportedJoint> joints;       ///< in the order of the mechanism's
  std::vector<UnmatchedAnchor> unmatched;  ///< anchors left over
  std::vector<JointHint> hints;            ///< not made into joints
  std::vector<std::string> guesses;        ///< what was assumed, in words
  std::vector<std::string> remarks;        ///< of the file: renamed, passed over, implausible
  std::vector<BodyMerge> merges;           ///< bodies that became part of others
  std::vector<NearMiss> near_misses;       ///< to be looked at by the user

  /// A page for a terminal: bodies with their mass and its source, joints with distances and
  /// angles, shafts, what was guessed.
  std::string FullReport() const;
};

/// @throws FileErrors with everything that is wrong: parts without a volume, anchors without a
///         partner, three anchors of one joint, types that contradict, bodies without a joint.
///         std::invalid_argument for options out of range.
CadImport MechanismFromCad(const CadAssembly& assembly, const CadImportOptions& options = {});

}  // namespace vmech
