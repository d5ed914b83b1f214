#pragma once

#include <filesystem>
#include <string>

#include "vmech/mechanisms/cad/step/cad_assembly.h"

namespace vmech {

/// What can be said of a STEP file without Open CASCADE.

/// True if the file is UTF-8, as the standard and most programs have it (plain ASCII is); others
/// write the bytes of Latin-1.
/// @throws FileErrors if the file cannot be read, is not STEP (ISO 10303-21), is cut off, refers to
///         entities that it does not hold or defines them twice, holds zero bytes or numbers beyond
///         the range of doubles, or places components by mirrors or scales: Open CASCADE 7.6 takes
///         these for plain placements, without a word.
bool RequireWholeStepFile(const std::filesystem::path& path);

/// The name of a component: its own, unless it is one that the writing program made up ("NAUO3",
/// "=>[0:1:1:2]", a number, nothing); then that of its product.
std::string ComponentName(const std::string& component, const std::string& product);

/// Checks and completes what was read: names without characters that vmech refuses, each part's
/// name once, remarks about units and sizes.
/// @throws FileErrors if there is no part at all.
void FinishAssembly(CadAssembly* assembly);

}  // namespace vmech
