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

// Without anchors: joints, screws and pins are found by their surfaces.

/// A door on two hinges, each of two leaves, a pin of 7.98 mm in bores of 8 mm and four screws of
/// 4 mm in clearance holes of 4.5 mm and core holes of 3.2 mm.
void BuildDoor(StepWriter* step);
/// A compressor with the play of real ones: pins of 9.98 mm in 10 mm, a pressed crank pin, 0.3 mm
/// of end play at the rod.
void BuildPump(StepWriter* step);
/// A crank-rocker whose rocker is the mirror image of its crank but for the length, with four equal
/// bolts; rod and bolts stand in nested subassemblies whose names end in letters beyond ASCII.
void BuildLinkage(StepWriter* step);

}  // namespace vmech::samples
