#include "vmech/mechanisms/freedoms.h"

#include <algorithm>

namespace vmech {

const Freedoms& FreedomsOfType(JointType type) {
  static const Freedoms kTable[] = {
      {{0, 0, 0, 0, 0, 1}, {true}},                // revolute
      {{0, 0, 1, 0, 0, 0}, {false}},               // prismatic
      {{0, 0, 1, 0, 0, 1}, {false, true}},         // cylindrical
      {{0, 0, 1, 0, 0, 1}, {true}},                // screw
      {{0, 0, 0, 1, 1, 0}, {true, true}},          // universal
      {{0, 0, 0, 1, 1, 1}, {true, true, true}},    // spherical
      {{1, 1, 0, 0, 0, 1}, {false, false, true}},  // planar
      {{0, 0, 0, 0, 0, 0}, {}},                    // weld
  };
  return kTable[static_cast<int>(type)];
}

bool Rotates(JointType type) {
  const std::vector<bool>& rotates = FreedomsOfType(type).rotates;
  return std::find(rotates.begin(), rotates.end(), true) != rotates.end();
}

FrictionKeys FrictionKeysOf(JointType type) {
  const bool pins = type == JointType::kRevolute || type == JointType::kUniversal;
  const bool slides = type == JointType::kPrismatic;
  const bool guided = slides || type == JointType::kCylindrical || type == JointType::kScrew;
  return {Rotates(type), pins, pins || guided, slides};
}

std::vector<ElementaryFreedom> ElementaryFreedoms(JointType type) {
  constexpr ElementaryFreedom kTurnX{true, 0}, kTurnY{true, 1}, kTurnZ{true, 2};
  constexpr ElementaryFreedom kShiftX{false, 0}, kShiftY{false, 1}, kShiftZ{false, 2};
  switch (type) {
    case JointType::kRevolute:
    case JointType::kScrew:
      return {kTurnZ};
    case JointType::kPrismatic:
      return {kShiftZ};
    case JointType::kCylindrical:
      return {kShiftZ, kTurnZ};
    case JointType::kUniversal:
      return {kTurnX, kTurnY};
    case JointType::kSpherical:
      return {kTurnX, kTurnY, kTurnZ};
    case JointType::kPlanar:
      return {kShiftX, kShiftY, kTurnZ};
    case JointType::kWeld:
      return {};
  }
  return {};
}

std::string NameOfFreedom(JointType type, int freedom) {
  const ElementaryFreedom motion = ElementaryFreedoms(type).at(freedom);
  return std::string(motion.rotates ? "r" : "") + "xyz"[motion.axis];
}

std::vector<std::string> NamesOfFreedoms(JointType type) {
  std::vector<std::string> names;
  for (int k = 0; k < FreedomsOf(type); ++k) names.push_back(NameOfFreedom(type, k));
  return names;
}

int FindFreedom(JointType type, std::string_view name) {
  const std::vector<std::string> names = NamesOfFreedoms(type);
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? -1 : static_cast<int>(found - names.begin());
}

Matrix3d ZOnto(int axis) {
  Matrix3d R = Matrix3d::Zero();
  R(axis, 2) = R((axis + 1) % 3, 0) = R((axis + 2) % 3, 1) = 1;
  return R;
}

}  // namespace vmech
