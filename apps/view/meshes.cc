#include "vmech/apps/view/meshes.h"

#include <fmt/format.h>

#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <system_error>

#include "vmech/mechanisms/files/file_errors.h"

namespace vmech {
namespace {

constexpr size_t kHead = 84, kTriangle = 50;  // [bytes] of a binary STL

bool IsBinaryStl(const std::string& bytes) {
  if (bytes.size() < kHead) return false;
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + kHead - sizeof(count), sizeof(count));
  return bytes.size() == kHead + kTriangle * count;
}

}  // namespace

std::filesystem::path MeshFolderOf(const std::filesystem::path& mechanism_file) {
  return mechanism_file.parent_path() / (mechanism_file.stem().string() + "-meshes");
}

std::vector<std::string> ReadMeshes(const Mechanism& mechanism,
                                    const std::filesystem::path& folder) {
  std::vector<std::string> meshes(mechanism.links.size());
  std::error_code none;
  if (!std::filesystem::is_directory(folder, none)) return meshes;
  for (size_t i = 0; i < meshes.size(); ++i) {
    const std::filesystem::path name = mechanism.links[i].name + ".stl";
    if (name != name.filename()) continue;  // no way out of the folder
    std::ifstream file(folder / name, std::ios::binary);
    if (!file) continue;
    meshes[i].assign(std::istreambuf_iterator<char>(file), {});
    if (!IsBinaryStl(meshes[i])) {
      throw FileErrors((folder / name).string(),
                       "is no binary STL; `vmech import --meshes` writes such files");
    }
  }
  return meshes;
}

}  // namespace vmech
