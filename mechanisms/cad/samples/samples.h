#pragma once

#include "step_writer.h"

namespace vmech::samples {

/// The sample assemblies, each in the pose in which it is drawn. Millimetres; z is up in the arm, y
/// in the planar ones.

/// A compressor of 100 mm stroke with an overhung crankshaft, a rod of 150 mm and a piston of two
/// solids, crank at 40 degrees. Its mass properties are closed forms (boxes and cylinders).
void BuildSliderCrank(StepWriter* step);
/// A crank-rocker of bars and pins: 200, 60, 180 and 120 mm. Anchors by other names than the
/// slider-crank's, as onshape-to-robot's users give them (`dof_`, `closing_`).
void BuildFourBar(StepWriter* step);
/// Two cranks on crossed axes and a rod with a ball joint at either end.
void BuildRssr(StepWriter* step);
/// An arm of an animated figure: turret, upper arm, forearm and hand, moved by four servos of one
/// kind.
void BuildArm(StepWriter* step);

}  // namespace vmech::samples
