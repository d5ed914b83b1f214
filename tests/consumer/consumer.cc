// Describes a crank with the installed vmech and asks for its typical length.

#include <cmath>
#include <cstdlib>
#include <iostream>

#include "vmech/mechanisms/mechanism.h"

int main() {
  vmech::Anchor main_bearing{"main", {}};
  vmech::Anchor pin{"pin", {vmech::Matrix3d::Identity(), {0.05, 0, 0}}};

  vmech::Mechanism mechanism;
  mechanism.name = "crank";
  mechanism.links = {{"frame", {}, {main_bearing}}, {"crank", {}, {main_bearing, pin}}};
  mechanism.links[1].mass_properties.mass = 0.4;
  mechanism.joints = {vmech::MakeJoint("main", vmech::JointType::kRevolute, {0, 0}, {1, 0})};

  const double length = vmech::CharacteristicLength(mechanism);
  std::cout << mechanism.name << ": typical length " << length << " m\n";
  const bool plausible = std::isfinite(length) && length > 0 && length <= 0.05;
  return plausible ? EXIT_SUCCESS : EXIT_FAILURE;
}
