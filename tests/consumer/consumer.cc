// Drives a pendulum with the installed vmech and compares the pin force with the closed form.

#include <cmath>
#include <cstdlib>
#include <iostream>

#include "vmech/dynamics/load_study.h"

int main() {
  constexpr double kMass = 0.4, kArm = 0.05, kSpeed = 20, kGravity = 9.81;

  vmech::LoadStudy study;
  study.mechanism.name = "pendulum";
  study.mechanism.gravity_W = {0, -kGravity, 0};
  study.mechanism.links = {{"frame", {}, {{"pin", {}}}}, {"bob", {}, {{"pin", {}}}}};
  vmech::MassProperties& bob = study.mechanism.links[1].mass_properties;
  bob.mass = kMass;
  bob.p_LoLcm = {kArm, 0, 0};
  study.mechanism.joints = {vmech::MakeJoint("pin", vmech::JointType::kRevolute, {0, 0}, {1, 0})};
  study.drives = {{0, 0, vmech::MotionLaw::Uniform(0, kSpeed)}};
  study.times = {0.0};

  // Level arm, uniform speed: centripetal force inwards, weight borne upwards.
  const vmech::LoadStudyResult result = vmech::RunLoadStudy(study);
  const vmech::Vector3d force = result.poses[0].joints[0].force;
  const vmech::Vector3d expected(-kMass * kArm * kSpeed * kSpeed, kMass * kGravity, 0);
  std::cout << result.BriefReport() << "\npin force " << force.transpose() << " N\n";
  return (force - expected).norm() < 1e-12 * expected.norm() ? EXIT_SUCCESS : EXIT_FAILURE;
}
