#include "vmech/dynamics/sensitivity/study_change.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "vmech/dynamics/sensitivity/study_numbers.h"

namespace vmech {
namespace {

template <typename Visit>
void VisitSamples(std::vector<MotionSample>* samples, const Visit& visit) {
  for (MotionSample& s : *samples) {
    for (double* number : {&s.position, &s.velocity, &s.acceleration}) visit(*number);
  }
}

std::vector<MotionSample> SamplesOf(const LoadStudy& study) {
  std::vector<MotionSample> samples;
  for (double t : study.times) {
    for (const JointDrive& drive : study.drives) samples.push_back(drive.law.At(t));
  }
  return samples;
}

std::vector<double> StiffnessesOf(const LoadStudy& study) {
  std::vector<double> stiffnesses;
  for (const Joint& joint : study.mechanism.joints) {
    if (!joint.stiffness) continue;
    stiffnesses.insert(stiffnesses.end(), joint.stiffness->begin(), joint.stiffness->end());
  }
  return stiffnesses;
}

/// Every number of a study that its loads depend on, in the order in which Spread gives slopes.
std::vector<double> NumbersOfStudy(LoadStudy study) {
  std::vector<double> numbers;
  numbers.reserve((3 * study.drives.size() + 1) * study.times.size() + 1000);
  const auto collect = [&](const double& number) { numbers.push_back(number); };
  Design<double> design = DesignOf(study.mechanism);
  VisitDesign(&design, collect);
  for (Grasp& grasp : study.mechanism.grasps) VisitVector(grasp.X_LG.p, collect);
  for (ExternalLoad& load : study.external)
    VisitTable(static_cast<LoadTableOf<double>*>(&load), collect);
  std::vector<MotionSample> samples = SamplesOf(study);
  VisitSamples(&samples, collect);
  for (double time : study.times) collect(time);
  collect(study.cycle);
  return numbers;
}

void Spread(const std::vector<double>& slopes, StudyChange* change) {
  const double* next = slopes.data();
  const auto give = [&](auto& number) {
    if constexpr (std::is_same_v<std::decay_t<decltype(number)>, Dual>) {
      number.slope = *next++;
    } else {
      number = *next++;
    }
  };
  VisitDesign(&change->design, give);
  for (Vector3<Dual>& grasp : change->grasps) VisitVector(grasp, give);
  for (LoadTableOf<Dual>& table : change->prescribed.external) VisitTable(&table, give);
  VisitSamples(&change->prescribed.drives, give);
  for (double& time : change->prescribed.times) give(time);
  give(change->cycle);
}

/// Leaves no slopes of times and drives that are all zero.
void LeaveOutZeros(PrescribedSlopes* slopes) {
  bool zero = true;
  VisitSamples(&slopes->drives, [&](double slope) { zero = zero && slope == 0; });
  if (zero) slopes->drives.clear();
  if (std::all_of(slopes->times.begin(), slopes->times.end(), [](double t) { return t == 0; })) {
    slopes->times.clear();
  }
}

LoadTableOf<Dual> WithoutSlopes(const ExternalLoad& load) {
  LoadTableOf<Dual> table;
  table.p_L = load.p_L.cast<Dual>();
  table.period = load.period;
  table.at.assign(load.at.begin(), load.at.end());
  for (const Wrenchd& W : load.wrenches) {
    table.wrenches.push_back({W.force.cast<Dual>(), W.moment.cast<Dual>()});
  }
  return table;
}

StudyChange WithoutSlopes(const PreparedStudy& prepared, const Motion& motion) {
  const LoadModel& model = prepared.model;
  StudyChange change;
  change.design = DesignOf(model.tree.mechanism).cast<Dual>();
  for (const Grasp& grasp : model.tree.mechanism.grasps) {
    change.grasps.push_back(grasp.X_LG.p.cast<Dual>());
  }
  change.prescribed.times.assign(motion.size(), 0);
  change.prescribed.drives.assign(motion.drives.size(), MotionSample{});
  for (const ExternalLoad& load : model.external) {
    change.prescribed.external.push_back(WithoutSlopes(load));
  }
  return change;
}

size_t CountNumbers(StudyChange* change) {
  size_t count = 1;  // the cycle
  const auto visit = [&](const auto& /*number*/) { ++count; };
  VisitDesign(&change->design, visit);
  for (Vector3<Dual>& grasp : change->grasps) VisitVector(grasp, visit);
  for (LoadTableOf<Dual>& table : change->prescribed.external) VisitTable(&table, visit);
  return count + 3 * change->prescribed.drives.size() + change->prescribed.times.size();
}

}  // namespace

std::vector<double> FivePointSlopes(const std::array<std::vector<double>, 5>& at, double step) {
  constexpr double kSmooth = 1e-3;  // of the change: far above the fourth derivatives of formulas
  constexpr double kRounding = 1e-13;  // of numbers of order 1
  std::vector<double> slopes(at[0].size());
  for (size_t i = 0; i < slopes.size(); ++i) {
    const double here = at[2][i];
    double range = 0;
    for (const std::vector<double>& numbers : at) {
      range = std::max(range, std::abs(numbers[i] - here));
    }
    const double fourth = at[0][i] - 4 * at[1][i] + 6 * here - 4 * at[3][i] + at[4][i];
    if (std::abs(fourth) > kSmooth * range + kRounding * std::max(1.0, std::abs(here))) {
      throw std::invalid_argument(
          fmt::format("a number that it changes, {:.6g} here, has a corner within {:.3g} of this "
                      "value, as min, max and abs have: there is no derivative",
                      here, 2 * step));
    }
    slopes[i] = (8 * (at[3][i] - at[1][i]) - (at[4][i] - at[0][i])) / (12 * step);
  }
  return slopes;
}

StudyChange ChangeOfStudy(const PreparedStudy& prepared, const Motion& motion, const StudyAt& at,
                          double value, double step) {
  StudyChange change = WithoutSlopes(prepared, motion);
  const size_t count = CountNumbers(&change);
  std::array<std::vector<double>, 5> numbers, stiffnesses;
  for (size_t k = 0; k < numbers.size(); ++k) {
    const double there = value + (static_cast<double>(k) - 2) * step;
    LoadStudy study = at(there);
    stiffnesses[k] = StiffnessesOf(study);
    numbers[k] = NumbersOfStudy(std::move(study));
    if (numbers[k].size() == count && stiffnesses[k].size() == stiffnesses[0].size()) continue;
    throw std::invalid_argument(
        fmt::format("at {:.6g} the study has another form than at {:.6g} ({} numbers, not {}): a "
                    "parameter that "
                    "changes how many poses, rows or parts there are has no derivative",
                    there, value, numbers[k].size(), count));
  }
  Spread(FivePointSlopes(numbers, step), &change);
  LeaveOutZeros(&change.prescribed);
  constexpr double kRounding = 1e-13;  // of numbers of order 1, and of coordinates some turns away
  change.rounding = kRounding / step;
  change.shares = stiffnesses[0] != stiffnesses[4];
  return change;
}

}  // namespace vmech
