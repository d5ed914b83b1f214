#pragma once

#include <span>
#include <string>
#include <vector>

#include "vmech/mechanisms/dh/dh_parameters.h"
#include "vmech/mechanisms/graph.h"
#include "vmech/mechanisms/mechanism.h"

namespace vmech {

/// What moves along a row.
enum class DhMotion { kFixed, kRotation, kTranslation, kScrew };

/// A row of a Denavit-Hartenberg table: how the frame at its end lies in that at its beginning.
struct DhRow {
  std::string axis;  ///< whose axis z of the end frame is: "pin", "ball.ry", "grasp tip", ...
  int from = -1;     ///< row at whose end frame this one begins; -1: the world
  int link = -1;     ///< link to which the end frame is fixed; -1 between the freedoms of a joint
  DhMotion motion = DhMotion::kFixed;  ///< which of its parameters moves
  int joint = -1;                      ///< index in Mechanism::joints of what moves; -1: nothing
  int freedom = 0;                     ///< which of the joint's freedoms
  double pitch = 0;                    ///< kScrew: d + pitch q [m/rad]
  DhParameters parameters;             ///< at coordinate 0 of what moves
  double gamma = 0;                    ///< [rad]
  double b = 0;                        ///< [m]
  AxesRelation relation = AxesRelation::kCoincident;  ///< of the axes at both ends
};

/// Denavit-Hartenberg parameters of a mechanism, along its spanning tree. The axes are those of the
/// links: they do not depend on the pose.
///
/// A link has one axis by which it is carried (the ground: z of the world) and one for each joint,
/// cut joint and grasp that it carries. The row of such an axis leads to it from the frame of the
/// carrying joint,
///   X = Rz(theta + gamma + q) Tz(d + b) Tx(a) Rx(alpha) Ry(beta)        of a rotation,
///   X = Rz(theta + gamma) Tz(d + b + q) Tx(a) Rx(alpha) Ry(beta)        of a translation,
/// where the first axis of a link has gamma = b = 0 and its frame is the frame of the link. The
/// others are the branches, with the two extra parameters of [Khalil & Kleinfinger 1986], which
/// turn the first normal into theirs. A grasp, and either side of a cut joint, is a frame and not
/// only an axis: it takes a second row, with theta and d alone.
///
/// A joint with several freedoms is a chain of elementary joints with links of no length between
/// them: cylindrical along z, about z; universal about x, about y; planar along x, along y, about
/// z; spherical about x, about y, about z. A joint that the tree passes from its second link to its
/// first is the chain backwards, about the opposite axes, so that q keeps its sign.
struct DhTable {
  std::vector<DhRow> rows;         ///< each after the one at which it begins
  std::vector<int> row_of_link;    ///< whose end frame is the frame of the link
  std::vector<Posed> link_frames;  ///< X_LD, that frame in the link's drawing frame
  std::vector<int> row_of_grasp;   ///< whose end frame is the grasp
};

/// The rows of all links, cut joints and grasps of a mechanism, along its tree.
DhTable DeduceDhTable(const Mechanism& mechanism, const SpanningTree& tree);

/// Poses of the end frames of all rows in the world, from the coordinates of all joints as in
/// Joint::start. Cut joints have no part in it.
std::vector<Posed> DhPoses(const DhTable& table,
                           std::span<const std::vector<double>> joint_coordinates);

/// The same mechanism drawn in its link frames: anchors, grasps and mass properties are moved into
/// them. The ground link, in whose axes gravity and the world are, stays as it is.
Mechanism DrawnInLinkFrames(const Mechanism& mechanism, const DhTable& table);

}  // namespace vmech
