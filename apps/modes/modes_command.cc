#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "vmech/apps/commands.h"
#include "vmech/apps/common_options.h"
#include "vmech/apps/files/file_kind.h"
#include "vmech/apps/files/inputs_apart.h"
#include "vmech/apps/files/output_folder.h"
#include "vmech/apps/files/parameter_options.h"
#include "vmech/apps/modes/mode_studies.h"
#include "vmech/apps/modes/modes_report.h"
#include "vmech/dynamics/simulation/equilibrium.h"
#include "vmech/dynamics/simulation/modes.h"
#include "vmech/mechanisms/files/reader.h"
#include "vmech/studies/study.h"
#include "vmech/studies/study_reader.h"

namespace vmech {
namespace {

constexpr const char* kModesHelp =
    "Finds where a mechanism rests under weight, springs, motors and loads, downhill from its\n"
    "start, and says whether it stays there, how fast it swings about it, how that is damped, and\n"
    "in which shapes. Dry friction and limits are left out.";

namespace fs = std::filesystem;

/// What a file asks about, and the files that this was read from.
struct Asked {
  Simulation simulation;
  std::vector<fs::path> inputs;
};

using Settings = std::span<const ParameterSetting>;

Asked AskedOfStudy(const fs::path& path, Settings settings) {
  const StudyFile file = ReadStudy(path, settings);
  if (!file.simulation) {
    throw FileErrors(path.string(),
                     fmt::format("moves as it is told: it has no block `simulation`; "
                                 "`vmech modes` takes one that has, or the mechanism, {}",
                                 file.mechanism_path.string()));
  }
  Asked asked{SimulationOf(file), {}};
  for (const InputFile& input : file.inputs) asked.inputs.push_back(input.path);
  return asked;
}

Asked AskedOf(const ModesArguments& arguments, Settings settings) {
  Asked asked;
  if (KindOfFile(arguments.file) == FileKind::kStudy) {
    asked = AskedOfStudy(arguments.file, settings);
  } else {
    asked.simulation.mechanism =
        ReadAs({"modes", {FileKind::kMechanism, FileKind::kStudy}}, arguments.file,
               [&](const fs::path& path) { return ReadMechanism(path, settings); });
    asked.simulation.units = asked.simulation.mechanism.units;
    asked.simulation.times = {0, 1};
    asked.inputs = {arguments.file};
  }
  if (arguments.tolerance) asked.simulation.mechanism.tolerance = *arguments.tolerance;
  asked.simulation.start = SimulationStart::kEquilibrium;
  return asked;
}

void WriteModes(const Modes& modes, const Asked& asked, const fs::path& out) {
  std::vector<NamedText> files = ModeStudies(modes, asked.simulation);
  files.push_back({"modes.csv", ModesTable(modes)});
  std::vector<fs::path> outputs;
  for (const NamedText& file : files) outputs.push_back(out / file.name);
  RequireOutputsApart(asked.inputs, outputs);
  OutputFolder folder(out);
  for (const NamedText& file : files) folder.Write(file.name, file.text);
  folder.Commit();
}

std::string WhereTheyAre(const Modes& modes, const fs::path& out) {
  if (modes.modes.empty()) return fmt::format("written to {}\n", out.string());
  return fmt::format("written to {}; `vmech view {}` shows the first mode\n", out.string(),
                     (out / "mode-1.yaml").string());
}

void Answer(Asked asked, const ModesArguments& arguments) {
  asked.simulation = AtItsStart(asked.simulation);
  const Modes modes = FindModes(asked.simulation);
  fmt::print("{}", ModesText(modes, asked.simulation.mechanism));
  for (const std::string& warning : ModesWarnings(modes, asked.simulation.mechanism)) {
    fmt::print("warning: {}\n", warning);
  }
  if (arguments.out.empty()) return;
  WriteModes(modes, asked, arguments.out);
  fmt::print("{}", WhereTheyAre(modes, arguments.out));
}

}  // namespace

void AddModes(CLI::App* app, ModesArguments* modes) {
  CLI::App* command = app->add_subcommand("modes", kModesHelp);
  AddFile(command, "FILE", &modes->file, "mechanism, or study with a block `simulation`");
  command
      ->add_option("--out", modes->out,
                   "folder for modes.csv, and for a study of each mode, which vmech view plays")
      ->type_name("DIR");
  AddSet(command, &modes->set);
  AddTolerance(command, &modes->tolerance);
}

int RunModes(const ModesArguments& arguments) {
  Asked asked = ReadWithSettings(arguments.set,
                                 [&](Settings settings) { return AskedOf(arguments, settings); });
  try {
    Answer(std::move(asked), arguments);
  } catch (const FileErrors&) {
    throw;
  } catch (const std::invalid_argument& error) {
    throw FileErrors(arguments.file.string(), error.what());
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(fmt::format("{}: {}", arguments.file.string(), error.what()));
  }
  return kSuccess;
}

}  // namespace vmech
