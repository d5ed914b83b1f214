#pragma once

#include <string>
#include <vector>

#include "vmech/kinematics/loops/assembled_mechanism.h"
#include "vmech/kinematics/loops/mobility.h"
#include "vmech/kinematics/tree/kinematic_tree.h"
#include "vmech/mechanisms/dh/denavit_hartenberg.h"

namespace vmech {

/// What vmech makes of a mechanism file.
struct MechanismCheck {
  KinematicTree tree;  ///< of the assembled mechanism, if it closes
  AssembledMechanism assembled;
  Mobility mobility;  ///< only if the loops close
  DhTable dh;
  std::vector<std::string> doubts;  ///< DoubtsOf the mechanism as it is stated

  bool closed() const { return assembled.summary.closed; }
};

MechanismCheck CheckMechanism(const Mechanism& mechanism);

/// A page for a terminal: links, joints, loops and cuts, mobility, redundancy, closure, and if they
/// are asked for the Denavit-Hartenberg parameters.
std::string TextReport(const MechanismCheck& check, bool dh);
/// The same for programs.
std::string JsonReport(const MechanismCheck& check, bool dh);

}  // namespace vmech
