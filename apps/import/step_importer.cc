#include "vmech/apps/import/importers.h"
#include "vmech/apps/import/stl.h"
#include "vmech/apps/import/study_text.h"
#include "vmech/mechanisms/plausibility.h"

namespace vmech {
namespace {

/// The meshes of the parts of each body, in the axes of its link.
std::map<std::string, std::string> LinkMeshes(const CadAssembly& assembly,
                                              const CadImport& import) {
  std::map<std::string, std::string> meshes;
  for (const ImportedBody& body : import.bodies) {
    CadMesh all;
    for (const BodyMass::Part& weighed : body.mass.parts) {
      const CadPart& part = assembly.parts[weighed.part];
      AppendMesh(assembly.shapes[part.shape].mesh, body.X_WL.inverse() * part.X_WP, &all);
    }
    if (!all.triangles.empty()) meshes[import.mechanism.links[body.link].name] = BinaryStl(all);
  }
  return meshes;
}

}  // namespace

ImportedFile ImportStep(const ImportArguments& arguments) {
  constexpr double kMeshDeflection = 1e-4;  // [m]
  StepReadOptions step = arguments.step;
  if (!arguments.meshes.empty()) step.mesh_deflection = kMeshDeflection;
  const CadAssembly assembly = ReadStep(arguments.file, step);
  CadImport import = MechanismFromCad(assembly, arguments.cad);
  ImportedFile result;
  if (!arguments.study.empty()) {
    result.study = StudyText(import, arguments.drives, arguments.rpm, &import.guesses);
  }
  if (!arguments.meshes.empty()) result.meshes = LinkMeshes(assembly, import);
  for (const ImportedBody& body : import.bodies) {
    for (const BodyMass::Part& part : body.mass.parts) {
      for (std::string& doubt : DoubtsOfDensity("part '" + part.name + "'", part.density)) {
        result.doubts.push_back(std::move(doubt));
      }
    }
  }
  result.report = import.FullReport();
  result.guesses = import.guesses;
  result.mechanism = std::move(import.mechanism);
  return result;
}

}  // namespace vmech
