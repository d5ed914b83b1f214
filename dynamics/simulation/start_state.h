#pragma once

#include <string>
#include <vector>

#include "vmech/dynamics/simulation/equations/equations_of_motion.h"
#include "vmech/dynamics/simulation/simulation_result.h"

namespace vmech {

/// Where a simulation begins: on its loops, with rates that they allow.
struct StartState {
  VectorXd q, v;                       ///< coordinates [nq] and velocities [nv]
  std::vector<MovedRate> moved_rates;  ///< those that loops, drives or others did not allow
  std::string note;                    ///< that says so; empty if there are none
};

/// The given rates as nearly as loops and drives allow, lengths over the characteristic length, and
/// of the motions that have them the one with the least kinetic energy.
/// @throws std::invalid_argument if rates are moved by more than rounded figures are, naming them.
StartState FindStartState(const PreparedSimulation& prepared, EquationsOfMotion* equations);

}  // namespace vmech
