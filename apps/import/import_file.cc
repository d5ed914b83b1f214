#include "vmech/apps/import/import_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <stdexcept>

namespace vmech {

void ImportArguments::Validate() const {
  if (rpm >= -1e6 && rpm <= 1e6 && rpm != 0) return;
  throw std::invalid_argument(fmt::format("rpm = {} is not in -1e6..1e6, or zero", rpm));
}

std::string EndingOf(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

}  // namespace vmech
