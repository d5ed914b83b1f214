#include <CLI/CLI.hpp>

#include "vmech/apps/commands.h"
#include "vmech/apps/common_options.h"

namespace vmech {
namespace {

constexpr const char* kSensitivitiesHelp =
    "Says how the figures of a study - peak forces, drives, lives of bearings, mass - go with the\n"
    "dimensions and masses of its mechanism: exact derivatives, and which matters most. With "
    "--out:\n"
    "  sensitivities.csv  every derivative\n"
    "  report.html        charts and tables, to read and to pass on";

constexpr const char* kOptimiseHelp =
    "Searches the best design of a study's mechanism within bounds, by exact derivatives:\n"
    "  vmech optimise study.yaml --minimise main.drive --vary crank/pin.x=40..60 \\\n"
    "      --vary coupler.mass=0.2..0.5 --keep 'pin.life>=10000' --out better\n"
    "Parameters and figures are those of vmech sensitivities. With --out:\n"
    "  design.csv      parameters and figures as they were and as they are\n"
    "  mechanism.yaml  the mechanism with the best design\n"
    "  report.html     the design as one page, and what would give more";

}  // namespace

void AddSensitivities(CLI::App* app, SensitivityArguments* arguments) {
  CLI::App* command = app->add_subcommand("sensitivities", kSensitivitiesHelp);
  AddFile(command, "STUDY", &arguments->study, "study file, YAML or JSON");
  command
      ->add_option("--by", arguments->by,
                   "parameters, as crank/pin.x, coupler.mass or coupler.center_of_gravity.y "
                   "(default: all that "
                   "are not zero)")
      ->delimiter(',')
      ->type_name("NAMES");
  command
      ->add_option("--of", arguments->of,
                   "figures, as pin.force, main.drive.rms, wrist.life, ground.force, handle.path, "
                   "transmission or mass (default: all peaks and lives, and the mass)")
      ->delimiter(',')
      ->type_name("NAMES");
  command->add_flag("--undetermined", arguments->undetermined,
                    "also of figures that statics does not determine, by the study's rule");
  AddSet(command, &arguments->set);
  command->add_option("--out", arguments->out, "folder for table and report (default: none)")
      ->type_name("DIR");
  command->add_option("--threads", arguments->threads, "0 for one per processor")
      ->check(CLI::Range(0, 64, "0..64"))
      ->capture_default_str();
  AddQuiet(command, &arguments->quiet);
}

void AddOptimise(CLI::App* app, OptimiseArguments* arguments) {
  CLI::App* command = app->add_subcommand("optimise", kOptimiseHelp);
  AddFile(command, "STUDY", &arguments->study, "study file, YAML or JSON");
  CLI::Option* minimise =
      command->add_option("--minimise", arguments->minimise, "the figure to make small")
          ->type_name("FIGURE");
  command->add_option("--maximise", arguments->maximise, "the figure to make large")
      ->type_name("FIGURE")
      ->excludes(minimise);
  command
      ->add_option("--vary", arguments->vary,
                   "a parameter and its bounds, in its unit; may be given several times; REQUIRED")
      ->type_name("NAME=LOW..HIGH");
  command
      ->add_option("--keep", arguments->keep,
                   "what a figure must keep, as 'pin.life>=10000' or 'mass<=1.2'; may be given "
                   "several times")
      ->type_name("FIGURE<=LIMIT");
  command->add_option("--method", arguments->method, "slsqp and mma of NLopt, or ipopt")
      ->check(CLI::IsMember({"slsqp", "mma", "ipopt"}))
      ->capture_default_str();
  command
      ->add_option("--starts", arguments->starts,
                   "how many designs to start from: the one that is there, and others spread over "
                   "the bounds")
      ->check(CLI::Range(1, 1000, "1..1000"))
      ->capture_default_str();
  command->add_flag("--undetermined", arguments->undetermined,
                    "also by figures that statics does not determine, by the study's rule");
  AddSet(command, &arguments->set);
  command->add_option("--out", arguments->out, "folder for the design (default: none)")
      ->type_name("DIR");
  command->add_flag("--resume", arguments->resume,
                    "go on with the search in the folder of --out that was interrupted");
  command->add_option("--threads", arguments->threads, "0 for one per processor")
      ->check(CLI::Range(0, 64, "0..64"))
      ->capture_default_str();
  AddQuiet(command, &arguments->quiet);
}

}  // namespace vmech
