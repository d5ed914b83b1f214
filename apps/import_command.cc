#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "vmech/apps/check.h"
#include "vmech/apps/commands.h"
#include "vmech/apps/import.h"
#include "vmech/apps/output_folder.h"
#include "vmech/mechanisms/document.h"
#include "vmech/mechanisms/reader.h"
#include "vmech/mechanisms/writer.h"

namespace vmech {
namespace {

std::string LowerEnding(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending;
}

const ImportDoor& DoorFor(const std::filesystem::path& file) {
  const std::string ending = LowerEnding(file);
  std::string known;
  for (const ImportDoor& door : ImportDoors()) {
    for (const std::string_view each : door.endings) {
      if (each == ending) return door;
      known += fmt::format("{}{}", known.empty() ? "" : ", ", each);
    }
  }
  throw FileErrors(file.string(),
                   fmt::format("files are known by the ending of their name, and "
                               "{} is none of: {}",
                               ending.empty() ? "no ending" : Quoted(ending), known));
}

Vector3d GravityFrom(const std::string& text) {
  std::istringstream words(text);
  std::vector<double> numbers;
  for (std::string word; words >> word;) {
    const std::optional<double> number = ParseNumber(word);
    if (!number) throw std::invalid_argument("--gravity: " + Quoted(word) + " is not a number");
    numbers.push_back(*number);
  }
  if (numbers.size() != 3) {
    throw std::invalid_argument("--gravity: three numbers are needed, as in \"0 0 -9.81\"");
  }
  return {numbers[0], numbers[1], numbers[2]};
}

}  // namespace

int RunImport(ImportArguments arguments) {
  const ImportDoor& door = DoorFor(arguments.file);
  const std::string out_ending = LowerEnding(arguments.out);
  if (out_ending != ".yaml" && out_ending != ".yml") {
    throw FileErrors(arguments.out.string(), "a mechanism is written as .yaml");
  }
  if (!arguments.gravity.empty()) arguments.options.gravity_W = GravityFrom(arguments.gravity);
  const ImportedFile imported = door.read(arguments);
  WriterOptions options;
  options.units = arguments.si ? FileUnits::kMetresRadians : FileUnits::kMillimetresDegrees;
  options.comment = fmt::format("From {} ({}).", arguments.file.filename().string(), door.what);
  const std::string text = WriteMechanism(imported.mechanism, options);
  const MechanismCheck check = CheckMechanism(ParseMechanism(text, arguments.out.string()));
  OutputFolder folder(arguments.out.has_parent_path() ? arguments.out.parent_path() : ".");
  folder.Write(arguments.out.filename().string(), text);
  folder.Commit();
  fmt::print("{}", imported.report);
  if (!check.assembly.closed) {
    fmt::print("\nNOT ASSEMBLED: {}\n", check.assembly.message);
  } else if (!check.tree.loops.empty()) {
    fmt::print("loops       {}, which close from {:.2g} of the length {:.4g} m\n",
               check.tree.loops.size(), check.assembly.start_error, check.tree.length);
  }
  fmt::print("written to {}\n", arguments.out.string());
  return check.assembly.closed ? kSuccess : kNoSolution;
}

}  // namespace vmech
