#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "vmech/apps/commands.h"
#include "vmech/apps/common_options.h"

namespace vmech {
namespace {

constexpr const char* kIkHelp =
    "Finds the pose of a mechanism that is nearest to that of a hand, with its loops closed and "
    "its\n"
    "limits kept, and says how good it is. Lengths and angles are in the units of the file.\n"
    "  vmech ik four-bar.yaml --target \"0.9 0.6 0\"\n"
    "  vmech ik arm.yaml --target \"300 0 450  0 90 0\" --grasp handle --start elbow=40";

/// The solvers in braces, as CLI11 shows choices.
std::string Solvers() {
  std::string names;
  for (const Backend backend : kAllBackends) {
    names += (names.empty() ? "{" : ",") + std::string(NameOf(backend));
  }
  return names + "}";
}

}  // namespace

void AddIk(CLI::App* app, IkArguments* ik) {
  CLI::App* command = app->add_subcommand("ik", kIkHelp);
  IkQuestion& question = ik->question;
  AddFile(command, "MECHANISM", &question.mechanism, "mechanism file, YAML or JSON");
  command
      ->add_option("--target", question.target,
                   "pose of the hand in the world: \"x y z\", \"x y z rx ry rz\" (rotation "
                   "vector) or \"x y z qw qx qy qz\"; without a rotation that of the start; "
                   "REQUIRED")
      ->type_name("NUMBERS");
  command
      ->add_option("--grasp", question.grasp, "the grasp by which it is held (default: the first)")
      ->type_name("NAME");
  command->add_option("--solver", question.solver, "the solver: " + Solvers())
      ->type_name("NAME")
      ->capture_default_str();
  command
      ->add_option("--start", question.start,
                   "where a joint starts, which decides the branch; may be given several times")
      ->type_name("JOINT=VALUE");
  command
      ->add_option("--stiffness", question.stiffness,
                   "stiffness of the hand along and about x, y, z [N/m, N m/rad] (default: 1 "
                   "N/m and as much over the characteristic length)")
      ->type_name("NUMBERS");
  command->add_flag("--paper-rotation", question.paper_rotation,
                    "take the rotation error of the paper (sine) instead of the angle");
  command->add_flag("--no-limits", question.no_limits, "ignore the limits of joints");
  AddSet(command, &question.set);
  AddTolerance(command, &question.tolerance);
  command->add_flag("--json", ik->json, "print JSON instead of text");
}

int RunIk(const IkArguments& arguments) {
  const IkAnswer answer = AnswerIk(arguments.question);
  fmt::print("{}", arguments.json ? JsonReport(answer) : TextReport(answer));
  const SolveStatus status = answer.summary.status;
  return status == SolveStatus::kConverged || status == SolveStatus::kBiased ? kSuccess
                                                                             : kNoSolution;
}

}  // namespace vmech
