#include "vmech/apps/import_launcher.h"

#include <unistd.h>

#include <filesystem>
#include <string>

#include "vmech/mechanisms/files/document.h"

namespace vmech {

void BecomeImport(char** arguments) {
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe");
  const std::string program = self.parent_path() / "vmech-import";
  execv(program.c_str(), arguments);
  throw FileErrors(program, "is missing; it is built and installed together with vmech");
}

}  // namespace vmech
