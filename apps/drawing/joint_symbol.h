#pragma once

#include <string>

#include "vmech/apps/plot/svg.h"
#include "vmech/mechanisms/joint_type.h"

namespace vmech {

/// A joint in a drawing [drawing units].
struct JointSymbol {
  JointType type = JointType::kRevolute;
  plot::Point at;    ///< its pivot
  plot::Point axis;  ///< its z axis, of length 1 where it lies in the plane of the drawing
  std::string box_css = "symbol";  ///< of what slides
};

/// The symbol of a joint: a circle for what turns, a box for what slides, with a mark for each
/// further freedom, and a dot of class `pivot` at its place.
void DrawJoint(const JointSymbol& joint, plot::SvgWriter* svg);

/// What holds a joint to the ground: a hatched foot, or hatches along a slide.
void DrawGround(const JointSymbol& joint, plot::SvgWriter* svg);

}  // namespace vmech
