#include "vmech/dynamics/loads/study_validity.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "vmech/mechanisms/validity.h"

namespace vmech {
namespace {

[[noreturn]] void Refuse(const std::string& field, const std::string& defect) {
  throw std::invalid_argument(field + defect);
}

/// Increasing and finite, entry by entry.
void RequireIncreasing(const std::string& field, const std::vector<double>& values) {
  for (size_t i = 0; i < values.size(); ++i) {
    if (std::isfinite(values[i]) && (i == 0 || values[i] > values[i - 1])) continue;
    RequireFinite(fmt::format("{}[{}]", field, i), values[i]);
    Refuse(fmt::format("{}[{}]", field, i),
           fmt::format(" = {} follows {}; they must increase", values[i], values[i - 1]));
  }
}

/// A table that repeats must not be longer than its period.
void RequirePeriod(const std::string& field, double period, const std::vector<double>& at) {
  constexpr double kRounding = 1e-9;
  RequireNonNegative(field, period);
  if (period == 0) return;
  const double span = at.back() - at.front();
  if (span <= period * (1 + kRounding)) return;
  Refuse(field, fmt::format(" = {}, but what repeats after it takes {}", period, span));
}

void RequireDrive(const std::string& field, const Mechanism& mechanism, const JointDrive& drive) {
  RequireIndex(field + ".joint", drive.joint, mechanism.joints.size());
  const Joint& joint = mechanism.joints[drive.joint];
  if (joint.type == JointType::kSpherical || joint.type == JointType::kWeld) {
    throw std::invalid_argument(fmt::format(
        "joint '{}' is {}; drive a joint with single freedoms, or move the mechanism by a grasp",
        joint.name, NameOf(joint.type)));
  }
  if (drive.freedom < 0 || drive.freedom >= FreedomsOf(joint.type)) {
    Refuse(field + ".freedom",
           fmt::format(" = {}, but joint '{}' is {} and has {} of them, from 0", drive.freedom,
                       joint.name, NameOf(joint.type), FreedomsOf(joint.type)));
  }
  if (drive.law.empty()) {
    Refuse(field + ".law", " is empty; give MotionLaw::Uniform or MotionLaw::Table");
  }
}

void RequireHand(const Mechanism& mechanism, const HandDrive& hand) {
  RequireIndex("hand.grasp", hand.grasp, mechanism.grasps.size());
  if (hand.law.empty()) Refuse("hand.law", " is empty; give HandLaw::Table");
  for (int k = 0; k < 6; ++k) {
    RequireNonNegative(fmt::format("hand.stiffness[{}]", k), hand.stiffness[k]);
  }
}

void RequireTable(const std::string& field, const ExternalLoad& load) {
  const bool constant = load.over == ExternalLoad::Over::kConstant;
  if (constant && load.wrenches.size() != 1) {
    Refuse(field, fmt::format(" is constant, but has {} wrenches; give one", load.wrenches.size()));
  }
  if (!constant && (load.at.empty() || load.at.size() != load.wrenches.size())) {
    Refuse(field, fmt::format(": `at` has {} rows and `wrenches` {}; give as many, one at least",
                              load.at.size(), load.wrenches.size()));
  }
  RequireIncreasing(field + ".at", load.at);
  for (size_t i = 0; i < load.wrenches.size(); ++i) {
    if (load.wrenches[i].Stacked().allFinite()) continue;
    Refuse(fmt::format("{}.wrenches[{}]", field, i), " holds values that are not finite");
  }
  if (!constant) RequirePeriod(field + ".period", load.period, load.at);
}

void RequireLoad(const std::string& field, const LoadStudy& study, const ExternalLoad& load) {
  RequireIndex(field + ".link", load.link, study.mechanism.links.size());
  if (!load.p_L.allFinite()) Refuse(field + ".p_L", " holds values that are not finite");
  RequireTable(field, load);
  if (load.over == ExternalLoad::Over::kDriveCoordinate && study.drives.empty()) {
    throw std::invalid_argument(
        "an external load is a table over the drive coordinate, but the hand drives; give it over "
        "time `t`");
  }
}

}  // namespace

void RequireCovered(const std::string& field, double begins, double ends,
                    const std::vector<double>& times) {
  constexpr double kRounding = 1e-9;
  const double slack = kRounding * std::max(std::abs(times.front()), std::abs(times.back()));
  if (begins <= times.front() + slack && ends >= times.back() - slack) return;
  Refuse(field, fmt::format(" is a table from {:.6g} to {:.6g} s, but the times go from {:.6g} to "
                            "{:.6g} s; extend the table",
                            begins, ends, times.front(), times.back()));
}

void RequireValid(const LoadStudy& study) {
  RequireValid(study.mechanism);
  if (!study.drives.empty() && study.hand) {
    throw std::invalid_argument(
        "a study has joint drives or a hand, not both; give `motion` joints or a grasp");
  }
  if (study.times.empty())
    throw std::invalid_argument("the study has no poses; give times, in a file by `steps`");
  RequireIncreasing("times", study.times);
  RequirePeriod("cycle", study.cycle, study.times);
  for (size_t k = 0; k < study.drives.size(); ++k) {
    const std::string field = fmt::format("drives[{}]", k);
    RequireDrive(field, study.mechanism, study.drives[k]);
    const MotionLaw& law = study.drives[k].law;
    RequireCovered(field + ".law", law.begins(), law.ends(), study.times);
  }
  if (study.hand) {
    RequireHand(study.mechanism, *study.hand);
    RequireCovered("hand.law", study.hand->law.begins(), study.hand->law.ends(), study.times);
  }
  for (size_t k = 0; k < study.external.size(); ++k) {
    RequireLoad(fmt::format("external[{}]", k), study, study.external[k]);
  }
  RequireNonNegative("norm_length", study.norm_length);
}

}  // namespace vmech
