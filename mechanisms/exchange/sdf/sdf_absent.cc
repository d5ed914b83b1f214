#include "vmech/mechanisms/exchange/sdf/sdf.h"
#include "vmech/mechanisms/files/document.h"

namespace vmech {

bool HasSdfReader() {
  return false;
}

ImportedMechanism ReadSdf(const std::filesystem::path& path, const ImportOptions&) {
  throw FileErrors(path.string(),
                   "cannot be read: vmech was built without libsdformat (Debian: "
                   "libsdformat-dev); install it and build again");
}

}  // namespace vmech
