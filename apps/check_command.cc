#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "vmech/apps/check.h"
#include "vmech/apps/commands.h"
#include "vmech/mechanisms/document.h"
#include "vmech/mechanisms/reader.h"

namespace vmech {

namespace {

Mechanism ReadOrRedirect(const std::filesystem::path& path) {
  try {
    return ReadMechanism(path);
  } catch (const FileErrors& errors) {
    const auto has = [&](std::string_view key) {
      return std::any_of(errors.errors().begin(), errors.errors().end(),
                         [&](const FileError& error) { return error.path == key; });
    };
    if (has("vmech_study")) {
      throw FileErrors(path.string(),
                       "is a study; `vmech loads` runs it, `vmech check` takes the mechanism that "
                       "it names");
    }
    if (has("vmech_suite")) {
      throw FileErrors(path.string(),
                       "is a suite; `vmech compare` runs it, `vmech check` takes the mechanisms "
                       "that it names");
    }
    throw;
  }
}

}  // namespace

int RunCheck(const CheckArguments& arguments) {
  Mechanism mechanism = ReadOrRedirect(arguments.mechanism);
  if (arguments.tolerance) mechanism.tolerance = *arguments.tolerance;
  const MechanismCheck check = CheckMechanism(mechanism);
  fmt::print("{}", arguments.json ? JsonReport(check) : TextReport(check));
  return check.closed() ? kSuccess : kNoSolution;
}

}  // namespace vmech
