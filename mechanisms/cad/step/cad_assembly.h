#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "vmech/base/pose.h"

namespace vmech {

/// An assembly as a CAD system hands it over, in metres: parts with their solids and places, groups
/// of parts (subassemblies), and named frames (coordinate systems). Nothing here is a link or a
/// joint yet; mechanism_from_cad.h makes them.

/// What solids weigh at a density of 1 kg/m^3, in the axes P of the part.
struct CadVolume {
  int solids = 0;                       ///< 0: nothing that has a volume
  double volume = 0;                    ///< [m^3]
  Vector3d p_PoPcm = Vector3d::Zero();  ///< centre of the volume [m]
  Matrix3d moments = Matrix3d::Zero();  ///< integral of (r.r 1 - r r') dV about Pcm [m^5]
};

/// What a surface of a part may be to a joint.
enum class CadSurface {
  kShaft,   ///< a cylinder with the material inside
  kBore,    ///< a cylinder with the material outside
  kBall,    ///< a sphere with the material inside
  kSocket,  ///< a sphere with the material outside
  kPlane,   ///< a plane
};

/// A surface by which a part can move on another: whole cylinders (not fillets), spheres, planes.
struct CadFeature {
  CadSurface surface = CadSurface::kPlane;  ///< of which kind it is
  /// Frame F: z the axis of a cylinder, or the normal of a plane that points out of the material;
  /// origin in the middle of a cylinder, in the centre of a sphere, in a plane.
  Posed X_PF;
  double radius = 0;  ///< of a cylinder or a sphere [m]
  double length = 0;  ///< of a cylinder, along its axis [m]
  /// Box around a plane's face, in the axes of F: least and greatest x, y, z [m].
  Vector3d lower = Vector3d::Zero(), upper = Vector3d::Zero();  ///< [m]
  bool fastens = false;  ///< of a screw, rivet or pin, which sits in wider or tapped holes
};

/// Triangles for a viewer, in the axes of the part [m], corners counterclockwise seen from outside.
struct CadMesh {
  std::vector<Vector3d> vertices;             ///< [m]
  std::vector<std::array<int, 3>> triangles;  ///< indices of vertices
};

/// What a CAD file says of a material; both may be missing.
struct CadMaterial {
  std::string name;               ///< as the file calls it
  std::optional<double> density;  ///< [kg/m^3]
};

/// The geometry of a part. Repeated components share one shape.
struct CadShape {
  std::string name;  ///< as the file calls it
  CadVolume volume;  ///< at a density of 1 kg/m^3
  /// Why the volume cannot be trusted ("an open shell ..."), in words; empty if it can.
  std::string defect;
  CadMaterial material;              ///< empty where the file names none
  std::vector<CadFeature> features;  ///< by which joints are found
  CadMesh mesh;                      ///< empty unless asked for
};

/// A subassembly. Group 0 is the file itself.
struct CadGroup {
  std::string name;  ///< as the file calls it
  int parent = -1;   ///< index of the group around it; -1 of group 0
  Posed X_WG;        ///< axes of the group in those of the file
};

/// A shape in its place.
struct CadPart {
  std::string name;  ///< of the component
  int shape = -1;    ///< index of the shape
  int group = 0;     ///< index of the group around it
  Posed X_WP;        ///< W: the axes of the file
};

/// A named coordinate system: a component without a shape.
struct CadFrame {
  std::string name;  ///< as the file calls it
  int group = 0;     ///< index of the group around it
  Posed X_WF;        ///< W: the axes of the file
};

/// An assembly as a STEP file has it: shapes, parts in groups, named frames. SI units.
struct CadAssembly {
  std::string file;                  ///< for messages
  std::string unit;                  ///< of length, as the file names it; empty if it does not
  std::vector<CadShape> shapes;      ///< each once, however often it is placed
  std::vector<CadGroup> groups;      ///< parents before children
  std::vector<CadPart> parts;        ///< in the order of the file
  std::vector<CadFrame> frames;      ///< in the order of the file
  std::vector<std::string> remarks;  ///< what was passed over or assumed
};

}  // namespace vmech
