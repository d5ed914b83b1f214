#pragma once

#include <string>

#include "vmech/mechanisms/cad/step/cad_assembly.h"

namespace vmech {

/// Adds a mesh whose axes are P to one in the axes L.
void AppendMesh(const CadMesh& mesh, const Posed& X_LP, CadMesh* sum);

/// The bytes of a binary STL file, in metres, as SDFormat, URDF and MuJoCo take them.
std::string BinaryStl(const CadMesh& mesh);

}  // namespace vmech
