#include "vmech/apps/import/stl.h"

#include <bit>
#include <cstdint>
#include <type_traits>

namespace vmech {
namespace {

static_assert(std::endian::native == std::endian::little, "STL is little-endian");

template <typename T>
void Put(T value, std::string* bytes) {
  static_assert(std::is_trivially_copyable_v<T>);
  bytes->append(reinterpret_cast<const char*>(&value), sizeof(T));
}

void PutVector(const Vector3d& v, std::string* bytes) {
  for (int i = 0; i < 3; ++i) Put(static_cast<float>(v[i]), bytes);
}

}  // namespace

void AppendMesh(const CadMesh& mesh, const Posed& X_LP, CadMesh* sum) {
  const int first = static_cast<int>(sum->vertices.size());
  for (const Vector3d& vertex : mesh.vertices) sum->vertices.push_back(X_LP * vertex);
  for (const auto& [a, b, c] : mesh.triangles) {
    sum->triangles.push_back({first + a, first + b, first + c});
  }
}

std::string BinaryStl(const CadMesh& mesh) {
  std::string bytes = "binary STL in metres, by vmech";
  bytes.resize(80, ' ');
  Put(static_cast<std::uint32_t>(mesh.triangles.size()), &bytes);
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vector3d& p = mesh.vertices[a];
    const Vector3d normal = (mesh.vertices[b] - p).cross(mesh.vertices[c] - p);
    PutVector(normal.norm() > 0 ? Vector3d(normal.normalized()) : normal, &bytes);
    for (const int corner : {a, b, c}) PutVector(mesh.vertices[corner], &bytes);
    Put(std::uint16_t{0}, &bytes);
  }
  return bytes;
}

}  // namespace vmech
