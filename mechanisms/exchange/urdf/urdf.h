#pragma once

#include <filesystem>

#include "vmech/mechanisms/exchange/imported.h"

namespace vmech {

/// URDF (http://wiki.ros.org/urdf/XML, 1.0 and 1.1), a tree of links. Its loops come from a side
/// file, see AddLoops below. The joint frame is the drawing frame of the child link.
///
///   URDF                    here
///   revolute, continuous    revolute, z the axis
///   prismatic               prismatic, z the axis
///   planar                  planar, z the axis (the normal)
///   fixed                   weld
///   floating                weld, as mended (ImportOptions::strict)
///   limit, dynamics         limits, viscous, coulomb; the start is the place in the limits that is
///                           nearest to zero
///   mimic                   left out, with a note
///
/// Inertias that no body has are mended (mended_inertia.h). What is not for a mechanism is left
/// out, with a note. The ground is the root of the tree, unless the options name another.
/// @throws FileErrors with all that is wrong, each with its line: a number that is not finite, a
///         name that is not unique, joints that do not make a tree of all links.
ImportedMechanism ReadUrdf(const std::filesystem::path& path, const ImportOptions& options = {});

/// Adds what closes the loops of a tree, from a file in the format of mechanisms (any units):
///   vmech_loops: "1.0"
///   units: {length: mm, angle: deg}
///   links: {coupler: {anchors: {pin: {origin: [100, 0, 0]}}}, rocker: {anchors: {pin: {}}}}
///   loops: {pin: {type: revolute, connects: [coupler/pin, rocker/pin]}}
/// `links` adds anchors to those that the joints of the tree have made; it may be left out.
/// @throws FileErrors with everything that is wrong with it.
void AddLoops(const std::filesystem::path& path, Mechanism* mechanism);

}  // namespace vmech
