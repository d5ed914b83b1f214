#pragma once

#include <string>
#include <vector>

#include "vmech/dynamics/loads/pose/load_model.h"
#include "vmech/dynamics/simulation/simulation.h"
#include "vmech/dynamics/simulation/simulation_result.h"
#include "vmech/kinematics/loops/mobility.h"

namespace vmech {

/// A simulation made ready: the tree, in which joints stay whole that have drives or motors, and,
/// where the loops let them, springs, friction, limits or watches; closed at its start values.
struct PreparedSimulation {
  Simulation simulation;  ///< as given, with `table_coordinate` found
  /// Its drives come first among the independent freedoms, all of which are `driven`. External
  /// loads are constant ones to be filled in, one for each and one for the hand. Friction is not
  /// its business.
  LoadModel model;
  VectorXd q;                      ///< [nq], closed
  Mobility mobility;               ///< drives held
  double closure_tolerance = 0;    ///< as AssembledMechanism::closure_tolerance
  std::vector<std::string> notes;  ///< what the assembly moved
};

/// @throws as Simulate.
PreparedSimulation PrepareSimulation(const Simulation& simulation);

/// Independent freedoms that are best conditioned at q, the drives first. Pivots of the
/// dimensionless loop equations below `tolerance` count as zero: at a singular pose there are more.
/// @throws std::invalid_argument if the drives contradict each other.
CoordinatePartition ChooseFreedoms(const KinematicTree& tree, const VectorXd& q,
                                   const std::vector<int>& driven, double tolerance);

/// The velocities of the simulation's drives in the tree.
std::vector<int> DrivenVelocities(const Simulation& simulation, const KinematicTree& tree);

}  // namespace vmech
