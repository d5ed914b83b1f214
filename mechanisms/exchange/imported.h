#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vmech/mechanisms/mechanism.h"

namespace vmech {

/// What came of a file of another program.
struct ImportedMechanism {
  Mechanism mechanism;  ///< SI units
  /// What was guessed, changed or left out: a sentence each.
  std::vector<std::string> notes;
};

/// What a file of another program leaves open.
struct ImportOptions {
  /// The link that stands still. Empty: the one that is fixed to the world, or else the first; a
  /// note says which was taken.
  std::string ground;
  /// In world axes [m/s^2]. None: that of the file, or else 9.81 m/s^2 along -z.
  std::optional<Vector3d> gravity_W;
  /// SDF: the model of a file of several, by name. Empty: the only one that moves.
  std::string model;
  /// Refuse what would else be mended with a note: inertias that no body has, a range that holds
  /// its joint, a joint that floats.
  bool strict = false;
};

/// A mechanism in the language of another program.
struct ExportedText {
  std::string text;                ///< a whole file
  std::vector<std::string> notes;  ///< what that language cannot say, and what was done about it
};

}  // namespace vmech
