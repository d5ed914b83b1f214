#pragma once

#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vmech/base/pose.h"
#include "vmech/mechanisms/joint_type.h"

namespace vmech {

/// What a mechanism is: links that meet in joints. Everything is in SI units and radians; the
/// readers convert at the door. Paper section 3.

/// Mass, centre of gravity and inertia of a link, in the link's drawing frame L.
struct MassProperties {
  double mass = 0;                      ///< [kg]
  Vector3d p_LoLcm = Vector3d::Zero();  ///< centre of gravity [m]
  Matrix3d I_Lcm = Matrix3d::Zero();    ///< about the centre of gravity, axes of L [kg m^2]
};

/// A frame on a link at which joints are made: z is the axis of rotation or translation, the
/// origin is the joint centre (paper section 3).
struct Anchor {
  std::string name;  ///< unique on its link
  Posed X_LA;        ///< pose in the link's drawing frame
};

/// A part that moves as one piece.
struct Link {
  std::string name;                ///< unique in the mechanism
  MassProperties mass_properties;  ///< in its drawing frame
  std::vector<Anchor> anchors;     ///< where joints hold it
};

/// One anchor of one link, by index.
struct AnchorId {
  int link = -1;    ///< index in Mechanism::links
  int anchor = -1;  ///< index in Link::anchors
};

/// A linear spring and the dry and viscous friction along one freedom of a joint.
/// Generalised force on the freedom: -stiffness (q - rest) - viscous q', and dry friction, which
/// opposes the sliding of all freedoms of a contact together.
template <typename T>
struct PassiveOf {
  T stiffness = 0;  ///< [N/m] or [N m/rad]
  T rest = 0;       ///< coordinate at which the spring is slack [m] or [rad]
  T viscous = 0;    ///< [N s/m] or [N m s/rad]
  T coulomb = 0;    ///< constant part of dry friction [N] or [N m]
};
/// Of a joint as a file has it.
using Passive = PassiveOf<double>;
/// Is there a spring or friction?
bool HasPassive(const Passive& passive);

/// Dry friction in proportion to the joint's load (dynamics/contact_friction.h has the formulas).
/// The load is that of the joint itself, so that the reactions and the friction are found together.
/// A length of zero is one that is not given; the load that it would turn into friction is left
/// out.
template <typename T>
struct LoadFrictionOf {
  T coefficient = 0;    ///< [-]
  T radius = 0;         ///< of the sliding surface of a rotation, mean radius of a thread [m]
  T thrust_radius = 0;  ///< mean radius of the collars that take the thrust along a pin [m]
  T length = 0;         ///< between the two supports that hold a tilting couple [m]
  T width = 0;          ///< between the two faces that keep a slide from turning [m]
};
/// Of a joint as a file has it.
using LoadFriction = LoadFrictionOf<double>;

/// A joint is the coincidence of an anchor on its first link with one on its second. At
/// coordinates zero the two anchors coincide; the coordinates describe the pose of the second
/// anchor M in the first anchor F.
struct Joint {
  std::string name;                       ///< unique in the mechanism
  JointType type = JointType::kRevolute;  ///< decides its freedoms
  AnchorId first;                         ///< F
  AnchorId second;                        ///< M
  double pitch = 0;                       ///< kScrew: travel per radian [m/rad]
  std::vector<double> start;              ///< coordinates at the start; CoordinatesOf(type) values
  bool start_given = false;          ///< the file states the start; else it is free to be anywhere
  std::vector<double> lower, upper;  ///< limits per freedom; infinite where there is none
  std::vector<Passive> passive;      ///< per freedom
  LoadFriction load_friction;        ///< dry friction in proportion to its load
  /// Stiffness of the joint against x, y, z [N/m] and about x, y, z [N m/rad], axes of F, for the
  /// `stiffness` rule. Entries along freedoms are not used.
  std::optional<Vector6d> stiffness;
};

/// Whether a hand holds position and orientation, or the position alone.
enum class GraspKind { kRigid, kPoint };

/// A frame G on a link by which a hand holds the mechanism.
struct Grasp {
  std::string name;                    ///< unique in the mechanism
  int link = -1;                       ///< index in Mechanism::links
  Posed X_LG;                          ///< pose in the link's drawing frame
  GraspKind kind = GraspKind::kRigid;  ///< a point is held by force alone
};

/// The units in which a file speaks, for what is said about it; the mechanism itself is in SI.
struct DisplayUnits {
  std::string length = "m", angle = "rad";  ///< symbols
  double metres = 1, radians = 1;           ///< in one unit
};

/// The immutable description of a mechanism. Names are unique within their list.
struct Mechanism {
  std::string name;                       ///< of the file; may be empty
  DisplayUnits units;                     ///< of messages; not of this description
  Vector3d gravity_W = Vector3d::Zero();  ///< [m/s^2], world axes = drawing axes of the ground link
  int ground = 0;                         ///< index of the ground link
  std::vector<Link> links;                ///< the ground is one of them
  std::vector<Joint> joints;              ///< in the order of the file
  std::vector<Grasp> grasps;              ///< where hands may hold it
  std::vector<int> preferred_cuts;        ///< joints that the author wants to be cut
  /// How far anchors may be off, root mean square, by the rounding of their figures, for loops to
  /// count as closed [characteristic lengths, rad], in [0, kWidestTolerance].
  double tolerance = 1e-4;

  /// it must exist
  const Anchor& anchor(AnchorId id) const { return links[id.link].anchors[id.anchor]; }
};

inline constexpr double kWidestTolerance = 0.01;  ///< of Mechanism::tolerance

/// Index of the named item; -1 if there is none.
int FindLink(const Mechanism& mechanism, std::string_view name);
/// Index of the named joint; -1 if there is none.
int FindJoint(const Mechanism& mechanism, std::string_view name);
/// Index of the named grasp; -1 if there is none.
int FindGrasp(const Mechanism& mechanism, std::string_view name);

/// A freedom among those of a mechanism: "pin" where it is the joint's only one, else "ball.rx".
std::string NameOfFreedom(const Joint& joint, int freedom);

/// A frame from its z axis and an approximate x axis, which is made orthogonal to z.
/// @throws std::invalid_argument if z has no length or x is parallel to z.
Matrix3d AxesFromZX(const Vector3d& z, const Vector3d& x);

/// A length that is typical of the mechanism: the mean distance of a moving link's anchors and
/// centre of gravity from each other, or 1 m if all coincide. Used to weigh metres against radians.
double CharacteristicLength(const Mechanism& mechanism);

/// A coordinate of a joint as text, as in "43.2 deg".
std::string FormatCoordinate(const DisplayUnits& units, const Joint& joint, int freedom,
                             double value);

/// A joint's default start: all zero (the identity for a spherical joint).
std::vector<double> ZeroCoordinates(JointType type);

/// A joint of the given type with every per-freedom list at its default length and value.
Joint MakeJoint(std::string name, JointType type, AnchorId first, AnchorId second);

}  // namespace vmech
