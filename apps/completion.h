#pragma once

#include <string_view>

namespace vmech {

/// What `vmech completion bash` prints: apps/completion/vmech.bash, put here by CMake.
std::string_view BashCompletion();

}  // namespace vmech
