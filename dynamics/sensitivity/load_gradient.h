#pragma once

#include <memory>
#include <span>
#include <vector>

#include "vmech/dynamics/sensitivity/load_rows.h"
#include "vmech/dynamics/sensitivity/study_change.h"

namespace vmech {

/// The derivatives of one figure by all numbers of a study on which its loads depend.
struct StudyGradient {
  /// By what holds at every pose: links, joints and weight, then origins of grasps, then points of
  /// application of external loads, as VisitConstants orders them.
  std::vector<double> constants;
  /// [poses, 3 per drive and 6 per external load] by what is prescribed at a pose: position,
  /// velocity and acceleration of each drive, force and moment of each load in its own axes.
  std::vector<double> prescribed;
};

/// Derivatives of functions of a study's loads by all numbers of the study together: every pose is
/// put on a tape and swept backwards once for each function, however many parameters there are.
/// Loops are differentiated implicitly, as in DifferentiateLoads.
class LoadGradients {
 public:
  /// Are there? Not where the poses do not run in lanes (RunsInLanes), or are less than four.
  static bool Exist(const LoadModel& model, const Motion& motion);

  /// Keeps references. Derivatives are taken by the numbers that at least one of `changes` changes.
  LoadGradients(const PreparedStudy& prepared, const Motion& motion,
                std::span<const StudyChange> changes);
  ~LoadGradients();

  /// Of the function with derivatives `by_loads` by the loads of some poses, none by the others.
  /// @throws std::runtime_error where the loads of a pose have no derivative.
  StudyGradient Of(const LoadRows<double>& by_loads);

 private:
  class Tape;
  std::unique_ptr<Tape> tape_;
};

/// The derivative by the parameter of `change`, one of those that the gradient is for.
double SlopeAlong(const StudyChange& change, const StudyGradient& gradient, const LoadModel& model,
                  const Motion& motion);

}  // namespace vmech
