#pragma once

#include <functional>
#include <vector>

#include "vmech/base/dual.h"
#include "vmech/dynamics/loads/load_study.h"
#include "vmech/dynamics/loads/pose/study_motion.h"
#include "vmech/dynamics/loads/prepare_study.h"
#include "vmech/kinematics/tree/kinematic_tree.h"

namespace vmech {

/// A study as a function of one of its numbers, in that number's unit.
using StudyAt = std::function<LoadStudy(double value)>;

/// How all that the loads of a study depend on goes with one parameter, per unit of it. The values
/// of the duals are those of the study.
struct StudyChange {
  Design<Dual> design;                ///< numbers of links and joints
  PrescribedSlopes prescribed;        ///< of drives and external loads
  std::vector<Vector3<Dual>> grasps;  ///< their origins, in their links
  double cycle = 0;                   ///< slope of LoadStudy::cycle
  /// Of a part of a motion the numbers of its poses in the whole, for messages; else empty.
  std::vector<size_t> pose_numbers;
  double rounding = 0;  ///< of the slope of a number of order 1, such as an angle
  /// Stiffnesses of joints change, by which the rule `stiffness` shares what statics leaves open.
  bool shares = false;
};

/// By differences of the study's numbers at `value` +- `step` and +- 2 `step`, which are closed
/// forms of the parameter: with a step of a thousandth nothing but rounding is left, 1e-12.
/// @throws std::invalid_argument if the parameter changes the form of the study (how many poses,
///         links, rows of a table); what `at` throws.
StudyChange ChangeOfStudy(const PreparedStudy& prepared, const Motion& motion, const StudyAt& at,
                          double value, double step);

}  // namespace vmech
