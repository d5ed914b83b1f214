#pragma once

#include <vector>

#include "vmech/apps/html/markup.h"
#include "vmech/apps/report/cycle.h"
#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/load_study.h"
#include "vmech/dynamics/loads/motion/transmission_angle.h"

namespace vmech {

/// The freedoms of a joint that are measured alike: its turns, or its shifts.
struct FreedomGroup {
  int joint = -1;
  bool turns = false;
  std::vector<int> freedoms;
};

/// One group, or two of a joint with both.
std::vector<FreedomGroup> GroupFreedoms(const Mechanism& mechanism, int joint);

/// Coordinate, rate and acceleration of a group over the cycle, side by side.
html::Markup MotionPlots(const LoadStudy& study, const LoadStudyResult& result, const Cycle& cycle,
                         const FreedomGroup& group);

/// Over the cycle, with the 40 degrees below which a transmission is doubtful.
html::Markup TransmissionPlot(const TransmissionAngle& transmission, const Cycle& cycle);

/// The path of a grasp in the plane of the world in which it goes farthest, to scale; nothing where
/// it does not move.
html::Markup PathPlot(const LoadStudy& study, const LoadStudyResult& result, const Cycle& cycle,
                      int grasp);

}  // namespace vmech
