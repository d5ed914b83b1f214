#pragma once

#include <string>
#include <vector>

#include "vmech/apps/plot/line_plot.h"
#include "vmech/apps/plot/polar_plot.h"
#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/load_study.h"
#include "vmech/kinematics/motion/motion_law.h"

namespace vmech {

/// What the plots of a study run over: the drive's coordinate where a single motor moves steadily
/// forward or backward, else time.
struct Cycle {
  plot::Axis axis;
  std::vector<double> values;         ///< of every pose, in the unit of the axis
  std::vector<plot::PathMark> marks;  ///< four poses to be named in polar diagrams

  std::vector<plot::Station> dead_centres = {};  ///< on the axis
  MotionLaw drive = {};  ///< whose coordinate the axis shows; empty where that is time

  /// The value at a pose with its unit, "215°"; angles within their turn, "15°, turn 2".
  std::string At(size_t pose) const;
  /// The same at a time between poses, to a tenth of a degree, without the number of the turn.
  std::string AtTime(double time) const;
  /// "dead centre" if one is nearer to the pose than to its neighbours; else empty.
  std::string DeadCentreNear(size_t pose) const;
};

Cycle CycleOf(const LoadStudy& study, const LoadStudyResult& result);

/// "guide turns back at 0° and 180°": the dead centres by joints; empty if there are none.
std::string DescribeDeadCentres(const LoadStudy& study, const LoadStudyResult& result);

/// A sentence on how the mechanism moved, from the results.
std::string DescribeMotion(const LoadStudy& study, const LoadStudyResult& result);

}  // namespace vmech
