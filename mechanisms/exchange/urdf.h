#pragma once

#include <filesystem>

#include "vmech/mechanisms/exchange/imported.h"

namespace vmech {

/// URDF (http://wiki.ros.org/urdf/XML), a tree of links. Its loops come from a side file, see
/// AddLoops below. The joint frame is the drawing frame of the child link.
///
///   URDF                    here
///   revolute, continuous    revolute, z the axis
///   prismatic               prismatic, z the axis
///   planar                  planar, z the axis (the normal)
///   fixed                   weld
///   floating                refused
///   limit, dynamics         limits, viscous, coulomb
///   mimic                   left out, with a note
///
/// Read through urdfdom. The ground is the root of the tree.
/// @throws FileErrors if the file cannot be read, if a link is the child of two joints, which
///         urdfdom lets pass, or if vmech was built without urdfdom.
ImportedMechanism ReadUrdf(const std::filesystem::path& path, const ImportOptions& options = {});

/// False if vmech was built without urdfdom.
bool HasUrdfReader();

/// Adds what closes the loops of a tree, from a file in the format of mechanisms (any units):
///   vmech_loops: "1.0"
///   units: {length: mm, angle: deg}
///   links: {coupler: {anchors: {pin: {origin: [100, 0, 0]}}}, rocker: {anchors: {pin: {}}}}
///   loops: {pin: {type: revolute, connects: [coupler/pin, rocker/pin]}}
/// @throws FileErrors with everything that is wrong with it.
void AddLoops(const std::filesystem::path& path, Mechanism* mechanism);

}  // namespace vmech
