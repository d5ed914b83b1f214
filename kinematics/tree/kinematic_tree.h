#pragma once

#include <array>
#include <vector>

#include "vmech/mechanisms/graph.h"
#include "vmech/mechanisms/mechanism.h"

namespace vmech {

/// How an elementary joint lets its node move in the parent.
enum class NodeMotion { kFixed, kRevolute, kPrismatic, kScrew, kSpherical };

/// The number of entries in v that a node has.
inline int VelocitiesOf(NodeMotion motion) {
  return motion == NodeMotion::kFixed ? 0 : motion == NodeMotion::kSpherical ? 3 : 1;
}

/// An elementary joint of the tree, and the link behind it.
struct TreeNode {
  int parent = -1;                         ///< index of a node before this one; -1 is the ground
  NodeMotion motion = NodeMotion::kFixed;  ///< how it moves in its parent
  int joint = -1;         ///< the mechanism's joint that this elementary joint is (part of)
  bool reversed = false;  ///< the node belongs to the joint's first link
  int q = -1;             ///< first index in q
  int v = -1;             ///< first index in v
  int freedom = 0;        ///< which freedom of the joint this is
  double pitch = 0;       ///< kScrew [m/rad]
  /// Axes of the elementary joint in the frame of the joint, which z of this node is along.
  Matrix3d R_FE = Matrix3d::Identity();
  Posed X_PF;  ///< where the node is in its parent when its coordinate is zero

  int link = -1;    ///< the link that moves with this node; -1 for a node between freedoms
  Posed X_BL;       ///< the link's drawing frame in the node
  double mass = 0;  ///< of the link [kg]; 0 between freedoms
  Vector3d p_BoBcm = Vector3d::Zero();  ///< centre of gravity, node axes [m]
  Matrix3d I_Bcm = Matrix3d::Zero();    ///< about the centre of gravity, node axes [kg m^2]
};

/// Where the two anchors of a joint are carried: F with the first link, M with the second.
struct JointPlacement {
  int first_node = -1;   ///< -1 is the ground
  int second_node = -1;  ///< -1 is the ground
  Posed X_AF;            ///< F in first_node
  Posed X_BM;            ///< M in second_node
  int tree_node = -1;    ///< the last node of the joint's chain; -1 if the joint is cut
};

/// A velocity that opens or closes a loop.
struct LoopColumn {
  int node;     ///< index in KinematicTree::nodes
  int v;        ///< index in v
  int axis;     ///< 0..2 for a spherical joint, else 0
  double sign;  ///< +1 if it moves the second anchor of the cut joint, -1 if the first
};

/// A node that lies on one side of a loop only.
struct LoopNode {
  int node;     ///< index in KinematicTree::nodes
  double sign;  ///< as LoopColumn::sign
};

/// A loop, closed by a cut joint with 6 - f equations.
struct Loop {
  int joint = -1;                         ///< the cut joint
  JointType type = JointType::kRevolute;  ///< of the cut joint
  double pitch = 0;                       ///< of a screw [m/rad]
  int row = 0;                            ///< first equation of this loop
  int rows = 0;                           ///< 6 - f
  std::vector<LoopColumn> columns;        ///< only those that are not zero
  std::vector<LoopNode> path;  ///< nodes around the loop, those without a freedom included
};

/// A mechanism prepared for computation: the spanning tree as a list of nodes, each carried by one
/// elementary joint, and the loops that the cut joints close. Immutable.
///
/// A joint with several freedoms becomes a chain of elementary joints with massless nodes between
/// them (universal = two revolutes, planar = two prismatics and a revolute, ...); only the
/// spherical joint stays whole. Elementary joints move about or along the z axis of their node.
///
/// Coordinates q [nq] and velocities v [nv] are those of the tree joints, in node order; they
/// differ for the spherical joint alone: four in q (unit quaternion w, x, y, z of R_FM), three in v
/// (angular velocity of M in F, in the axes of M).
struct KinematicTree {
  Mechanism mechanism;                     ///< with its start values
  SpanningTree spanning;                   ///< which joints are cut
  std::vector<TreeNode> nodes;             ///< parents before children
  std::vector<JointPlacement> placements;  ///< one per joint of the mechanism
  std::vector<Loop> loops;                 ///< one per cut joint
  int nq = 0;                              ///< coordinates, four for a quaternion
  int nv = 0;                              ///< velocities
  int rows = 0;                            ///< loop equations in all
  /// Indices in q of angles; lengths and quaternions are none.
  std::vector<int> revolute_coordinates;
  double length = 1;  ///< characteristic length [m]
  /// The point near the mechanism that computations are about, CentroidOfGround [m].
  Vector3d reference = Vector3d::Zero();

