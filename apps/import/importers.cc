#include "vmech/apps/import/importers.h"

#include <fmt/format.h>

#include "vmech/apps/import/other_formats.h"
#include "vmech/mechanisms/files/file_errors.h"

namespace vmech {

const std::vector<Importer>& Importers() {
  static const std::vector<Importer> importers{
      {{".step", ".stp", ".p21"}, "STEP", ImportStep},
      {{".sdf", ".world"}, "SDFormat", ImportSdf},
      {{".urdf"}, "URDF", ImportUrdf},
  };
  return importers;
}

const Importer& ImporterFor(const std::filesystem::path& file) {
  const std::string ending = EndingOf(file);
  std::string known;
  for (const Importer& importer : Importers()) {
    for (const std::string_view each : importer.endings) {
      if (each == ending) return importer;
      known += fmt::format("{}{}", known.empty() ? "" : ", ", each);
    }
  }
  const std::string way = WayRound(file);
  if (!way.empty()) throw FileErrors(file.string(), fmt::format("{}; read are: {}", way, known));
  throw FileErrors(file.string(),
                   fmt::format("files are known by the ending of their name, and "
                               "{} is none of: {}",
                               ending.empty() ? "no ending" : Quoted(ending), known));
}

}  // namespace vmech
