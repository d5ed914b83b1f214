#include "vmech/mechanisms/joint_type.h"

namespace vmech {
namespace {

struct TypeInfo {
  std::string_view name;
  int freedoms;
};

constexpr TypeInfo kTypes[] = {{"revolute", 1},  {"prismatic", 1}, {"cylindrical", 2}, {"screw", 1},
                               {"universal", 2}, {"spherical", 3}, {"planar", 3},      {"weld", 0}};

}  // namespace

std::string_view NameOf(JointType type) {
  return kTypes[static_cast<int>(type)].name;
}

int FreedomsOf(JointType type) {
  return kTypes[static_cast<int>(type)].freedoms;
}

int CoordinatesOf(JointType type) {
  return type == JointType::kSpherical ? 4 : FreedomsOf(type);
}

}  // namespace vmech
