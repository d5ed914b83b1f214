#include <fmt/format.h>

#include "vmech/apps/check.h"
#include "vmech/apps/commands.h"
#include "vmech/mechanisms/reader.h"

namespace vmech {

int RunCheck(const CheckArguments& arguments) {
  const MechanismCheck check = CheckMechanism(ReadMechanism(arguments.mechanism));
  fmt::print("{}", arguments.json ? JsonReport(check) : TextReport(check));
  return check.assembly.closed ? kSuccess : kNoSolution;
}

}  // namespace vmech
