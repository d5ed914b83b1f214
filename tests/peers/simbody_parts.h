#pragma once

#include <Simbody.h>

#include <utility>
#include <vector>

#include "vmech/mechanisms/mechanism.h"

namespace vmech::peers {

/// The words of vmech in those of Simbody, and back. A SpatialVec has the angular part first.
SimTK::Vec3 ToSimTK(const Vector3d& v);
SimTK::Transform ToSimTK(const Posed& X);
SimTK::SpatialVec ToSimTK(const Wrenchd& w);
SimTK::MassProperties ToSimTK(const MassProperties& m);
Vector3d FromSimTK(const SimTK::Vec3& v);
Wrenchd FromSimTK(const SimTK::SpatialVec& w);
Posed FromSimTK(const SimTK::Transform& X);

/// The frame at which Simbody makes a joint on our anchor: its slider moves along x, ours along z.
Posed FrameForSimbody(JointType type, const Posed& X_LA);

/// Simbody's index of a freedom, which JointType may list in another order.
SimTK::MobilizerUIndex SpeedIndex(JointType type, int freedom);

/// Hangs a new body, by its frame `outboard`, on the frame `inboard` of its parent.
SimTK::MobilizedBody AddMobilizer(const Joint& joint, SimTK::MobilizedBody& parent,
                                  const SimTK::Transform& inboard, const SimTK::Body& body,
                                  const SimTK::Transform& outboard,
                                  SimTK::MobilizedBody::Direction direction);

/// A joint as single equations: the origin of M stays in planes of F, axes stay perpendicular.
struct LoopEquations {
  std::vector<int> plane_normals;                   ///< axes of F
  std::vector<std::pair<int, int>> perpendiculars;  ///< an axis of F, an axis of M
};

/// @throws std::invalid_argument for a screw.
LoopEquations EquationsOf(JointType type);

}  // namespace vmech::peers
