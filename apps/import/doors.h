#pragma once

#include "vmech/apps/import/import_file.h"

namespace vmech {

/// The doors by which files come in. All throw FileErrors.

/// STEP, by mechanisms/cad; std::invalid_argument for a driven joint that there is not.
ImportedFile ImportStep(const ImportArguments& arguments);
/// SDFormat and URDF, by mechanisms/exchange.
ImportedFile ImportSdf(const ImportArguments& arguments);
ImportedFile ImportUrdf(const ImportArguments& arguments);

}  // namespace vmech
