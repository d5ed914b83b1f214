#pragma once

#include "vmech/apps/import/import_file.h"

namespace vmech {

/// Imports, checks that the result can be read and assembles it on trial, and writes all files or
/// none. @return an ExitCode. @throws FileErrors, std::invalid_argument.
int RunImport(ImportArguments arguments);

}  // namespace vmech
