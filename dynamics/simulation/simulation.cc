#include "vmech/dynamics/simulation/simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "vmech/base/check_range.h"
#include "vmech/dynamics/loads/pose/external_loads.h"
#include "vmech/dynamics/loads/study_validity.h"
#include "vmech/mechanisms/validity.h"

namespace vmech {
namespace {

[[noreturn]] void Refuse(const std::string& field, const std::string& defect) {
  throw std::invalid_argument(field + defect);
}

void RequireFreedom(const std::string& field, const Mechanism& mechanism, const FreedomId& at) {
  RequireIndex(field + ".joint", at.joint, mechanism.joints.size());
  const Joint& joint = mechanism.joints[at.joint];
  if (at.freedom >= 0 && at.freedom < FreedomsOf(joint.type)) return;
  Refuse(field + ".freedom",
         fmt::format(" = {}, but joint '{}' is {} and has {} of them, from 0", at.freedom,
                     joint.name, NameOf(joint.type), FreedomsOf(joint.type)));
}

/// One that has a coordinate of its own.
void RequireCoordinate(const std::string& field, const Mechanism& mechanism, const FreedomId& at) {
  RequireFreedom(field, mechanism, at);
  const Joint& joint = mechanism.joints[at.joint];
  if (joint.type != JointType::kSpherical) return;
  Refuse(field, fmt::format(": joint '{}' is spherical, which has no single coordinates; name a "
                            "freedom of another joint",
                            joint.name));
}

void RequireTable(const std::string& field, const TimeTable& table) {
  if (table.at.empty() || table.at.size() != table.values.size()) {
    Refuse(field, fmt::format(": `at` has {} rows and `values` {}; give as many, one at least",
                              table.at.size(), table.values.size()));
  }
  for (size_t i = 0; i < table.at.size(); ++i) {
    RequireFinite(fmt::format("{}.at[{}]", field, i), table.at[i]);
    RequireFinite(fmt::format("{}.values[{}]", field, i), table.values[i]);
    if (i == 0 || table.at[i] > table.at[i - 1]) continue;
    Refuse(fmt::format("{}.at[{}]", field, i),
           fmt::format(" = {} follows {}; they must increase", table.at[i], table.at[i - 1]));
  }
  RequireNonNegative(field + ".period", table.period);
  if (table.period == 0 || table.at.back() - table.at.front() <= table.period) return;
  Refuse(field + ".period", fmt::format(" = {}, but the table takes {}", table.period,
                                        table.at.back() - table.at.front()));
}

void RequireMotor(const std::string& field, const Mechanism& mechanism, const JointMotor& motor) {
  RequireCoordinate(field + ".at", mechanism, motor.at);
  if (!(motor.max_force > 0)) {
    Refuse(field + ".max_force", fmt::format(" = {}, but it must be positive", motor.max_force));
  }
  if (motor.law == JointMotor::Law::kForce) return RequireTable(field + ".force", motor.force);
  RequireNonNegative(field + ".stiffness", motor.stiffness);
  RequireNonNegative(field + ".damping", motor.damping);
  if (motor.wanted.empty()) {
    Refuse(field + ".wanted", " is empty; give MotionLaw::Uniform or MotionLaw::Table");
  }
}

void RequireHand(const Mechanism& mechanism, const GraspSpring& hand) {
  RequireIndex("hand.grasp", hand.grasp, mechanism.grasps.size());
  if (hand.law.empty() && !hand.hand) {
    Refuse("hand", " has neither a law nor a callback; give HandLaw::Table or a function of time");
  }
}

/// What a study of loads has in common with a simulation.
LoadStudy CommonStudy(const Simulation& simulation) {
  LoadStudy study;
  study.mechanism = simulation.mechanism;
  study.drives = simulation.drives;
  study.times = simulation.times;
  study.external = simulation.external;
  study.norm_length = simulation.norm_length;
  for (ExternalLoad& load : study.external) {
    if (load.over == ExternalLoad::Over::kDriveCoordinate) load.over = ExternalLoad::Over::kTime;
  }
  return study;
}

void RequireTableCoordinate(const Simulation& simulation) {
  if (simulation.table_coordinate) {
    return RequireCoordinate("table_coordinate", simulation.mechanism,
                             *simulation.table_coordinate);
  }
  for (const ExternalLoad& load : simulation.external) {
    if (load.over != ExternalLoad::Over::kDriveCoordinate) continue;
    if (!simulation.drives.empty() || !simulation.motors.empty()) continue;
    Refuse(
        "table_coordinate",
        " is not given, but an external load is a table over a coordinate, and there is no drive "
        "and no motor; name the coordinate");
  }
}

/// Nothing is known of a load beyond its table.
void RequireCovered(const std::string& field, const ExternalLoad& load,
                    const Simulation& simulation) {
  const bool over_drive = load.over == ExternalLoad::Over::kDriveCoordinate;
  if (over_drive && (simulation.table_coordinate || simulation.drives.empty())) return;
  for (const double time : simulation.times) {
    const double at = over_drive ? simulation.drives[0].law.At(time).position : time;
    if (!OutsideTable(load, at)) continue;
    Refuse(field, fmt::format(": its table covers {:.6g} to {:.6g}, but {:.6g} is asked for at t = "
                              "{:.6g} s; extend the table or give it a `period`",
                              load.at.front(), load.at.back(), at, time));
  }
}

}  // namespace

double TimeTable::At(double time) const {
  if (at.size() < 2 && period == 0) return values.front();
  if (period > 0) time -= period * std::floor((time - at.front()) / period);
  const auto after = std::upper_bound(at.begin(), at.end(), time);
  if (after == at.begin()) return values.front();
  const size_t i = static_cast<size_t>(after - at.begin()) - 1;
  const bool last = i + 1 == at.size();
  if (last && period == 0) return values.back();
  // Behind the last row a repeating table leads back to its first.
  const size_t next = last ? 0 : i + 1;
  const double width = last ? at.front() + period - at.back() : at[next] - at[i];
  const double s = width > 0 ? (time - at[i]) / width : 0;
  return (1 - s) * values[i] + s * values[next];
}

void RequireValid(const Simulation& simulation) {
  const Mechanism& mechanism = simulation.mechanism;
  RequireValid(CommonStudy(simulation));
  if (simulation.times.size() < 2) {
    Refuse("times", " has less than two values; give the start and the end");
  }
  if (simulation.rule == ReactionRule::kPaperJoint) {
    Refuse("rule",
           " is paper_joint, which knows drives and hands only; take stiffness or "
           "minimum_norm");
  }
  for (size_t k = 0; k < simulation.motors.size(); ++k) {
    const std::string field = fmt::format("motors[{}]", k);
    const JointMotor& motor = simulation.motors[k];
    RequireMotor(field, mechanism, motor);
    if (motor.law == JointMotor::Law::kForce) continue;
    RequireCovered(field + ".wanted", motor.wanted.begins(), motor.wanted.ends(), simulation.times);
  }
  if (simulation.hand) {
    RequireHand(mechanism, *simulation.hand);
    const HandLaw& law = simulation.hand->law;
    if (!simulation.hand->hand) {
      RequireCovered("hand.law", law.begins(), law.ends(), simulation.times);
    }
  }
  RequireTableCoordinate(simulation);
  for (size_t k = 0; k < simulation.external.size(); ++k) {
    RequireCovered(fmt::format("external[{}]", k), simulation.external[k], simulation);
  }
  for (size_t k = 0; k < simulation.rebounds.size(); ++k) {
    const std::string field = fmt::format("rebounds[{}]", k);
    RequireCoordinate(field + ".at", mechanism, simulation.rebounds[k].at);
    CheckRange(field, "restitution", simulation.rebounds[k].restitution, 0, 1);
  }
  for (size_t k = 0; k < simulation.start_rates.size(); ++k) {
    const std::string field = fmt::format("start_rates[{}]", k);
    RequireFreedom(field + ".at", mechanism, simulation.start_rates[k].at);
    RequireFinite(field + ".rate", simulation.start_rates[k].rate);
  }
  for (size_t k = 0; k < simulation.watches.size(); ++k) {
    const std::string field = fmt::format("watches[{}]", k);
    RequireCoordinate(field + ".at", mechanism, simulation.watches[k].at);
    RequireFinite(field + ".value", simulation.watches[k].value);
  }
}

void SimulationOptions::Validate() const {
  CheckRange("SimulationOptions", "relative_tolerance", relative_tolerance, 1e-14, 1e-2);
  CheckRange("SimulationOptions", "absolute_tolerance", absolute_tolerance, 1e-15, 1e-2);
  if (drift_tolerance != 0) {
    CheckRange("SimulationOptions", "drift_tolerance", drift_tolerance, 1e-13, 1e-3);
  }
  CheckRange("SimulationOptions", "max_step", max_step, 0, 1e12);
  CheckRange("SimulationOptions", "max_steps", static_cast<double>(max_steps), 1, 1e15);
}

}  // namespace vmech
