#pragma once

#include <string>
#include <vector>

#include "vmech/mechanisms/mechanism.h"

namespace vmech {

/// Two joints of one link whose axes do not lie as the loops need them, through the rounding of
/// their figures.
struct AxisMisfit {
  int link = -1;                     ///< index in Mechanism::links
  int joint = -1, other_joint = -1;  ///< indices in Mechanism::joints
  bool parallel = false;             ///< the loops need the axes to be parallel (or in line)
  double angle = 0;                  ///< between the axes, off what closes the loops [rad]
  double distance = 0;               ///< between the joint centres, off what closes the loops [m]
};

/// The pairs of joints that lie differently in two versions of a mechanism, as drawn and as
/// Reconcile moved its anchors, largest first; those that differ by rounding (1e-12) are left out.
std::vector<AxisMisfit> FindAxisMisfits(const Mechanism& drawn, const Mechanism& reconciled);

/// The largest of them in words: "the axes of 'a' and 'd' on 'frame' are 0.2 urad off parallel, and
/// 3 more".
std::string DescribeMisfits(const Mechanism& mechanism, const std::vector<AxisMisfit>& misfits);

}  // namespace vmech
