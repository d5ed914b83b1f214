#include "vmech/apps/import/import_command.h"

#include <fmt/format.h>

#include <cstdio>
#include <list>

#include "vmech/apps/commands.h"
#include "vmech/apps/files/inputs_apart.h"
#include "vmech/apps/files/output_folder.h"
#include "vmech/apps/import/importers.h"
#include "vmech/apps/mechanism/check.h"
#include "vmech/mechanisms/files/document.h"
#include "vmech/mechanisms/files/flow_map.h"
#include "vmech/mechanisms/files/reader.h"
#include "vmech/mechanisms/files/writer.h"

namespace vmech {
namespace {

namespace fs = std::filesystem;

fs::path FolderOf(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

/// Files in several folders that are written all or not at all.
class Outputs {
 public:
  void Write(const fs::path& file, const std::string& text) {
    folders_.emplace_back(FolderOf(file));
    folders_.back().Write(file.filename().string(), text);
    names_ += (names_.empty() ? "" : ", ") + file.string();
  }

  void Commit() {
    for (OutputFolder& folder : folders_) folder.Commit();
  }

  const std::string& names() const { return names_; }

 private:
  std::list<OutputFolder> folders_;
  std::string names_;
};

std::string MechanismText(const ImportedFile& imported, const ImportArguments& arguments) {
  WriterOptions options;
  options.units = arguments.si ? FileUnits::kMetresRadians : FileUnits::kMillimetresDegrees;
  options.comment = fmt::format("From {} ({}).", arguments.file.filename().string(),
                                ImporterFor(arguments.file).what);
  for (const std::string& guess : imported.guesses) options.comment += "\nGuessed: " + guess + ".";
  return WriteMechanism(imported.mechanism, options);
}

std::string StudyFileText(const ImportedFile& imported, const ImportArguments& arguments) {
  const fs::path there = fs::absolute(arguments.out).lexically_normal();
  const fs::path here = fs::absolute(FolderOf(arguments.study)).lexically_normal();
  return fmt::format("vmech_study: \"1.0\"\nmechanism: {}\n{}",
                     YamlWord(there.lexically_relative(here).string()), imported.study);
}

void Print(const ImportedFile& imported, const MechanismCheck& check, const Outputs& outputs) {
  fmt::print("{}", imported.report);
  if (!check.closed()) {
    fmt::print("\nNOT ASSEMBLED: {}\n", check.assembled.summary.message);
  } else {
    if (!check.tree.loops.empty()) {
      fmt::print("loops       {}, which close from {:.2g} of the length {:.4g} m\n",
                 check.tree.loops.size(), check.assembled.summary.start_error, check.tree.length);
    }
    fmt::print("mobility    {}\n", check.mobility.mobility);
    for (const std::string& note : check.assembled.Notes()) fmt::print("note        {}\n", note);
  }
  for (const auto* doubts : {&imported.doubts, &check.doubts}) {
    for (const std::string& doubt : *doubts) fmt::print("warning     {}\n", doubt);
  }
  fmt::print("written to {}\n", outputs.names());
}

/// An option that does nothing for this kind of file is a slip.
void RequireOptionsFit(const ImportArguments& arguments) {
  const std::string ending = EndingOf(arguments.file);
  const bool sdf = ending == ".sdf" || ending == ".world", urdf = ending == ".urdf";
  const auto refuse = [&](bool given, bool fits, const char* message) {
    if (given && !fits) throw FileErrors(arguments.file.string(), message);
  };
  refuse(!arguments.study.empty() || !arguments.meshes.empty(), !sdf && !urdf,
         "--study and --meshes are for STEP files");
  refuse(!arguments.model.empty(), sdf, "--model is for SDFormat, of which a file holds several");
  refuse(!arguments.loops.empty(), urdf, "--loops is for URDF, which has no loops of its own");
  refuse(!arguments.grasps.empty(), sdf || urdf,
         "--grasp is for SDFormat and URDF; in CAD a coordinate system grasp_NAME makes a grasp");
}

/// @throws FileErrors with every doubt.
void RequireNoDoubt(const fs::path& file, const ImportedFile& imported,
                    const MechanismCheck& check) {
  std::vector<FileError> errors;
  for (const auto* doubts : {&imported.doubts, &check.doubts}) {
    for (const std::string& doubt : *doubts) errors.push_back({file.string(), 0, 0, "", doubt});
  }
  if (!errors.empty()) throw FileErrors(errors);
}

/// What is read and what is written, one file each.
void RequireFilesApart(const ImportArguments& arguments) {
  std::vector<fs::path> inputs{arguments.file}, outputs{arguments.out};
  if (!arguments.loops.empty()) inputs.push_back(arguments.loops);
  if (!arguments.study.empty()) outputs.push_back(arguments.study);
  RequireOutputsApart(inputs, outputs);
}

}  // namespace

int RunImport(ImportArguments arguments) {
  arguments.Validate();
  if (arguments.out.empty()) arguments.out = arguments.file.stem().string() + ".yaml";
  const std::string ending = EndingOf(arguments.out);
  if (ending != ".yaml" && ending != ".yml") {
    throw FileErrors(arguments.out.string(), "a mechanism is written as .yaml");
  }
  const Importer& door = ImporterFor(arguments.file);
  RequireOptionsFit(arguments);
  RequireFilesApart(arguments);
  const ImportedFile imported = door.read(arguments);
  const std::string text = MechanismText(imported, arguments);
  const MechanismCheck check = CheckMechanism(ParseMechanism(text, arguments.out.string()));
  if (arguments.strict) RequireNoDoubt(arguments.file, imported, check);

  Outputs outputs;
  outputs.Write(arguments.out, text);
  if (!arguments.study.empty()) outputs.Write(arguments.study, StudyFileText(imported, arguments));
  for (const auto& [link, stl] : imported.meshes) {
    outputs.Write(arguments.meshes / (link + ".stl"), stl);
  }
  outputs.Commit();
  if (!arguments.quiet) Print(imported, check, outputs);
  return check.closed() ? kSuccess : kNoSolution;
}

}  // namespace vmech
