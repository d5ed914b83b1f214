#pragma once

#include <vector>

#include "vmech/mechanisms/graph.h"
#include "vmech/mechanisms/mechanism.h"

namespace vmech {

/// X_FM of a joint at its start coordinates.
Posed StartPose(const Joint& joint);

/// Poses of the drawing frames of all links at the start coordinates of the tree joints; the axes
/// of the ground link are the world's.
std::vector<Posed> LinkStartPoses(const Mechanism& mechanism, const SpanningTree& tree);

/// One freedom of a joint as it stands at the start: a turn about, or a shift along, a line.
struct StartAxis {
  int freedom = 0;                           ///< of the joint, counted from 0
  bool rotates = true;                       ///< about the line, else along it
  Vector3d direction_W = Vector3d::UnitZ();  ///< of length 1
  Vector3d point_W = Vector3d::Zero();       ///< on the line [m]
  double coordinate = 0;                     ///< of the freedom at the start [m] or [rad]
};

/// The freedoms of a joint from its first anchor to its second; none for a spherical joint or a
/// weld, and for a screw its turn alone.
std::vector<StartAxis> StartAxes(const Joint& joint, const Posed& X_WF);

/// The same mechanism with its cylindrical and planar joints made up of prismatic and revolute
/// ones, with links without mass between them; they take the name of the joint, with a number.
Mechanism WithoutCompositeJoints(const Mechanism& mechanism);

}  // namespace vmech
