#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "vmech/mechanisms/mechanism.h"

namespace vmech {

/// Where the meshes of a mechanism file's links are looked for: the folder "<name>-meshes" beside
/// it.
std::filesystem::path MeshFolderOf(const std::filesystem::path& mechanism_file);

/// The bytes of "<link>.stl" in a folder for every link, binary STL in metres; empty where there is
/// none. @throws FileErrors for a file that is no binary STL.
std::vector<std::string> ReadMeshes(const Mechanism& mechanism,
                                    const std::filesystem::path& folder);

}  // namespace vmech
