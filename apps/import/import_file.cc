#include "vmech/apps/import/import_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <stdexcept>

#include "vmech/apps/import/doors.h"
#include "vmech/apps/import/other_formats.h"
#include "vmech/mechanisms/document.h"

namespace vmech {

void ImportArguments::Validate() const {
  if (rpm >= -1e6 && rpm <= 1e6 && rpm != 0) return;
  throw std::invalid_argument(fmt::format("rpm = {} is not in -1e6..1e6, or zero", rpm));
}

const std::vector<ImportDoor>& ImportDoors() {
  static const std::vector<ImportDoor> doors{
      {{".step", ".stp", ".p21"}, "STEP", ImportStep},
      {{".sdf", ".world"}, "SDFormat", ImportSdf},
      {{".urdf"}, "URDF", ImportUrdf},
  };
  return doors;
}

std::string EndingOf(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

const ImportDoor& DoorFor(const std::filesystem::path& file) {
  const std::string ending = EndingOf(file);
  std::string known;
  for (const ImportDoor& door : ImportDoors()) {
    for (const std::string_view each : door.endings) {
      if (each == ending) return door;
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
