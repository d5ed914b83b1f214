// vmech-import: what `vmech import` runs. A program of its own, because the libraries of CAD
// systems take a tenth of a second to load, which no other command shall pay.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "vmech/apps/commands.h"
#include "vmech/apps/console/printable_streams.h"
#include "vmech/apps/import/import_command.h"
#include "vmech/mechanisms/cad/step/frame_name.h"
#include "vmech/mechanisms/files/document.h"

namespace vmech {
namespace {

constexpr const char* kHelp =
    "Makes a mechanism file of a file of another program, told by its ending:\n"
    "  .step, .stp    CAD assembly: parts become links, with mass properties from volume and\n"
    "                 density; coordinate systems called anchor_<joint> become joints\n"
    "  .sdf, .world   SDFormat (Gazebo)\n"
    "  .urdf          URDF (ROS); its loops come from a side file\n"
    "and reports bodies, masses, joints, what was guessed and what was left out.\n"
    "  vmech import crank.step --out crank.yaml --density aluminium --ground frame\n"
    "  vmech import crank.step --out crank.yaml --study study.yaml --drive main --rpm 1500";

/// The two sides of NAME=VALUE.
std::pair<std::string, std::string> Split(const std::string& text, const char* option) {
  const size_t at = text.rfind('=');
  if (at == std::string::npos || at == 0) {
    throw std::invalid_argument(fmt::format("{} {} is not NAME=VALUE", option, Quoted(text)));
  }
  return {text.substr(0, at), text.substr(at + 1)};
}

/// The names in "A,B,C": at least two.
std::vector<std::string> NamesIn(const std::string& text) {
  std::vector<std::string> names;
  std::istringstream words(text);
  for (std::string name; std::getline(words, name, ',');) names.push_back(name);
  if (names.size() >= 2) return names;
  throw std::invalid_argument(
      fmt::format("--weld {} does not name two bodies, as in --weld door,leaf", Quoted(text)));
}

Vector3d VectorFrom(const std::string& text) {
  std::istringstream words(text);
  std::vector<double> numbers;
  for (std::string word; words >> word;) numbers.push_back(ParseNumber(word).value_or(NAN));
  if (numbers.size() != 3 || std::isnan(numbers[0] + numbers[1] + numbers[2])) {
    throw std::invalid_argument(fmt::format("--gravity {} is not three numbers", Quoted(text)));
  }
  return {numbers[0], numbers[1], numbers[2]};
}

constexpr double kMetresPerMillimetre = 1e-3;

struct Raw {
  std::vector<std::string> densities, joint_types;
  std::vector<std::string> welds;
  std::string gravity;
  double tolerance_mm = ContactOptions().tolerance / kMetresPerMillimetre;
};

void AddCadOptions(CLI::App* app, ImportArguments* options, Raw* raw) {
  app->add_option("--density", raw->densities,
                  "of everything, or of a part, body or material by name: kg/m^3 or a material "
                  "(steel, aluminium, abs, ...); may be given several times")
      ->type_name("[NAME=]VALUE");
  app->add_option("--joint", raw->joint_types, "type of a joint; may be given several times")
      ->type_name("NAME=TYPE");
  app->add_option(
         "--rigid", options->cad.bodies.rigid,
         "a subassembly in which nothing moves, or a part that belongs to what it touches; "
         "may be given several times")
      ->type_name("NAME");
  app->add_option("--weld", raw->welds, "bodies or parts that are one; may be given several times")
      ->type_name("A,B[,C...]");
  app->add_option("--moving", options->cad.bodies.moving,
                  "a part that is a link though it looks like a screw or pin; may be given several "
                  "times")
      ->type_name("NAME");
  app->add_option("--ignore", options->cad.bodies.ignore,
                  "a part or subassembly to leave out; may be given several times")
      ->type_name("NAME");
  app->add_flag("--propose", options->cad.propose,
                "take the joints that shafts in bores, balls in sockets and planes suggest");
  app->add_option("--tolerance", raw->tolerance_mm, "greatest gap between surfaces in contact [mm]")
      ->capture_default_str();
  app->add_flag("--allow-unmatched", options->cad.allow_unmatched,
                "keep anchors that have no partner");
  app->add_flag("--tolerate-faults", options->step.tolerate_faults,
                "read files with faulty entities, too");
}

void AddExchangeOptions(CLI::App* app, ImportArguments* arguments) {
  app->add_option("--loops", arguments->loops, "URDF: side file with its loops")->type_name("FILE");
  app->add_option("--model", arguments->model, "SDFormat: one of several models")
      ->type_name("NAME");
  app->add_option("--grasp", arguments->grasps,
                  "SDFormat, URDF: a link at whose frame a hand holds on (default: the frames of "
                  "the file, else the ends of chains); may be given several times")
      ->allow_extra_args(false)
      ->type_name("LINK");
  app->add_flag("--strict", arguments->strict,
                "refuse what would be mended with a note, as an inertia that no body has, and what "
                "is doubted with a warning");
}

void AddOutputs(CLI::App* app, ImportArguments* arguments) {
  app->add_option("--out", arguments->out, "mechanism file (default: <file>.yaml in this folder)")
      ->type_name("FILE");
  app->add_option("--study", arguments->study,
                  "write a study, too, with the diameters of the shafts for the bearings")
      ->type_name("FILE");
  app->add_option("--drive", arguments->drives,
                  "joint with a motor in the study (default: the first that turns at the ground); "
                  "may be given several times")
      ->type_name("JOINT");
  app->add_option("--rpm", arguments->rpm, "its speed")->capture_default_str();
  app->add_option("--meshes", arguments->meshes, "write an STL file for every link, too")
      ->type_name("DIR");
  app->add_flag("--si", arguments->si, "metres and radians instead of millimetres and degrees");
  app->add_flag("-q,--quiet", arguments->quiet, "print errors alone");
}

void TakeRaw(const Raw& raw, ImportArguments* options) {
  for (const std::string& text : raw.densities) {
    if (text.find('=') == std::string::npos) {
      options->cad.densities.fallback = DensityFromText(text);
      continue;
    }
    const auto [name, value] = Split(text, "--density");
    options->cad.densities.by_name.emplace_back(name, DensityFromText(value));
  }
  for (const std::string& text : raw.joint_types) {
    const auto [name, word] = Split(text, "--joint");
    const auto type = JointTypeFromWord(word);
    if (!type) {
      throw std::invalid_argument(fmt::format(
          "--joint {}: {} is none of revolute, prismatic, cylindrical, universal, spherical, "
          "planar, weld",
          name, Quoted(word)));
    }
    options->cad.joint_types.emplace_back(name, *type);
  }
  for (const std::string& text : raw.welds) {
    options->cad.bodies.weld.push_back(NamesIn(text));
  }
  options->cad.contacts.tolerance = raw.tolerance_mm * kMetresPerMillimetre;
  if (!raw.gravity.empty()) {
    options->cad.gravity_W = VectorFrom(raw.gravity);
  }
}

int Run(int argc, char** argv) {
  CLI::App app{kHelp, "vmech import"};
  ImportArguments arguments;
  Raw raw;
  app.add_option("FILE", arguments.file, "what to read")->required()->type_name("FILE");
  AddOutputs(&app, &arguments);
  app.add_option("--ground", arguments.cad.ground, "the link that stands still")->type_name("NAME");
  app.add_option("--gravity", raw.gravity,
                 "in world axes [m/s^2] (default: that of the file, else 0 0 -9.81)")
      ->type_name("\"X Y Z\"");
  AddExchangeOptions(&app, &arguments);
  AddCadOptions(&app, &arguments, &raw);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kSuccess : kBadUsage;
  }
  TakeRaw(raw, &arguments);
  return RunImport(arguments);
}

}  // namespace
}  // namespace vmech

int main(int argc, char** argv) {
  vmech::PrintOnlyPrintableText();
  try {
    return vmech::Run(argc, argv);
  } catch (const vmech::FileErrors& error) {
    fmt::print(stderr, "{}\n", error.what());
    return vmech::kBadInput;
  } catch (const std::invalid_argument& error) {
    fmt::print(stderr, "vmech import: {}\n", error.what());
    return vmech::kBadInput;
  } catch (const std::exception& error) {
    fmt::print(stderr, "vmech import: internal error: {}\n", error.what());
    return vmech::kInternalError;
  }
}
