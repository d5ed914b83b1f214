#pragma once

#include <filesystem>
#include <string>

namespace vmech {

/// How a file whose ending is not read comes in all the same: the program that made it and what to
/// save there, "a drawing of SolidWorks: save it as STEP ...". Empty if the ending is not known.
std::string WayRound(const std::filesystem::path& file);

}  // namespace vmech
