// The vmech command: takes the command line apart and reports errors; no mathematics here.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "vmech/apps/commands.h"
#include "vmech/apps/completion.h"
#include "vmech/apps/console/option_error.h"
#include "vmech/apps/console/printable_streams.h"
#include "vmech/apps/console/suggestion.h"
#include "vmech/apps/import_launcher.h"
#include "vmech/mechanisms/files/document.h"

namespace {

constexpr const char* kExitCodes =
    "Exit codes: 0 done; 1 command line; 2 a file is wrong; 3 the loops do not close or the "
    "motion\n"
    "cannot be followed; 4 done, but no bearing or design meets the requirements; 5 a defect of "
    "vmech.";

/// Everything that the command line can ask for.
struct Arguments {
  vmech::CheckArguments check;
  vmech::LoadsArguments loads, simulated;
  vmech::SensitivityArguments sensitivities;
  vmech::OptimiseArguments optimise;
  vmech::ModesArguments modes;
  vmech::CompareArguments compare;
  vmech::IkArguments ik;
  vmech::HapticArguments haptic;
  vmech::ReplayArguments replay;
  vmech::DeviceArguments device;
  vmech::ViewArguments view;
  vmech::ExportArguments exported;
  std::string shell;
};

constexpr const char* kCompletionHelp =
    "Prints what a shell needs to complete the words of vmech:\n"
    "  eval \"$(vmech completion bash)\"";

void AddCommands(CLI::App* app, Arguments* arguments) {
  vmech::AddCheck(app, &arguments->check);
  vmech::AddLoads(app, &arguments->loads);
  vmech::AddSimulate(app, &arguments->simulated);
  vmech::AddSensitivities(app, &arguments->sensitivities);
  vmech::AddOptimise(app, &arguments->optimise);
  vmech::AddModes(app, &arguments->modes);
  vmech::AddCompare(app, &arguments->compare);
  app->add_subcommand("import",
                      "Makes a mechanism file of a CAD assembly, SDFormat or URDF; see `vmech "
                      "import --help`");
  vmech::AddIk(app, &arguments->ik);
  vmech::AddHaptic(app, &arguments->haptic);
  vmech::AddReplay(app, &arguments->replay);
  vmech::AddDevice(app, &arguments->device);
  vmech::AddView(app, &arguments->view);
  vmech::AddExport(app, &arguments->exported);
  app->add_subcommand("completion", kCompletionHelp)
      ->add_option("SHELL", arguments->shell, "for which shell")
      ->required()
      ->check(CLI::IsMember({"bash"}));
  app->add_subcommand("help", "Says how a command is called: vmech help COMMAND");
}

int PrintCompletion() {
  fmt::print("{}", vmech::BashCompletion());
  return vmech::kSuccess;
}

int RunCommand(const CLI::App& app, const Arguments& arguments) {
  if (app.got_subcommand("check")) return RunCheck(arguments.check);
  if (app.got_subcommand("loads")) return RunLoads(arguments.loads);
  if (app.got_subcommand("simulate")) return RunSimulate(arguments.simulated);
  if (app.got_subcommand("sensitivities")) return RunSensitivities(arguments.sensitivities);
  if (app.got_subcommand("optimise")) return RunOptimise(arguments.optimise);
  if (app.got_subcommand("modes")) return RunModes(arguments.modes);
  if (app.got_subcommand("ik")) return RunIk(arguments.ik);
  if (app.got_subcommand("haptic")) return RunHaptic(arguments.haptic);
  if (app.got_subcommand("replay")) return RunReplay(arguments.replay);
  if (app.got_subcommand("device")) return RunDevice(arguments.device);
  if (app.got_subcommand("view")) return RunView(arguments.view);
  if (app.got_subcommand("export")) return RunExport(arguments.exported);
  if (app.got_subcommand("completion")) return PrintCompletion();
  return RunCompare(arguments.compare);
}

/// A refused command line, or help and version, which CLI11 reports in the same way.
int Refuse(const CLI::App& app, const CLI::ParseError& error,
           const std::vector<std::string>& words) {
  const bool asked = error.get_exit_code() == 0;
  const auto named = words.begin() + (asked ? std::min<ptrdiff_t>(1, words.size()) : words.size());
  const std::string suggestion = vmech::Suggestion(app, {words.begin(), named});
  if (suggestion.empty()) return app.exit(error) == 0 ? vmech::kSuccess : vmech::kBadUsage;
  fmt::print(stderr, "vmech: {}\nRun with --help for more information.\n", suggestion);
  return vmech::kBadUsage;
}

int Run(const std::vector<std::string>& words) {
  CLI::App app{"vmech: mechanisms, their motion, the loads on their joints, and bearings for them",
               "vmech"};
  app.set_version_flag("-V,--version", std::string("vmech ") + VMECH_VERSION);
  app.require_subcommand(1);
  app.footer(kExitCodes);
  Arguments arguments;
  AddCommands(&app, &arguments);
  try {
    app.parse(std::vector<std::string>(words.rbegin(), words.rend()));
  } catch (const CLI::ParseError& error) {
    return Refuse(app, error, words);
  }
  const int code = RunCommand(app, arguments);
  if (std::fflush(stdout) != 0) throw vmech::FileErrors("standard output", "cannot be written");
  return code;
}

/// `vmech help COMMAND` is `vmech COMMAND --help`.
std::vector<std::string> WithoutHelpCommand(std::vector<std::string> words) {
  if (words.empty() || words[0] != "help") return words;
  if (words.size() == 1) return {"--help"};
  if (words[1] == "help" || words[1][0] == '-') return {"--help"};
  return {words[1], "--help"};
}

/// Becomes vmech-import, whose words these are.
[[noreturn]] void Import(std::vector<std::string> words) {
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  vmech::BecomeImport(pointers.data());
}

}  // namespace

int main(int argc, char** argv) {
  vmech::PrintOnlyPrintableText();
  try {
    const std::vector<std::string> words = WithoutHelpCommand({argv + 1, argv + argc});
    if (!words.empty() && words[0] == "import") Import(words);
    return Run(words);
  } catch (const vmech::FileErrors& error) {
    fmt::print(stderr, "{}\n", error.what());
    return vmech::kBadInput;
  } catch (const vmech::OptionError& error) {
    fmt::print(stderr, "vmech: {}\nRun with --help for more information.\n", error.what());
    return vmech::kBadUsage;
  } catch (const std::invalid_argument& error) {
    fmt::print(stderr, "vmech: {}\n", error.what());
    return vmech::kBadInput;
  } catch (const std::system_error& error) {
    fmt::print(stderr, "vmech: {}\n", error.what());
    return vmech::kBadInput;
  } catch (const std::runtime_error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return vmech::kNoSolution;
  } catch (const std::exception& error) {
    fmt::print(stderr, "vmech: internal error: {}\n", error.what());
    return vmech::kInternalError;
  }
}
