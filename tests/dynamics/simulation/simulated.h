#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "support/examples.h"
#include "vmech/dynamics/simulation/simulate.h"

namespace vmech {

inline FreedomId FreedomOf(const Mechanism& mechanism, const std::string& joint, int freedom = 0) {
  return {FindJoint(mechanism, joint), freedom};
}

/// The coordinate of a joint in a result.
inline double PositionIn(const SimulationResult& result, size_t pose, const std::string& joint) {
  const int index = FindJoint(result.tree.mechanism, joint);
  return result.loads.poses.arrays().Joint(pose, static_cast<size_t>(index)).position[0];
}

inline SimulationOptions Tight(double tolerance) {
  SimulationOptions options;
  options.relative_tolerance = options.absolute_tolerance = tolerance;
  return options;
}

/// The largest error of the energy balance over the largest energy.
inline double EnergyError(const SimulationResult& result) {
  double error = 0, size = 0;
  for (const EnergySample& sample : result.energies) {
    error = std::max(error, std::abs(sample.error));
    size = std::max({size, std::abs(sample.kinetic), std::abs(sample.weight)});
  }
  return error / size;
}

/// A point mass on a bar of 1 m without mass, in the plane y down, about "pin".
inline Mechanism Pendulum(double mass = 1) {
  Mechanism pendulum;
  pendulum.gravity_W = {0, -9.81, 0};
  pendulum.links.resize(2);
  pendulum.links[0].name = "frame";
  pendulum.links[0].anchors = {{"pin", {}}};
  pendulum.links[1].name = "bob";
  pendulum.links[1].anchors = {{"pin", {}}};
  pendulum.links[1].mass_properties = {mass, {1, 0, 0}, Matrix3d::Zero()};
  pendulum.joints = {MakeJoint("pin", JointType::kRevolute, {0, 0}, {1, 0})};
  pendulum.joints[0].start = {0};
  return pendulum;
}

/// A block of 2 kg on a slide along `z`.
inline Mechanism Block(const Vector3d& z) {
  Mechanism block;
  block.gravity_W = {0, 0, -9.81};
  block.links.resize(2);
  block.links[0].name = "frame";
  block.links[1].name = "block";
  const Posed slide{AxesFromZX(z, Vector3d::UnitY()), Vector3d::Zero()};
  for (Link& link : block.links) link.anchors = {{"slide", slide}};
  block.links[1].mass_properties = {2, Vector3d::Zero(), 0.01 * Matrix3d::Identity()};
  block.joints = {MakeJoint("slide", JointType::kPrismatic, {0, 0}, {1, 0})};
  return block;
}

}  // namespace vmech
