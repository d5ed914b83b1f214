#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace vmech {

/// Options that several commands have.

/// The file that a command cannot do without, by the name that its help gives it.
void AddFile(CLI::App* command, const char* name, std::filesystem::path* file, const char* what);
/// `--tolerance`, within which loops of rounded figures close.
void AddTolerance(CLI::App* command, std::optional<double>* tolerance);
/// `--set NAME=VALUE`, parameters of the file.
void AddSet(CLI::App* command, std::vector<std::string>* set);
/// `--strict`: warnings are errors.
void AddStrict(CLI::App* command, bool* strict);
/// `--quiet`.
void AddQuiet(CLI::App* command, bool* quiet);

}  // namespace vmech
