#pragma once

#include "vmech/apps/commands.h"

namespace CLI {
class App;
}

namespace vmech {

/// `vmech haptic`: how the handle moves the mechanism, and what is known of it.
void AddWorkspace(CLI::App* command, HapticArguments* haptic);

/// `vmech device`.
void AddDevice(CLI::App* app, DeviceArguments* device);

}  // namespace vmech
