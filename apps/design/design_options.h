#pragma once

#include "vmech/apps/commands.h"

namespace CLI {
class App;
}

namespace vmech {

/// `vmech sensitivities`.
void AddSensitivities(CLI::App* app, SensitivityArguments* arguments);

/// `vmech optimise`.
void AddOptimise(CLI::App* app, OptimiseArguments* arguments);

}  // namespace vmech
