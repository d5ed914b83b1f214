#include "vmech/apps/common_options.h"

#include <CLI/CLI.hpp>

#include "vmech/apps/console/number_within.h"
#include "vmech/mechanisms/mechanism.h"

namespace vmech {

void AddFile(CLI::App* command, const char* name, std::filesystem::path* file, const char* what) {
  command->add_option(name, *file, what)->required()->type_name("FILE");
}

void AddTolerance(CLI::App* command, std::optional<double>* tolerance) {
  command
      ->add_option("--tolerance", *tolerance,
                   "how far rounded figures may keep loops from closing, in rad and parts of the "
                   "mechanism's length (default: that of the mechanism file, or 1e-4)")
      ->check(NumberWithin(0.0, kWidestTolerance, "0..0.01"))
      ->type_name("NUMBER");
}

void AddSet(CLI::App* command, std::vector<std::string>* set) {
  command
      ->add_option("--set", *set,
                   "value of a parameter of the file, a number or an expression; may be given "
                   "several times")
      ->allow_extra_args(false)
      ->type_name("NAME=VALUE");
}

void AddStrict(CLI::App* command, bool* strict) {
  command->add_flag("--strict", *strict, "treat warnings as errors: exit code 2");
}

void AddQuiet(CLI::App* command, bool* quiet) {
  command->add_flag("-q,--quiet", *quiet, "print errors alone");
}

}  // namespace vmech
