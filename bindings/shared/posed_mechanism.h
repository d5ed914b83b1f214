#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "vmech/bindings/shared/computed.h"
#include "vmech/kinematics/tree/kinematic_tree.h"
#include "vmech/mechanisms/mechanism.h"
#include "vmech/solvers/backend.h"

namespace vmech {

/// The drawing frames of all links in the world at a closed pose q of the tree: X_WL.
std::vector<Posed> PosesOfLinks(const KinematicTree& tree, const VectorXd& q);

/// The names of all freedoms, "pin" or "ball.rx", in the order of StartOfFreedoms.
std::vector<std::string> NamesOfAllFreedoms(const Mechanism& mechanism);

/// What is asked of FindNearestPose.
struct HandQuestion {
  int grasp = 0;
  Posed X_WH;
  Vector6d stiffness = Vector6d::Zero();  ///< as InverseKinematicsOptions
  bool joint_limits = true;
  Backend solver = Backend::kNullspace;
};

/// The pose of the mechanism nearest to a hand (paper eq. 7), from its start: one pose, with the
/// error that is left. Loops are closed, and their limits kept where a joint is not cut.
/// @throws std::invalid_argument for a grasp that does not exist or a hand that is not finite,
///         std::runtime_error where the loops do not close or the solver finds no minimum.
Computed FindNearestPose(const Mechanism& mechanism, const HandQuestion& question);

/// What is asked of FindAllPoses.
struct ModesQuestion {
  /// Freedoms that stay where they start, as indices among NamesOfAllFreedoms.
  std::vector<int> held;
  int grasp = -1;  ///< that has to be at the hand; -1: none
  Posed X_WH;
  bool joint_limits = true;
  int max_starts = 20000, patience = 2000;
  std::uint64_t seed = 1;
};

/// All assembly modes (FindAssemblyModes) of the mechanism, its loops closed from its start. What
/// is not certain about their number is a warning.
/// @throws std::invalid_argument for freedoms or a grasp that do not exist, or freedoms that cannot
///         be held, std::runtime_error where the loops do not close.
Computed FindAllPoses(const Mechanism& mechanism, const ModesQuestion& question);

}  // namespace vmech