  /// Node that carries a link; -1 for the ground.
  int NodeOfLink(int link) const { return node_of_link[link]; }
  std::vector<int> node_of_link;      ///< [links] as NodeOfLink
  Posed X_node_link(int link) const;  ///< the link's drawing frame in its node
};

/// The numbers of a mechanism that its topology leaves open. T is double, or Dual to take the
/// derivative by one of them along.
template <typename T>
struct Design {
  /// The numbers of a link, in its drawing axes. SI units.
  struct LinkNumbers {
    T mass;                     ///< [kg]
    Vector3<T> p_LoLcm;         ///< centre of gravity [m]
    Matrix3<T> I_Lcm;           ///< about it [kg m^2]
    std::vector<Pose<T>> X_LA;  ///< anchors
  };
  /// The numbers of a joint.
  struct JointNumbers {
    T pitch;                              ///< of a screw [m/rad]
    std::array<PassiveOf<T>, 3> passive;  ///< per freedom
    LoadFrictionOf<T> load_friction;      ///< of the joint as a whole
  };
  std::vector<LinkNumbers> links;    ///< in the mechanism's order
  std::vector<JointNumbers> joints;  ///< in the mechanism's order
  Vector3<T> gravity_W;              ///< [m/s^2], world axes

  /// The same design with numbers of another type.
  template <typename S>
  Design<S> cast() const;
};
/// The numbers of a joint.
Design<double>::JointNumbers NumbersOf(const Joint& joint);
/// The numbers of a mechanism.
Design<double> DesignOf(const Mechanism& mechanism);

/// The same as nodes and placements have them: the fields of these names there.
template <typename T>
struct TreeDesign {
  /// The numbers of a node: where it stands on its parent, and its mass properties. SI units.
  struct NodeNumbers {
    Pose<T> X_PF, X_BL;                       ///< as in TreeNode
    T pitch = T(0), mass = T(0);              ///< [m/rad], [kg]
    Vector3<T> p_BoBcm = Vector3<T>::Zero();  ///< as in TreeNode [m]
    Matrix3<T> I_Bcm = Matrix3<T>::Zero();    ///< as in TreeNode [kg m^2]
  };
  /// The numbers of a joint's placement on its two links. SI units.
  struct PlacementNumbers {
    Pose<T> X_AF, X_BM;  ///< as in JointPlacement
    T pitch;             ///< of a screw [m/rad]
  };
  std::vector<NodeNumbers> nodes;            ///< in the tree's order
  std::vector<PlacementNumbers> placements;  ///< in the mechanism's order
};
/// The numbers of nodes and placements for a design of the tree's mechanism.
template <typename T>
TreeDesign<T> DesignOfTree(const KinematicTree& tree, const Design<T>& design);
/// The numbers that the tree itself has.
template <typename T>
TreeDesign<T> DesignOfTree(const KinematicTree& tree);

/// The tree of a mechanism, whose loops are cut as the options say.
/// @throws std::invalid_argument as FindSpanningTree.
KinematicTree BuildKinematicTree(Mechanism mechanism, const SpanningTreeOptions& options = {});

/// The centroid of the places on the ground at which joints are made [m].
Vector3d CentroidOfGround(const KinematicTree& tree);

/// The mechanism's start values in the coordinates of the tree. Cut joints have no part in it.
VectorXd StartCoordinates(const KinematicTree& tree);

/// One velocity of the tree as text: "pin", or "ball.ry" for a freedom of a joint with several.
std::string NameOfVelocity(const KinematicTree& tree, int v);
/// Index in v of the given freedom, from 0, of a joint; -1 if the joint is cut.
/// @throws std::invalid_argument if there is no such joint or freedom; so does CoordinateIndex.
int VelocityIndex(const KinematicTree& tree, int joint, int freedom);
/// Index in q of the given freedom, from 0, of a joint that is not spherical; -1 if it is cut.
int CoordinateIndex(const KinematicTree& tree, int joint, int freedom);

}  // namespace vmech
