#pragma once

#include <vector>

#include "vmech/dynamics/loads/pose/load_workspace.h"
#include "vmech/dynamics/loads/pose/study_motion.h"

namespace vmech {

/// A load's wrench at a value of its table's argument, in its own axes. Linear between rows.
/// Precondition: inside the table, unless it repeats (OutsideTable). T: double or Dual.
template <typename T>
Wrench<T> WrenchAt(ExternalLoad::Over over, const LoadTableOf<T>& table, T at);
/// Of a load with a table of doubles.
inline Wrenchd WrenchAt(const ExternalLoad& load, double at) {
  return WrenchAt<double>(load.over, load, at);
}
/// Is the argument outside a table that does not repeat?
bool OutsideTable(const ExternalLoad& load, double at);
/// Time, the first drive's coordinate, or zero: the argument of a load's table at a pose.
double TableArgument(const LoadModel& model, const ExternalLoad& load, const Motion& motion,
                     size_t pose);

/// The wrench of a load at a pose, in its own axes, with its slope.
Wrench<Dual> WrenchWithSlope(const LoadModel& model, const Motion& motion, size_t pose, size_t load,
                             const PrescribedSlopes& slopes);

/// All external wrenches at the poses `pose`, ... about their points of application, world axes.
/// Needs X; writes ws->external.
template <typename T>
void EvaluateExternalLoads(const LoadModel& model, const Motion& motion, size_t pose,
                           LoadWorkspace<T>* ws);

}  // namespace vmech
