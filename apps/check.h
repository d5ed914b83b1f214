#pragma once

#include <string>

#include "vmech/kinematics/assembly.h"
#include "vmech/kinematics/kinematic_tree.h"
#include "vmech/kinematics/mobility.h"
#include "vmech/mechanisms/denavit_hartenberg.h"

namespace vmech {

/// What vmech makes of a mechanism file.
struct MechanismCheck {
  KinematicTree tree;
  AssemblySummary assembly;
  Mobility mobility;  ///< only if the loops close
  DhTable dh;
};

MechanismCheck CheckMechanism(Mechanism mechanism);

/// A page for a terminal: links, joints, loops and cuts, mobility, redundancy, closure, and the
/// Denavit-Hartenberg parameters.
std::string TextReport(const MechanismCheck& check);
/// The same for programs.
std::string JsonReport(const MechanismCheck& check);

}  // namespace vmech
