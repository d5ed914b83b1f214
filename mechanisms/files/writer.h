#pragma once

#include <string>

#include "vmech/mechanisms/mechanism.h"

namespace vmech {

/// The units in which a file is written; what has a force in it is SI in both.
enum class FileUnits {
  kMetresRadians,       ///< m, rad, kg, kg m^2
  kMillimetresDegrees,  ///< mm, deg, kg, kg mm^2
};

/// How a mechanism file is written.
struct WriterOptions {
  FileUnits units = FileUnits::kMetresRadians;  ///< of all lengths and angles in it
  std::string comment;  ///< lines of text for the head of the file, without '#'; may be empty
};

/// The mechanism as a file of the format that docs/file-format.md describes, for people: names that
/// stand below each other are aligned, lines end before column 100, and what has its default value
/// is left out. Every number is the shortest decimal that reads back as the same figure in SI units
/// and radians, and a number to readers of YAML 1.1 as well (YamlNumber). In metres and radians
/// there always is one: ReadMechanism gives the same mechanism to the last bit. In other units, and
/// for the pitch of a screw, which files give per turn, a figure that is the image of no decimal
/// comes back with a rounding in its last place.
///
/// What the format cannot say does not come back: a name that it refuses (Node::CheckName), inertia
/// of a link without mass, axes that are not orthonormal.
/// @throws std::invalid_argument at a figure that is not finite or beyond kMaxNumber.
std::string WriteMechanism(const Mechanism& mechanism, const WriterOptions& options = {});

}  // namespace vmech
