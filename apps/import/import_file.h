#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "vmech/mechanisms/cad/mechanism_from_cad.h"
#include "vmech/mechanisms/cad/step/step_reader.h"
#include "vmech/mechanisms/mechanism.h"

namespace vmech {

/// What `vmech import` is asked for; the doors take what concerns them.
struct ImportArguments {
  std::filesystem::path file;
  std::filesystem::path out;     ///< mechanism file; empty: "<file>.yaml" in the current folder
  std::filesystem::path study;   ///< STEP: a study beside it; empty: none
  std::filesystem::path meshes;  ///< STEP: folder of STL files; empty: none
  std::filesystem::path loops;   ///< URDF: side file with its loops; empty: none
  CadImportOptions cad;          ///< `ground` and `gravity_W` for all formats, the rest for STEP
  StepReadOptions step;
  std::vector<std::string>
      drives;       ///< joints with a motor in the study; empty: the first that turns
  double rpm = 60;  ///< of these, -1e6..1e6, not 0
  bool si = false;  ///< write metres and radians
  bool quiet = false;
  std::string model;                ///< SDF: one of several, by name; empty: the only one
  std::vector<std::string> grasps;  ///< links at whose frames there is a grasp; empty: proposed
  bool strict = false;  ///< refuse what would be mended with a note, and what is doubted

  /// @throws std::invalid_argument
  void Validate() const;
};

/// A file of another program as a mechanism.
struct ImportedFile {
  Mechanism mechanism;
  std::string report;                ///< a page that tells what it holds and what was guessed
  std::vector<std::string> guesses;  ///< go to the head of the file, too
  std::string study;                 ///< its text without `vmech_study` and `mechanism`
  std::map<std::string, std::string> meshes;  ///< by link: binary STL
  std::vector<std::string> doubts = {};       ///< beside those of the mechanism: densities
};

/// The ending of a name, ".step", in small letters.
std::string EndingOf(const std::filesystem::path& file);

}  // namespace vmech
