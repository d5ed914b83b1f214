#include "vmech/apps/import/other_formats.h"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <string_view>

namespace vmech {
namespace {

struct OtherFormat {
  std::string_view ending, way;
};

constexpr std::string_view kSolidWorks =
    "a document of SolidWorks: File > Save As > STEP AP242 or AP214 (*.step), from the assembly";
constexpr std::string_view kInventor =
    "a document of Autodesk Inventor: File > Export > CAD Format > STEP, from the assembly (.iam)";
constexpr std::string_view kCatia =
    "a document of CATIA V5: File > Save As > stp, from the CATProduct";
constexpr std::string_view kParasolid =
    "a Parasolid file, without names of parts in many cases: save STEP from the program that made "
    "it (SolidWorks, NX, Solid Edge, Onshape)";
constexpr std::string_view kSurfaces =
    "an exchange file that says little of assemblies: save STEP from the same program";
constexpr std::string_view kMesh =
    "a mesh, which has neither joints nor shafts: take the STEP file, URDF or SDFormat that it "
    "comes with";
constexpr std::string_view kUsd =
    "a scene of USD: write URDF or SDFormat from the program that made it (Isaac Sim: its "
    "exporter of URDF)";
constexpr std::string_view kCreo =
    "a document of Creo, NX or Solid Edge: save STEP there, from the assembly";
constexpr std::string_view kMujoco =
    "a MuJoCo model, perhaps: vmech writes these and reads none; take its URDF or SDFormat";

constexpr OtherFormat kFormats[] = {
    {".xacro", "a template of URDF: run xacro first (xacro robot.urdf.xacro > robot.urdf)"},
    {".sldasm", kSolidWorks},
    {".sldprt", kSolidWorks},
    {".slddrw", kSolidWorks},
    {".ipt", kInventor},
    {".iam", kInventor},
    {".f3d", "a document of Autodesk Fusion: File > Export > STEP Files (*.stp)"},
    {".f3z", "a document of Autodesk Fusion: File > Export > STEP Files (*.stp)"},
    {".prt", kCreo},
    {".asm", kCreo},
    {".par", kCreo},
    {".catproduct", kCatia},
    {".catpart", kCatia},
    {".cgr", kCatia},
    {".3dxml", kCatia},
    {".x_t", kParasolid},
    {".x_b", kParasolid},
    {".xmt_txt", kParasolid},
    {".igs", kSurfaces},
    {".iges", kSurfaces},
    {".brep", kSurfaces},
    {".sat", kSurfaces},
    {".sab", kSurfaces},
    {".jt", kSurfaces},
    {".stpz", "a packed STEP file: unpack it (gunzip < FILE > FILE.step)"},
    {".3dm", "a document of Rhino: File > Export Selected > STEP"},
    {".skp", "a document of SketchUp, which has meshes only: draw the shafts in a CAD program"},
    {".dwg", "a drawing: save STEP from the program that made it, if it holds solids"},
    {".dxf", "a drawing: save STEP from the program that made it, if it holds solids"},
    {".blend", "a document of Blender: write URDF or SDFormat (the add-on Phobos)"},
    {".scad", "a program of OpenSCAD, which has meshes only: FreeCAD reads it and saves STEP"},
    {".fcstd",
     "a document of FreeCAD: its add-on of vmech exports it (docs/freecad.md), or File > Export > "
     "STEP"},
    {".dae", kMesh},
    {".stl", kMesh},
    {".obj", kMesh},
    {".ply", kMesh},
    {".3mf", kMesh},
    {".gltf", kMesh},
    {".glb", kMesh},
    {".fbx", kMesh},
    {".wrl", kMesh},
    {".usd", kUsd},
    {".usda", kUsd},
    {".usdc", kUsd},
    {".usdz", kUsd},
    {".xml", kMujoco},
    {".mjcf", kMujoco},
    {".slx", "a model of Simulink: give the CAD assembly as STEP"},
    {".cmd", "a model of Adams: give the CAD assembly as STEP"},
    {".adm", "a model of Adams: give the CAD assembly as STEP"},
    {".mo", "a model of Modelica: write the mechanism by hand (docs/file-format.md)"},
    {".osim", "a model of OpenSim: write the mechanism by hand (docs/file-format.md)"},
    {".zip", "an archive: unpack it"},
    {".gz", "an archive: unpack it"},
    {".tar", "an archive: unpack it"},
    {".7z", "an archive: unpack it"},
    {".yaml", "a mechanism of vmech already, perhaps: vmech check reads it as it is"},
    {".yml", "a mechanism of vmech already, perhaps: vmech check reads it as it is"},
    {".json", "a mechanism of vmech already, perhaps: vmech check reads it as it is"},
};

}  // namespace

std::string WayRound(const std::filesystem::path& file) {
  std::string name = file.filename().string();
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const auto found =
      std::find_if(std::begin(kFormats), std::end(kFormats),
                   [&](const OtherFormat& format) { return name.ends_with(format.ending); });
  return found == std::end(kFormats) ? std::string() : std::string(found->way);
}

}  // namespace vmech
