#include <fmt/format.h>

#include "vmech/apps/commands.h"

namespace vmech {

int RunIk(const IkArguments& arguments) {
  const IkAnswer answer = AnswerIk(arguments.question);
  fmt::print("{}", arguments.json ? JsonReport(answer) : TextReport(answer));
  const SolveStatus status = answer.summary.status;
  return status == SolveStatus::kConverged || status == SolveStatus::kBiased ? kSuccess
                                                                             : kNoSolution;
}

}  // namespace vmech
