#pragma once

#include "vmech/apps/commands.h"

namespace CLI {
class App;
}

namespace vmech {

/// `vmech sensitivities`.
void AddSensitivities(CLI::App* app, SensitivityArguments* arguments);

}  // namespace vmech
