#pragma once

#include <cstddef>
#include <vector>

#include "vmech/apps/commands.h"
#include "vmech/apps/haptic/haptic_session.h"
#include "vmech/hw_interface/recording/recording.h"
#include "vmech/kinematics/tree/kinematic_tree.h"

namespace vmech {

/// A mechanism that is held, where the hand takes hold: with its loops closed, within its limits.
struct HeldMechanism {
  /// That of a file; notes and doubts are printed unless it is to be quiet. @throws FileErrors and
  /// OptionError as ReadSubject, std::runtime_error if its loops do not close.
  explicit HeldMechanism(const HapticArguments& arguments);
  /// That of a recording, as it was.
  explicit HeldMechanism(const RecordingHeader& header);

  /// Held by a hand as its device can: at a point where it exerts no moments.
  void FitTo(const DeviceInfo& device, std::size_t hand, bool quiet);

  HapticSubject subject;    ///< what is held, and by which grasps
  KinematicTree tree;       ///< of the assembled mechanism
  VectorXd q;               ///< the closed start [nq]
  Matrix3d R_WD;            ///< the device's axes in the world
  std::vector<Posed> X_WG;  ///< grasp frames of every hand

 private:
  HeldMechanism(const HapticSubject& held, const HapticArguments& arguments);
  explicit HeldMechanism(const HapticSubject& held);
  HeldMechanism(const HapticSubject& held, const Mechanism& assembled);
};

}  // namespace vmech
