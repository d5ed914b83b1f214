#pragma once

#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vmech/base/pose.h"
#include "vmech/mechanisms/joint_type.h"

namespace vmech {

// A mechanism is links that meet in joints (paper section 3). Everything here is in SI units and
// radians; the readers of files convert what they read.

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
  MassProperties mass_properties;  ///< in the link's drawing frame
  std::vector<Anchor> anchors;     ///< frames at which joints hold the link
};

/// One anchor of one link, by index.
struct AnchorId {
  int link = -1;    ///< index in Mechanism::links
  int anchor = -1;  ///< index in Link::anchors
};

/// A linear spring and the dry and viscous friction along one freedom of a joint.
/// The generalised force on the freedom is -stiffness (q - rest) - viscous q', and dry friction
/// besides, which opposes the sliding of all freedoms of a contact together. Numbers are for a
/// translation, or for a rotation. T is double, or Dual to take a derivative along.
template <typename T>
struct PassiveOf {
  T stiffness = 0;  ///< [N/m] or [N m/rad]
  T rest = 0;       ///< coordinate at which the spring is slack [m] or [rad]
  T viscous = 0;    ///< [N s/m] or [N m s/rad]
  T coulomb = 0;    ///< constant part of dry friction [N] or [N m]
};
/// Spring and friction of one freedom in plain numbers, as a Joint has them.
using Passive = PassiveOf<double>;
/// True if there is a spring, or viscous or dry friction.
bool HasPassive(const Passive& passive);

/// Dry friction in proportion to the joint's load; dynamics/loads/pose/contact_friction.h has the
/// formulas. The load is that of the joint itself, so that the reactions and the friction are found
/// together. A length of zero counts as not given: the load that it would turn into friction is
/// then left out, and a study warns of that.
template <typename T>
struct LoadFrictionOf {
  T coefficient = 0;    ///< [-]
  T radius = 0;         ///< of the sliding surface of a rotation, mean radius of a thread [m]
  T thrust_radius = 0;  ///< mean radius of the collars that take the thrust along a pin [m]
  T length = 0;         ///< between the two supports that hold a tilting couple [m]
  T width = 0;          ///< between the two faces that keep a slide from turning [m]
};
/// Load-dependent friction in plain numbers, as a Joint has it.
using LoadFriction = LoadFrictionOf<double>;

/// A joint is the coincidence of an anchor on its first link with one on its second. At
/// coordinates zero the two anchors coincide; the coordinates describe the pose of the second
/// anchor M in the first anchor F.
struct Joint {
  std::string name;                       ///< unique in the mechanism
  JointType type = JointType::kRevolute;  ///< decides which motions of M in F are free
  AnchorId first;                         ///< F, the anchor on the first link
  AnchorId second;                        ///< M, the anchor on the second link
  double pitch = 0;                       ///< kScrew: travel per radian [m/rad]
  std::vector<double> start;              ///< coordinates at the start; CoordinatesOf(type) values
  bool start_given = false;          ///< the file states the start; else the assembly may choose it
  std::vector<double> lower, upper;  ///< limits of each freedom [m] or [rad]; infinite: no limit
  std::vector<Passive> passive;      ///< spring and friction of each freedom
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

/// The units of a file, in which messages about it speak; the mechanism itself is in SI units.
struct DisplayUnits {
  std::string length = "m", angle = "rad";  ///< symbols of the units
  double metres = 1, radians = 1;           ///< how many there are in one of these units
};

/// The immutable description of a mechanism. Names are unique within their list.
struct Mechanism {
  std::string name;                       ///< of the mechanism; may be empty
  DisplayUnits units;                     ///< of messages alone: all numbers here are in SI units
  Vector3d gravity_W = Vector3d::Zero();  ///< [m/s^2], world axes = drawing axes of the ground link
  int ground = 0;                         ///< index of the ground link
  std::vector<Link> links;                ///< the ground is one of them
  std::vector<Joint> joints;              ///< in the order of the file
  std::vector<Grasp> grasps;              ///< where hands may hold it
  std::vector<int> preferred_cuts;        ///< joints that the author wants to be cut
  /// How far the anchors may be moved to close loops that the rounding of their figures keeps open:
  /// root mean square [characteristic lengths, rad], in [0, kWidestTolerance].
  double tolerance = 1e-4;

  /// The anchor of this id, which must exist.
  const Anchor& anchor(AnchorId id) const { return links[id.link].anchors[id.anchor]; }
};

inline constexpr double kWidestTolerance = 0.01;  ///< the largest Mechanism::tolerance

/// Index of the named link; -1 if there is none.
int FindLink(const Mechanism& mechanism, std::string_view name);
/// Index of the named joint; -1 if there is none.
int FindJoint(const Mechanism& mechanism, std::string_view name);
/// Index of the named grasp; -1 if there is none.
int FindGrasp(const Mechanism& mechanism, std::string_view name);

/// The name of a freedom among those of a mechanism: that of the joint, "pin", where the joint has
/// one freedom, else "ball.rx".
std::string NameOfFreedom(const Joint& joint, int freedom);

/// A frame from its z axis and an approximate x axis, which is made orthogonal to z.
/// @throws std::invalid_argument if z or x has no length, or if they are parallel.
Matrix3d AxesFromZX(const Vector3d& z, const Vector3d& x);

/// A length that is typical of the mechanism: the mean distance of a moving link's anchors and
/// centre of gravity from each other, or 1 m if all coincide. Used to weigh metres against radians.
double CharacteristicLength(const Mechanism& mechanism);

/// A coordinate [m] or [rad] of a joint as text in display units, as in "43.2 deg".
std::string FormatCoordinate(const DisplayUnits& units, const Joint& joint, int freedom,
                             double value);

/// A joint's default start: all zero (the identity for a spherical joint).
std::vector<double> ZeroCoordinates(JointType type);

/// A joint of the given type whose lists have an entry per freedom: start at zero, without limits,
/// springs and friction.
Joint MakeJoint(std::string name, JointType type, AnchorId first, AnchorId second);

}  // namespace vmech
