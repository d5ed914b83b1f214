#include "vmech/mechanisms/cad/step/step_reader.h"
#include "vmech/mechanisms/files/document.h"

namespace vmech {

bool HasStepReader() {
  return false;
}

CadAssembly ReadStep(const std::filesystem::path& path, const StepReadOptions& options) {
  options.Validate();
  throw FileErrors(
      path.string(),
      "vmech was built without Open CASCADE, which reads STEP; install the group `cad` "
      "of packages.txt and build again");
}

}  // namespace vmech
