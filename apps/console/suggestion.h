#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace vmech {

/// What is likely meant by a command line that was refused: a command or an option whose name is
/// nearly that of a known one, or which there is not. Empty if all names are known.
std::string Suggestion(const CLI::App& app, const std::vector<std::string>& words);

}  // namespace vmech
