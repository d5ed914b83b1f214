#include "vmech/dynamics/sensitivity/study_change.h"

#include <fmt/format.h>

#include <array>
#include <stdexcept>
#include <type_traits>

namespace vmech {
namespace {

template <typename T, typename Visit>
void VisitVector(Vector3<T>& v, const Visit& visit) {
  for (T& number : v) visit(number);
}

/// Calls visit(number) for every number of a design, in an order of its own.
template <typename T, typename Visit>
void VisitDesign(Design<T>* design, const Visit& visit) {
  VisitVector(design->gravity_W, visit);
  for (typename Design<T>::LinkNumbers& link : design->links) {
    visit(link.mass);
    VisitVector(link.p_LoLcm, visit);
    for (T& number : link.I_Lcm.reshaped()) visit(number);
    for (Pose<T>& X : link.X_LA) {
      for (T& number : X.R.reshaped()) visit(number);
      VisitVector(X.p, visit);
    }
  }
  for (typename Design<T>::JointNumbers& joint : design->joints) {
    visit(joint.pitch);
    for (PassiveOf<T>& p : joint.passive) {
      for (T* number : {&p.stiffness, &p.rest, &p.viscous, &p.coulomb}) visit(*number);
    }
    LoadFrictionOf<T>& f = joint.load_friction;
    for (T* number : {&f.coefficient, &f.radius, &f.thrust_radius, &f.length, &f.width}) {
      visit(*number);
    }
  }
}

template <typename T, typename Visit>
void VisitTable(LoadTableOf<T>* table, const Visit& visit) {
  VisitVector(table->p_L, visit);
  visit(table->period);
  for (T& at : table->at) visit(at);
  for (Wrench<T>& W : table->wrenches) {
    VisitVector(W.force, visit);
    VisitVector(W.moment, visit);
  }
}

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
  const auto collect = [&](const double& number) { numbers.push_back(number); };
  Design<double> design = DesignOf(study.mechanism);
  VisitDesign(&design, collect);
  for (Grasp& grasp : study.mechanism.grasps) VisitVector(grasp.X_LG.p, collect);
  for (ExternalLoad& load : study.external) VisitTable<double>(&load, collect);
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

/// The slopes at 0 of numbers at -2, -1, 1 and 2 steps.
std::vector<double> FivePointSlopes(const std::array<std::vector<double>, 4>& at, double step) {
  std::vector<double> slopes(at[0].size());
  for (size_t i = 0; i < slopes.size(); ++i) {
    slopes[i] = (8 * (at[2][i] - at[1][i]) - (at[3][i] - at[0][i])) / (12 * step);
  }
  return slopes;
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

StudyChange ChangeOfStudy(const PreparedStudy& prepared, const Motion& motion, const StudyAt& at,
                          double value, double step) {
  StudyChange change = WithoutSlopes(prepared, motion);
  const size_t count = CountNumbers(&change);
  std::array<std::vector<double>, 4> numbers, stiffnesses;
  constexpr std::array kSteps{-2, -1, 1, 2};
  for (size_t k = 0; k < kSteps.size(); ++k) {
    const LoadStudy study = at(value + kSteps[k] * step);
    numbers[k] = NumbersOfStudy(study);
    stiffnesses[k] = StiffnessesOf(study);
    if (numbers[k].size() == count && stiffnesses[k].size() == stiffnesses[0].size()) continue;
    throw std::invalid_argument(
        fmt::format("at {:.6g} the study has another form than at {:.6g} ({} numbers, not {}): a "
                    "parameter that "
                    "changes how many poses, rows or parts there are has no derivative",
                    value + kSteps[k] * step, value, numbers[k].size(), count));
  }
  Spread(FivePointSlopes(numbers, step), &change);
  constexpr double kRounding = 1e-13;  // of numbers of order 1, and of coordinates some turns away
  change.rounding = kRounding / step;
  for (size_t k = 1; k < kSteps.size(); ++k) {
    change.shares = change.shares || stiffnesses[k] != stiffnesses[0];
  }
  return change;
}

}  // namespace vmech
