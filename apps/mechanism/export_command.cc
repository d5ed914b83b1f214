#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "vmech/apps/commands.h"
#include "vmech/apps/common_options.h"
#include "vmech/apps/console/option_error.h"
#include "vmech/apps/files/file_kind.h"
#include "vmech/apps/files/inputs_apart.h"
#include "vmech/apps/files/output_folder.h"
#include "vmech/apps/files/parameter_options.h"
#include "vmech/kinematics/loops/assembled_mechanism.h"
#include "vmech/mechanisms/dh/denavit_hartenberg.h"
#include "vmech/mechanisms/exchange/mjcf.h"
#include "vmech/mechanisms/exchange/sdf/sdf.h"
#include "vmech/mechanisms/files/document.h"
#include "vmech/mechanisms/files/reader.h"
#include "vmech/mechanisms/files/writer.h"

namespace vmech {
namespace {

constexpr const char* kExportHelp =
    "Writes a mechanism, YAML or JSON, for other programs, by the ending of the output:\n"
    "  .sdf          SDFormat 1.9 (Gazebo), loops and all\n"
    "  .xml, .mjcf   MuJoCo, loops as equality constraints\n"
    "  .yaml         vmech's own format\n"
    "and says what the other format cannot hold.";

ExportedText Exported(const Mechanism& mechanism, const ExportArguments& arguments) {
  const std::string ending = arguments.out.extension().string();
  if (ending == ".yaml" || ending == ".yml") {
    const FileUnits units =
        arguments.si ? FileUnits::kMetresRadians : FileUnits::kMillimetresDegrees;
    return {WriteMechanism(mechanism, {units, ""}), {}};
  }
  if (ending == ".sdf") return WriteSdf(RequireAssembled(mechanism).mechanism);
  if (ending == ".xml" || ending == ".mjcf")
    return WriteMjcf(RequireAssembled(mechanism).mechanism);
  throw OptionError(fmt::format(
      "--out: the ending of {} does not say what to write: .sdf (SDFormat), .xml or .mjcf "
      "(MuJoCo), .yaml (vmech)",
      Quoted(arguments.out.string())));
}

}  // namespace

void AddExport(CLI::App* app, ExportArguments* arguments) {
  CLI::App* command = app->add_subcommand("export", kExportHelp);
  AddFile(command, "MECHANISM", &arguments->mechanism, "mechanism file, YAML or JSON");
  command->add_option("--out", arguments->out, "file to write")->required()->type_name("FILE");
  AddSet(command, &arguments->set);
  AddTolerance(command, &arguments->tolerance);
  command->add_flag("--dh-frames", arguments->dh_frames,
                    "draw every link in its Denavit-Hartenberg frame");
  command->add_flag("--si", arguments->si,
                    ".yaml in metres and radians instead of millimetres and degrees");
}

int RunExport(const ExportArguments& arguments) {
  RequireOutputsApart({arguments.mechanism}, {arguments.out});
  Mechanism mechanism = ReadWithSettings(arguments.set, [&](auto settings) {
    return ReadAs({"export", {FileKind::kMechanism}}, arguments.mechanism,
                  [&](const auto& file) { return ReadMechanism(file, settings); });
  });
  if (arguments.tolerance) mechanism.tolerance = *arguments.tolerance;
  if (arguments.dh_frames) {
    mechanism = DrawnInLinkFrames(mechanism, DeduceDhTable(mechanism, FindSpanningTree(mechanism)));
  }
  const ExportedText exported = Exported(mechanism, arguments);
  OutputFolder folder(arguments.out.has_parent_path() ? arguments.out.parent_path() : ".");
  folder.Write(arguments.out.filename().string(), exported.text);
  folder.Commit();
  for (const std::string& note : exported.notes) fmt::print("note        {}\n", note);
  fmt::print("written to {}\n", arguments.out.string());
  return kSuccess;
}

}  // namespace vmech
