#pragma once

#include <filesystem>

#include "vmech/mechanisms/exchange/imported.h"

namespace vmech {

/// SDFormat (http://sdformat.org, version 1.9), which has loops: links and joints are a graph. All
/// joints are at zero where the links are drawn, which here is the start of the mechanism.
///
///   SDF                          here
///   revolute, continuous         revolute, z the axis
///   prismatic                    prismatic, z the axis
///   screw                        screw; thread_pitch [rad/m] is -1 / pitch [m/rad], so that a
///                                right-handed thread is negative, as Gazebo has it
///   universal                    universal; axis is x, axis2 is y
///   ball                         spherical
///   fixed                        weld; to the world: that link is the ground
///   limit, damping, friction,    limits, viscous, coulomb, spring
///   spring_stiffness/_reference
///   frame                        grasp

/// Reads a model of a file, through libsdformat: the one that is asked for, or the only one that
/// moves. A world with joints between its models is one mechanism, and its static models are the
/// ground. Nested models are followed, and includes without a network (sdf_document.h). Inertias
/// that no body has are mended (mended_inertia.h). Visuals, collisions, sensors and plug-ins are
/// left out.
/// @throws FileErrors if the file cannot be read or cannot become a mechanism (gearbox, revolute2),
///         if a number is not finite, or if vmech was built without libsdformat.
ImportedMechanism ReadSdf(const std::filesystem::path& path, const ImportOptions& options = {});

/// False if vmech was built without libsdformat.
bool HasSdfReader();

/// The mechanism at its start, whose loops should be closed, as a world with one model. Cylindrical
/// and planar joints become prismatic and revolute ones with links of next to no mass between them,
/// since SDF has neither. Notes tell what is lost.
/// @throws std::invalid_argument if a name is one that SDF keeps for itself.
ExportedText WriteSdf(const Mechanism& mechanism);

/// What links without mass weigh in languages in which there are none [kg]; their radius of
/// gyration is 1 mm.
constexpr double kNextToNoMass = 1e-12;

}  // namespace vmech
