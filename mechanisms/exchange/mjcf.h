#pragma once

#include "vmech/mechanisms/exchange/imported.h"

namespace vmech {

/// The mechanism at its start, whose loops should be closed, as a model of MuJoCo (MJCF, 2.2 and
/// later). Its coordinates are those of the tree joints, counted from the start; a joint with
/// several freedoms has a hinge or slide for each ("cross.rx", "cross.ry").
///
/// Loops are closed by `<equality>`, which MuJoCo holds by stiff springs: at spherical joints if
/// there are any, then at revolute ones.
///
///   cut joint                   here
///   spherical                   `<connect>` at its centre
///   revolute                    two `<connect>`, a characteristic length apart on its axis
///   weld                        `<weld>`
///   others                      a light carriage on the first link takes up all freedoms but the
///                               last turn, and is cut from the second link by one of the above
///
/// Capsules between the anchors of a link are there to be seen, they touch and weigh nothing.
/// Notes tell what is lost.
/// @throws std::invalid_argument if a link that moves is called "world".
ExportedText WriteMjcf(const Mechanism& mechanism);

}  // namespace vmech
