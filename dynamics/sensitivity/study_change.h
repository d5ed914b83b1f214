#pragma once

#include <array>
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

  /// Of a pose of the motion in the whole one.
  size_t pose_number(size_t pose) const { return pose_numbers.empty() ? pose : pose_numbers[pose]; }
};

/// The slopes at 0 of numbers that are given at -2, -1, 0, 1 and 2 steps. All of one length.
/// @throws std::invalid_argument where one has a corner there.
std::vector<double> FivePointSlopes(const std::array<std::vector<double>, 5>& at, double step);

/// By differences of the study's numbers at `value` +- `step` and +- 2 `step`, which are closed
/// forms of the parameter: with a step of a thousandth nothing but rounding is left, 1e-12. Calls
/// `at` five times, in the order of FivePointSlopes.
/// @throws std::invalid_argument if the parameter changes the form of the study (how many poses,
///         links, rows of a table), or has a corner near `value`; what `at` throws.
StudyChange ChangeOfStudy(const PreparedStudy& prepared, const Motion& motion, const StudyAt& at,
                          double value, double step);

}  // namespace vmech
