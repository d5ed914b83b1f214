#pragma once

#include <filesystem>
#include <vector>

namespace vmech {

/// Nothing is written over what was read, by whatever path the two are named (links, "./").
/// @throws FileErrors if an output is an input, or if two outputs are one file.
void RequireOutputsApart(const std::vector<std::filesystem::path>& inputs,
                         const std::vector<std::filesystem::path>& outputs);

}  // namespace vmech
