#pragma once

#include <string>
#include <vector>

#include "vmech/mechanisms/cad/bodies.h"

namespace vmech {

/// Bodies that are no links of their own: what the user joins, and fasteners. A screw in its hole
/// can spin, and that is all: it carries no freedom of the mechanism.
///
/// A **screw, rivet or pin** is a part without coordinate systems that
///   - sits by a shaft in bores, and touches others by shafts, bores and planes about one axis
///   only;
///   - is located: a plane stops it along the axis, or it joins two bodies;
///   - is slim: its radius of gyration about the axis is at most sqrt(2) times the radius of its
///     thickest fit (1 / sqrt(2) of it for a cylinder, 1 for hexagon bolts), and its centre of
///     gravity lies on the axis;
///   - is no larger than the largest body that it touches.
/// A **nut or washer** sits around such a one, seats on a plane, and is flat and narrow.
///
/// A fastener belongs to the body in which it sits most tightly. What it joins stays joined by it:
/// a hinge pin becomes part of one leaf, about which the other turns.
///
/// If nothing would be left to move, there are no fasteners: the only shaft in a housing turns.

/// A body that became a part of another.
struct BodyMerge {
  std::string body, into;  ///< names of bodies
  std::string why;         ///< "fastener: shaft of 4 mm in a bore of 4 mm", "asked for (--weld)"
  bool is_guess = false;   ///< nobody asked for it
};

/// Joins the bodies of BodyOptions::weld, the parts of BodyOptions::rigid with what they touch most
/// tightly, and fasteners but those in BodyOptions::moving. The first of a list of welded bodies
/// stays, unless another is the ground by its name or `ground`; bodies keep their order.
/// @throws FileErrors if a rigid part touches nothing, or a name to be welded is left out.
std::vector<BodyMerge> MergeBodies(const CadAssembly& assembly, const BodyOptions& options,
                                   const ContactOptions& contacts, const std::string& ground,
                                   std::vector<CadBody>* bodies);

}  // namespace vmech
