#pragma once

#include <filesystem>
#include <functional>
#include <string_view>
#include <vector>

#include "vmech/apps/import/import_file.h"

namespace vmech {

/// What reads the files of other programs. All throw FileErrors.

/// STEP, by mechanisms/cad; std::invalid_argument for a driven joint that there is not.
ImportedFile ImportStep(const ImportArguments& arguments);
/// SDFormat and URDF, by mechanisms/exchange.
ImportedFile ImportSdf(const ImportArguments& arguments);
ImportedFile ImportUrdf(const ImportArguments& arguments);

/// A kind of file that can be read, by the endings of its name (".urdf").
struct Importer {
  std::vector<std::string_view> endings;
  std::string_view what;
  std::function<ImportedFile(const ImportArguments&)> read;
};
const std::vector<Importer>& Importers();

/// The importer of a file. @throws FileErrors if its ending is none that is known.
const Importer& ImporterFor(const std::filesystem::path& file);

}  // namespace vmech
