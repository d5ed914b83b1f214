#include "vmech/mechanisms/document.h"
#include "vmech/mechanisms/exchange/urdf.h"

namespace vmech {

bool HasUrdfReader() {
  return false;
}

ImportedMechanism ReadUrdf(const std::filesystem::path& path, const ImportOptions&) {
  throw FileErrors(path.string(),
                   "cannot be read: vmech was built without urdfdom (Debian: liburdfdom-dev); "
                   "install it and build again");
}

}  // namespace vmech
