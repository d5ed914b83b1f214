#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vmech/mechanisms/mechanism.h"

namespace vmech {

/// What came of a file of another program.
struct ImportedMechanism {
  Mechanism mechanism;
  /// What was guessed, changed or left out: a sentence each.
  std::vector<std::string> notes;
};

struct ImportOptions {
  /// The link that stands still. Empty: the one that is fixed to the world, or else the first; a
  /// note says which was taken.
  std::string ground;
  /// In world axes [m/s^2]. None: that of the file, or else 9.81 m/s^2 along -z.
  std::optional<Vector3d> gravity_W;
};

/// A mechanism in the language of another program.
struct ExportedText {
  std::string text;
  std::vector<std::string> notes;  ///< what that language cannot say, and what was done about it
};

}  // namespace vmech
