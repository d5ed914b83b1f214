#include <stdexcept>
#include <utility>

#include "handles.h"
#include "vmech/bindings/shared/posed_mechanism.h"
#include "vmech/kinematics/motion/motion_law.h"
#include "vmech/mechanisms/validity.h"
#include "vmech/studies/study_reader.h"

namespace vmech::c {
namespace {

/// A motor as the program states it; RunStudy says what is wrong with its place.
JointDrive DriveOf(const vmech_drive& drive) {
  if (drive.rows == 0) {
    return {drive.joint, drive.freedom,
            MotionLaw::Uniform(drive.start, drive.speed, drive.acceleration)};
  }
  RequirePointer("drive.times", drive.times);
  RequirePointer("drive.values", drive.values);
  return {drive.joint, drive.freedom,
          MotionLaw::Table({drive.times, drive.times + drive.rows},
                           {drive.values, drive.values + drive.rows})};
}

/// What the program says now and then, remembered.
class Progress {
 public:
  explicit Progress(const vmech_run_options& options) : options_(options) {}

  std::function<bool(size_t)> Callback() {
    if (options_.progress == nullptr) return {};
    return [this](size_t poses) {
      if (options_.progress(options_.user, poses) == 0) stopped_ = true;
      return !stopped_;
    };
  }
  bool stopped() const { return stopped_; }

 private:
  const vmech_run_options& options_;
  bool stopped_ = false;
};

/// A simulation that stopped early is a failure that has numbers.
void JudgeSimulation(const StudyOutcome& outcome, vmech_result* result) {
  if (!outcome.simulation) return;
  const SimulationStatus status = outcome.simulation->status;
  if (status == SimulationStatus::kFinished || status == SimulationStatus::kReached) return;
  result->message = outcome.simulation->message;
  result->status = status == SimulationStatus::kInterrupted ? VMECH_INTERRUPTED : VMECH_NO_SOLUTION;
}

void Run(const StudyFile& file, const vmech_run_options& given, vmech_result* result) {
  Progress progress(given);
  LoadStudyOptions options;
  options.threads = given.threads == 0 ? 1 : given.threads;
  options.progress = progress.Callback();
  try {
    result->computed = Computed(RunStudy(file, options));
  } catch (const std::runtime_error& error) {
    if (!progress.stopped()) throw;
    result->message = error.what();
    result->status = VMECH_INTERRUPTED;
    return;
  }
  JudgeSimulation(result->computed.outcome(), result);
}

Backend SolverOf(const char* name) {
  if (name == nullptr) return Backend::kNullspace;
  const std::optional<Backend> backend = BackendFromName(name);
  if (backend) return *backend;
  std::string names;
  for (const Backend b : kAllBackends) names += " " + std::string(NameOf(b));
  throw std::invalid_argument("solver: there is no " + std::string(name) + "; there are" + names);
}

HandQuestion QuestionOf(const vmech_ik_options& options) {
  return {options.grasp, PoseOf(options.hand), Eigen::Map<const Vector6d>(options.stiffness),
          options.ignore_limits == 0, SolverOf(options.solver)};
}

ModesQuestion QuestionOf(const vmech_modes_options& options) {
  ModesQuestion question;
  if (options.held_count > 0) {
    RequirePointer("options.held", options.held);
    question.held.assign(options.held, options.held + options.held_count);
  }
  if (options.with_hand != 0) {
    question.grasp = options.grasp;
    question.X_WH = PoseOf(options.hand);
    RequireNonNegative("options.grasp", options.grasp);
  }
  question.joint_limits = options.ignore_limits == 0;
  if (options.max_starts != 0) question.max_starts = options.max_starts;
  if (options.patience != 0) question.patience = options.patience;
  if (options.seed != 0) question.seed = options.seed;
  return question;
}

}  // namespace
}  // namespace vmech::c

using namespace vmech::c;

vmech_study* vmech_study_open(const char* path) {
  return vmech_study_open_with(path, nullptr);
}

vmech_study* vmech_study_open_with(const char* path, const vmech_read_options* options) {
  return Make<vmech_study>([&](vmech_study* handle) {
    RequirePointer("path", path);
    handle->file = vmech::ReadStudy(path, SettingsOf(options));
  });
}

vmech_status vmech_study_parameter(const vmech_study* study, size_t index,
                                   vmech_parameter* parameter) {
  if (study == nullptr) return VMECH_OUT_OF_MEMORY;
  return ParameterAt(study, study->file.parameters, index, parameter);
}

vmech_study* vmech_study_new(const vmech_mechanism* mechanism) {
  return Make<vmech_study>([&](vmech_study* handle) {
    handle->file.study.mechanism = Sound(mechanism).mechanism;
    handle->file.study.times = {0};
  });
}

vmech_mechanism* vmech_study_mechanism(const vmech_study* study) {
  return Make<vmech_mechanism>([&](vmech_mechanism* handle) {
    handle->mechanism = Sound(study).file.study.mechanism;
    handle->freedoms = vmech::NamesOfAllFreedoms(handle->mechanism);
    handle->parameters = study->file.parameters;
  });
}

vmech_status vmech_study_add_drive(vmech_study* study, const vmech_drive* drive) {
  return Do(study, [&] { study->file.study.drives.push_back(DriveOf(Read("drive", drive))); });
}

vmech_status vmech_study_set_times(vmech_study* study, const double* times, size_t count,
                                   double cycle) {
  return Do(study, [&] {
    RequirePointer("times", times);
    study->file.study.times.assign(times, times + count);
    study->file.study.cycle = cycle;
  });
}

vmech_status vmech_study_add_load(vmech_study* study, int32_t link, const double point[3],
                                  const double wrench[6], int32_t in_link_axes) {
  return Do(study, [&] {
    RequirePointer("point", point);
    RequirePointer("wrench", wrench);
    vmech::ExternalLoad load;
    load.link = link;
    load.p_L = VectorOf(point);
    load.at = {0};
    load.wrenches = {{VectorOf(wrench), VectorOf(wrench + 3)}};
    if (in_link_axes != 0) load.axes = vmech::ExternalLoad::Axes::kLink;
    study->file.study.external.push_back(std::move(load));
  });
}

vmech_result* vmech_study_run(const vmech_study* study, const vmech_run_options* options) {
  return Make<vmech_result>([&](vmech_result* result) {
    Run(Sound(study).file, ReadOrDefault("options", options), result);
  });
}

vmech_result* vmech_ik(const vmech_mechanism* mechanism, const vmech_ik_options* options) {
  return Make<vmech_result>([&](vmech_result* result) {
    result->computed =
        vmech::FindNearestPose(Sound(mechanism).mechanism, QuestionOf(Read("options", options)));
  });
}

vmech_result* vmech_assembly_modes(const vmech_mechanism* mechanism,
                                   const vmech_modes_options* options) {
  return Make<vmech_result>([&](vmech_result* result) {
    result->computed = vmech::FindAllPoses(Sound(mechanism).mechanism,
                                           QuestionOf(ReadOrDefault("options", options)));
  });
}
