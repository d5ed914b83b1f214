#include "vmech/studies/study.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <vector>

#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/open_components.h"
#include "vmech/dynamics/loads/run_load_study.h"
#include "vmech/dynamics/simulation/motion_loads.h"
#include "vmech/dynamics/simulation/simulate.h"

namespace vmech {
namespace {

DutyCycle CycleOfJoint(const LoadStudy& study, const LoadStudyResult& loads, int joint,
                       int freedom) {
  DutyCycle cycle;
  std::vector<double> times;
  for (const PoseLoads& pose : loads.poses) {
    times.push_back(pose.time);
    cycle.angle.push_back(pose.joints[joint].position[freedom]);
    cycle.speed.push_back(pose.joints[joint].rate[freedom]);
    cycle.wrench.push_back(pose.joints[joint]);
  }
  cycle.duration = DurationsFromTimes(times, study.cycle);
  return cycle;
}

/// Everything that loads a bearing but the moment about its own axis.
LoadCertainty CertaintyOfLoads(const JointCertainty& certainty) {
  const bool certain = std::all_of(certainty.begin(), certainty.begin() + 5,
                                   [](Certainty c) { return c == Certainty::kCertain; });
  return certain ? LoadCertainty::kCertain : LoadCertainty::kDependsOnRule;
}

void RunSimulation(const StudyFile& file, const LoadStudyOptions& options, StudyOutcome* outcome) {
  SimulationOptions how = file.simulation->options;
  if (options.progress) {
    how.progress = [&](double time) {
      const std::vector<double>& times = file.study.times;
      const auto reached = std::upper_bound(times.begin(), times.end(), time);
      return options.progress(static_cast<size_t>(reached - times.begin()));
    };
  }
  SimulationResult result = Simulate(SimulationOf(file), how);
  outcome->loads = std::move(result.loads);
  outcome->loads.notes.insert(outcome->loads.notes.end(), result.notes.begin(), result.notes.end());
  outcome->loads.warnings.insert(outcome->loads.warnings.end(), result.warnings.begin(),
                                 result.warnings.end());
  outcome->simulation = std::move(result);
}

}  // namespace

int TurnAboutAxis(JointType type) {
  switch (type) {
    case JointType::kRevolute:
    case JointType::kScrew:
      return 0;
    case JointType::kCylindrical:
      return 1;
    case JointType::kPlanar:
      return 2;
    default:
      return -1;
  }
}

Simulation SimulationOf(const StudyFile& file) {
  Simulation simulation = file.simulation ? file.simulation->simulation : Simulation();
  simulation.mechanism = file.study.mechanism;
  simulation.drives = file.study.drives;
  simulation.external = file.study.external;
  simulation.times = file.study.times;
  simulation.rule = file.study.rule;
  simulation.norm_length = file.study.norm_length;
  simulation.units = file.study.units;
  return simulation;
}

StudyOutcome RunStudy(const StudyFile& file, const LoadStudyOptions& options) {
  StudyOutcome outcome;
  if (file.history) {
    outcome.loads = EvaluateMotionLoads(SimulationOf(file), *file.history, options.progress);
  } else if (file.simulation) {
    RunSimulation(file, options, &outcome);
  } else {
    outcome.loads = RunLoadStudy(file.study, options);
  }
  outcome.loads.notes.insert(outcome.loads.notes.begin(), file.notes.begin(), file.notes.end());
  outcome.warnings = outcome.loads.warnings;
  for (const BearingRequest& request : file.bearings) {
    const Joint& joint = file.study.mechanism.joints[request.joint];
    const int freedom = TurnAboutAxis(joint.type);
    if (freedom < 0) {
      throw std::invalid_argument(fmt::format(
          "joint '{}' is {} and does not turn about one axis; bearings can be chosen for revolute, "
          "cylindrical, screw and planar joints",
          joint.name, NameOf(joint.type)));
    }
    const DutyCycle cycle = CycleOfJoint(file.study, outcome.loads, request.joint, freedom);
    outcome.bearings.push_back(
        {request.joint,
         SelectJointBearings(cycle, request.arrangement, request.requirements,
                             CertaintyOfLoads(VerdictsThatMatter(outcome.loads, request.joint)),
                             file.catalogue)});
    for (const std::string& warning : outcome.bearings.back().bearings.warnings) {
      outcome.warnings.push_back(joint.name + ": " + warning);
    }
  }
  return outcome;
}

}  // namespace vmech
