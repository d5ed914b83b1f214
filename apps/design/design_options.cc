#include "vmech/apps/design/design_options.h"

#include <CLI/CLI.hpp>

namespace vmech {
namespace {

constexpr const char* kSensitivitiesHelp =
    "Says how the figures of a study - peak forces, drives, lives of bearings, mass - go with the\n"
    "dimensions and masses of its mechanism: exact derivatives, and which matters most. With "
    "--out:\n"
    "  sensitivities.csv  every derivative\n"
    "  report.html        charts and tables to read and hand on";

}  // namespace

void AddSensitivities(CLI::App* app, SensitivityArguments* arguments) {
  CLI::App* command = app->add_subcommand("sensitivities", kSensitivitiesHelp);
  command->add_option("STUDY", arguments->study, "study file, YAML or JSON")
      ->required()
      ->type_name("FILE");
  command
      ->add_option("--by", arguments->by,
                   "parameters, as crank/pin.x, coupler.mass or coupler.center_of_gravity.y "
                   "(default: all that "
                   "are not zero)")
      ->delimiter(',')
      ->type_name("NAMES");
  command
      ->add_option("--of", arguments->of,
                   "figures, as pin.force, main.drive.rms, wrist.life, ground.force or mass "
                   "(default: all peaks and lives, and the mass)")
      ->delimiter(',')
      ->type_name("NAMES");
  command->add_flag("--undetermined", arguments->undetermined,
                    "also of figures that statics does not determine, by the study's rule");
  command->add_option("--out", arguments->out, "folder for table and report (default: none)")
      ->type_name("DIR");
  command->add_option("--threads", arguments->threads, "0 for one per processor")
      ->check(CLI::Range(0, 64, "0..64"))
      ->capture_default_str();
  command->add_flag("-q,--quiet", arguments->quiet, "print nothing but errors");
}

}  // namespace vmech
