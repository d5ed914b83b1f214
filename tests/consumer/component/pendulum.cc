// The pin of a pendulum at rest carries its weight. One header is the whole public surface of a
// module.

#include "vmech/dynamics.h"

#include <cmath>
#include <cstdlib>
#include <iostream>

#include "vmech/mechanisms.h"

int main() {
  constexpr double kMass = 0.4, kGravity = 9.81;
  vmech::LoadStudy study;
  vmech::Mechanism& pendulum = study.mechanism;
  pendulum.name = "pendulum";
  pendulum.gravity_W = {0, -kGravity, 0};
  pendulum.links = {{"frame", {}, {{"pin", {}}}}, {"bob", {}, {{"pin", {}}}}};
  pendulum.links[1].mass_properties.mass = kMass;
  pendulum.joints = {vmech::MakeJoint("pin", vmech::JointType::kRevolute, {0, 0}, {1, 0})};
  study.drives = {{0, 0, vmech::MotionLaw::Uniform(0, 0)}};
  study.times = {0.0};

  const double force = vmech::RunLoadStudy(study).poses[0].joints[0].force.y();
  std::cout << "pin force y [N]: " << force << ", expected " << kMass * kGravity << "\n";
  return std::abs(force - kMass * kGravity) < 1e-12 ? EXIT_SUCCESS : EXIT_FAILURE;
}
