#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "vmech/mechanisms/exchange/imported.h"

namespace vmech {

/// What `vmech import` is asked for; the readers take what concerns them.
struct ImportArguments {
  std::filesystem::path file, out;
  ImportOptions options;
  std::string gravity;          ///< three numbers, "0 0 -9.81"; empty: that of the file
  std::filesystem::path loops;  ///< side file of a URDF; empty: none
  bool si = false;              ///< write metres and radians
};

/// A file of another program as a mechanism, with a page that tells what it holds and what was
/// guessed.
struct ImportedFile {
  Mechanism mechanism;
  std::string report;
};

/// A kind of file that can be read, by the endings of its name (".urdf").
struct ImportDoor {
  std::vector<std::string_view> endings;
  std::string_view what;
  std::function<ImportedFile(const ImportArguments&)> read;
};
const std::vector<ImportDoor>& ImportDoors();

/// Bodies with their masses, joints, and the notes: the page of files that say little more.
std::string ImportReport(const std::filesystem::path& file, const ImportedMechanism& imported);

}  // namespace vmech
