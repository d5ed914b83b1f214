#pragma once

#include <string>
#include <vector>

#include "vmech/dynamics/simulation/simulation.h"
#include "vmech/kinematics/tree/kinematic_tree.h"

namespace vmech {

/// What a mechanism does that is moved a little out of an equilibrium.
enum class Stability {
  kStable,    ///< a least energy: it comes back
  kNeutral,   ///< some motion changes nothing
  kUnstable,  ///< some motion runs away
};

/// The stability in words.
constexpr std::string_view NameOf(Stability stability) {
  switch (stability) {
    case Stability::kStable:
      return "stable";
    case Stability::kNeutral:
      return "neutral";
    case Stability::kUnstable:
      return "unstable";
  }
  return "";
}

/// A pose at which weight, springs, motors, external loads and the hand's spring balance, as they
/// are at the start; without dry friction, which would only widen it.
struct Equilibrium {
  bool found = false;   ///< forces balance within the tolerance
  std::string message;  ///< why not, or what is left
  KinematicTree tree;   ///< of the assembled mechanism
  VectorXd q;           ///< [nq], loops closed
  double residual = 0;  ///< largest force that is left along a free motion [N], [N m]
  int iterations = 0;   ///< steps downhill
  Stability stability = Stability::kStable;  ///< against the motions that are free
};

/// The equilibrium that is reached downhill from the simulation's start: loops closed, drives where
/// they start. Limits are not looked at.
/// @throws as Simulate.
Equilibrium FindEquilibrium(const Simulation& simulation);

/// The same simulation with its mechanism at that equilibrium, if that is its start.
/// @throws as Simulate; std::runtime_error where none is found.
Simulation AtItsStart(Simulation simulation);

}  // namespace vmech
