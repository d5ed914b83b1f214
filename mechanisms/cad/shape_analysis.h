#pragma once

#include <vector>

#include "vmech/mechanisms/cad/step/cad_assembly.h"

class TopoDS_Shape;
class gp_Trsf;

namespace vmech {

/// What step_reader.cc asks of Open CASCADE's shapes. Open CASCADE works in millimetres here; the
/// results are in metres.
constexpr double kMetresPerMillimetre = 1e-3;

/// The pose of a placement without mirror and scale.
Posed PoseFrom(const gp_Trsf& placement);

/// Volume, centre and moments of the solids of a shape, by Gauss quadrature over their faces.
CadVolume MeasureVolume(const TopoDS_Shape& shape);

/// What is wrong with the solids of a shape: none at all, open shells, edges with three faces, no
/// volume; empty if nothing is.
std::string FindDefect(const TopoDS_Shape& shape, const CadVolume& volume);

/// Cylinders (joined where they are split by seams), spheres and planes.
std::vector<CadFeature> FindFeatures(const TopoDS_Shape& shape);

/// Triangles at most `deflection` [m] off the surface.
CadMesh MakeMesh(const TopoDS_Shape& shape, double deflection);

/// True if the shape has a face: frames and wires have none.
bool HasFaces(const TopoDS_Shape& shape);

}  // namespace vmech
