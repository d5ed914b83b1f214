#include "vmech/dynamics/loads/run_load_study.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numeric>
#include <span>
#include <stdexcept>
#include <thread>

#include "vmech/base/array_memory.h"
#include "vmech/base/lanes4.h"
#include "vmech/dynamics/loads/friction_report.h"
#include "vmech/dynamics/loads/load_peaks.h"
#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/open_components.h"
#include "vmech/dynamics/loads/pose/external_loads.h"
#include "vmech/dynamics/loads/pose/pose_loads.h"
#include "vmech/dynamics/loads/pose/store_pose_loads.h"
#include "vmech/dynamics/loads/pose_warnings.h"
#include "vmech/dynamics/loads/rule_dependence.h"
#include "vmech/dynamics/loads/study_plausibility.h"
#include "vmech/dynamics/loads/track_motion.h"
#include "vmech/mechanisms/freedoms.h"

namespace vmech {
namespace {

constexpr size_t kChunk = 64;  // poses a thread takes at a time

void RequireInsideTables(const LoadModel& model, const Motion& motion) {
  for (size_t i = 0; i < motion.size(); ++i) {
    for (const ExternalLoad& load : model.external) {
      const double at = TableArgument(model, load, motion, i);
      if (!OutsideTable(load, at)) continue;
      throw std::invalid_argument(fmt::format(
          "pose {}: the table of the external load on link '{}' covers {:.6g} to {:.6g}, but "
          "{:.6g} "
          "is asked for; extend the table or give it a `period`",
          i, model.tree.mechanism.links[load.link].name, load.at.front(), load.at.back(), at));
    }
  }
}

/// Evaluates all poses on several threads; each pose depends on its own input only.
class ParallelEvaluation {
 public:
  ParallelEvaluation(const LoadStudy& study, const LoadModel& model, const Motion& motion,
                     const LoadStudyOptions& options, LoadArrays* loads)
      : study_(study), model_(model), motion_(motion), options_(options), loads_(loads) {}

  void Run() {
    const size_t chunks = (motion_.size() + kChunk - 1) / kChunk;
    const size_t helpers = std::min<size_t>(options_.threads, std::max<size_t>(chunks, 1)) - 1;
    std::vector<std::thread> threads;
    for (size_t i = 0; i < helpers; ++i) threads.emplace_back([this] { Work(false); });
    Work(true);
    for (std::thread& thread : threads) thread.join();
    if (stopped_) throw std::runtime_error("the study was stopped before its end");
    if (dead_centre_ < motion_.size()) ReportDeadCentre(dead_centre_);
  }

 private:
  void Work(bool reports) {
    LoadWorkspace<double> ws(model_);
    LoadWorkspace<Lanes4> packet_ws(model_);
    const bool in_packets = RunsInLanes(model_);
    for (;;) {
      const size_t begin = next_.fetch_add(kChunk);
      if (begin >= motion_.size() || stopped_) return;
      const size_t end = std::min(begin + kChunk, motion_.size());
      for (size_t i = begin; i < end;) {
        if (in_packets && i + Lanes4::kLanes <= end && Evaluate(i, &packet_ws)) {
          i += Lanes4::kLanes;
        } else if (Evaluate(i, &ws)) {
          ++i;
        } else {
          RememberDeadCentre(i++);
        }
      }
      done_ += end - begin;
      if (reports && options_.progress && !options_.progress(done_)) stopped_ = true;
    }
  }

  template <typename T>
  bool Evaluate(size_t i, LoadWorkspace<T>* ws) {
    if (!EvaluatePoseLoads(model_, motion_, i, ws)) return false;
    StorePoseLoads(model_, motion_, i, *ws, loads_);
    return true;
  }

  /// The first dead centre, whichever thread finds it.
  void RememberDeadCentre(size_t i) {
    size_t first = dead_centre_;
    while (i < first && !dead_centre_.compare_exchange_weak(first, i)) {
    }
  }

  [[noreturn]] void ReportDeadCentre(size_t i) const {
    std::vector<double> positions;
    for (size_t k = 0; k < study_.drives.size(); ++k) {
      positions.push_back(motion_.drives[i * study_.drives.size() + k].position);
    }
    throw std::runtime_error(
        fmt::format("pose {} (t = {:.6g} s) is a dead centre: {} the drive does not determine how "
                    "the mechanism "
                    "moves on, and no drive force holds it. {}",
                    i, motion_.times[i], DrivesAt(study_, positions), kPastDeadCentre));
  }

  const LoadStudy& study_;
  const LoadModel& model_;
  const Motion& motion_;
  const LoadStudyOptions& options_;
  LoadArrays* loads_;
  std::atomic<size_t> next_{0}, done_{0};
  std::atomic<size_t> dead_centre_{std::numeric_limits<size_t>::max()};
  std::atomic<bool> stopped_{false};
};

/// Poses at which certainty is judged: evenly spread, a dozen or so.
std::vector<size_t> JudgedPoses(size_t count) {
  constexpr size_t kJudged = 13;
  std::vector<size_t> judged;
  for (size_t i = 0; i < std::min(count, kJudged); ++i)
    judged.push_back(i * count / std::min(count, kJudged));
  return judged;
}

/// What depends on the choices that are the user's is not determined.
void AddRuleDependence(const PreparedStudy& prepared, const Motion& motion,
                       const std::vector<size_t>& poses, const LoadPeaks& peaks,
                       LoadStudyResult* result) {
  const LoadModel& model = prepared.model;
  result->drive_certainty.assign(model.drives.size(), Certainty::kCertain);
  const bool settled_by_choice = model.has_load_friction || model.hand;
  const bool by_rule = model.rule == ReactionRule::kPaperJoint;
  if (by_rule || !(settled_by_choice || AnyNotDetermined(*result))) {
    result->open = FindOpenComponents(*result, peaks, nullptr, model.tree.length);
    return;
  }
  const RuleDependence dependence = FindRuleDependence(prepared, motion, poses);
  for (size_t j = 0; settled_by_choice && j < result->certainty.size(); ++j) {
    for (int k = 0; k < 6; ++k) {
      if (dependence.joints[j][k]) result->certainty[j][k] = Certainty::kNotDetermined;
    }
  }
  result->open = FindOpenComponents(*result, peaks, &dependence, model.tree.length);
  if (!settled_by_choice) return;
  std::string drives;
  for (size_t k = 0; k < model.drives.size(); ++k) {
    if (!dependence.drives[k]) continue;
    result->drive_certainty[k] = Certainty::kNotDetermined;
    const JointDrive& drive = model.drives[k];
    drives += fmt::format("{}'{}'", drives.empty() ? "" : ", ",
                          NameOfFreedom(model.tree.mechanism.joints[drive.joint], drive.freedom));
  }
  if (drives.empty()) return;
  result->warnings.push_back(fmt::format(
      "the force of the drive at {} is not determined by statics: friction depends on loads that "
      "the rule '{}' settles",
      drives, NameOf(model.rule)));
}

/// What statics leaves open at any pose it leaves open; singular counts only if it is so
/// everywhere.
std::vector<JointCertainty> JudgeStudy(const LoadModel& model, const Motion& motion,
                                       const std::vector<size_t>& poses) {
  std::vector<JointCertainty> verdict;
  for (size_t i : poses) {
    const auto here = JudgeCertainty(model.tree, model.partition, motion.q(i), model.rounding);
    if (verdict.empty()) {
      verdict = here;
      continue;
    }
    for (size_t j = 0; j < here.size(); ++j) {
      for (int k = 0; k < 6; ++k) {
        if (here[j][k] == Certainty::kNotDetermined || verdict[j][k] == Certainty::kSingular) {
          verdict[j][k] = here[j][k];
        }
      }
    }
  }
  return verdict;
}

bool AllFinite(std::span<const double> numbers) {
  const Eigen::Map<const VectorXd> x(numbers.data(), static_cast<Eigen::Index>(numbers.size()));
  return (x - x).sum() == 0;
}

bool IsFinite(const PoseLoads& pose) {
  return pose.hand.Stacked().allFinite() && std::isfinite(pose.power_error_scale) &&
         std::all_of(pose.drives.begin(), pose.drives.end(),
                     [](const DriveSample& drive) { return std::isfinite(drive.force); }) &&
         std::all_of(pose.joints.begin(), pose.joints.end(),
                     [](const JointSample& joint) { return joint.Stacked().allFinite(); });
}

/// Figures that overflow have no answer.
void RequireFinite(const PoseSeries& poses) {
  const LoadArrays& loads = poses.arrays();
  const bool finite = AllFinite(loads.wrenches) && AllFinite(loads.drive_forces) &&
                      AllFinite(loads.power_error_scales) && loads.hands.empty();
  for (size_t i = 0; !finite && i < poses.size(); ++i) {
    if (IsFinite(poses[i])) continue;
    throw std::runtime_error(fmt::format(
        "pose {} (t = {:.6g} s): the loads are too large to be computed; check the units of "
        "masses, inertias, speeds and external loads",
        i, poses[i].time));
  }
}

/// The larger one; what is not a number is, too.
double Larger(double a, double b) {
  return std::isnan(a) || (a > b && !std::isnan(b)) ? a : b;
}

double Largest(std::span<const double> numbers, double at_least) {
  return std::accumulate(numbers.begin(), numbers.end(), at_least,
                         [](double largest, double x) { return Larger(x, largest); });
}

/// The errors of the self-checks. Powers are measured by the largest of the study: at a pose where
/// they all but vanish their balance is that of the rounding of others. So it is where nothing
/// moves; a length in three years is no motion.
void CheckBalance(double length, double largest_force, LoadArrays* loads, LoadStudyResult* result) {
  constexpr double kAtRest = 1e-8;  // [1/s]
  const double largest = Largest(loads->power_error_scales, kAtRest * length * largest_force);
  for (double& error : loads->power_errors) {
    if (error != 0) error /= largest;
  }
  result->max_closure = Largest(loads->closures, 0);
  result->max_power_error = Largest(loads->power_errors, 0);
}

/// Where a motion is beyond the limits of one freedom.
struct LimitPassed {
  size_t poses = 0, first = 0, worst = 0;
  double most = 0;  ///< at the worst pose [m] or [rad]
};

LimitPassed FindPassed(const LoadStudyResult& result, size_t joint, int freedom, double lower,
                       double upper) {
  constexpr double kOnLimit = 1e-9;  // [m, rad]
  LimitPassed passed;
  const LoadArrays& loads = result.poses.arrays();
  const double* position_at = &loads.positions[loads.first_freedom[joint] + freedom];
  for (size_t i = 0; i < result.poses.size(); ++i) {
    const double position = position_at[i * loads.freedom_count()];
    const double beyond = std::max(lower - position, position - upper);
    if (!(beyond > kOnLimit)) continue;
    if (passed.poses++ == 0) passed.first = i;
    if (beyond <= passed.most) continue;
    passed.most = beyond;
    passed.worst = i;
  }
  return passed;
}

std::string DescribePassed(const LoadStudy& study, const LoadStudyResult& result, size_t j, int k,
                           const LimitPassed& passed) {
  const Joint& joint = study.mechanism.joints[j];
  const auto text = [&](double value) { return FormatCoordinate(study.units, joint, k, value); };
  return fmt::format(
      "the motion leaves the limits {} to {} of joint '{}' at {} of {} poses, from pose {} (t = "
      "{:.6g} s) on; by {} at most, at pose {}, where it is at {}",
      text(joint.lower[k]), text(joint.upper[k]), NameOfFreedom(joint, k), passed.poses,
      result.poses.size(), passed.first, result.poses[passed.first].time, text(passed.most),
      passed.worst, text(result.poses[passed.worst].joints[j].position[k]));
}

/// Warns where the motion leaves the limits of a joint, or refuses it.
void WatchLimits(const LoadStudy& study, LoadStudyResult* result) {
  for (size_t j = 0; j < study.mechanism.joints.size(); ++j) {
    const Joint& joint = study.mechanism.joints[j];
    if (joint.type == JointType::kSpherical) continue;
    for (int k = 0; k < FreedomsOf(joint.type); ++k) {
      if (std::isinf(joint.lower[k]) && std::isinf(joint.upper[k])) continue;
      const LimitPassed passed = FindPassed(*result, j, k, joint.lower[k], joint.upper[k]);
      if (passed.poses == 0) continue;
      const std::string message = DescribePassed(study, *result, j, k, passed);
      if (study.stop_at_limits) throw std::runtime_error(message);
      result->warnings.push_back(message);
    }
  }
}

/// A load along a freedom without inertia has no answer.
void RefuseUnresisted(const LoadModel& model, double largest_force, const LoadStudyResult& result) {
  const double rounding = RoundingAlongIdle(model, largest_force);
  const std::vector<PoseState>& states = result.poses.arrays().states;
  for (size_t i = 0; i < states.size(); ++i) {
    const double unresisted = states[i].unresisted;
    if (unresisted <= rounding) continue;
    throw std::runtime_error(fmt::format(
        "pose {} (t = {:.6g} s): a load of {:.4g} N or N m acts along an idle freedom ({}), and "
        "nothing resists it: no drive, no inertia. Leave the load out, or give the link inertia "
        "and a drive",
        i, result.poses[i].time, unresisted, fmt::join(result.idle, ", ")));
  }
}

void Summarise(const LoadModel& model, const Motion& motion, double largest_force,
               LoadArrays* loads, LoadStudyResult* result) {
  CheckBalance(model.tree.length, largest_force, loads, result);
  RefuseUnresisted(model, largest_force, *result);
  WarnOfDrivenIdle(model, largest_force, result);
  FindSingularPoses(model, motion, result);
  AddFrictionWarnings(model.tree.mechanism, result);
}

}  // namespace

LoadStudyResult RunLoadStudy(const LoadStudy& study, const LoadStudyOptions& options) {
  options.Validate();
  return RunLoadStudy(study, PrepareStudy(study), options);
}

LoadStudyResult RunLoadStudy(const LoadStudy& study, const PreparedStudy& prepared,
                             const LoadStudyOptions& options) {
  options.Validate();
  std::function<bool()> goes_on;
  if (options.progress) goes_on = [&] { return options.progress(0); };
  const ArrayMemory memory(BytesOfMotion(study, prepared.model.tree));
  const Motion motion =
      TrackMotion(study, prepared, options.closure_tolerance, goes_on, memory.resource());
  RequireInsideTables(prepared.model, motion);

  LoadStudyResult result;
  const auto loads =
      std::make_shared<LoadArrays>(MakeLoadArrays(prepared.model, motion, options.link_motions));
  ParallelEvaluation(study, prepared.model, motion, options, loads.get()).Run();
  result.poses = PoseSeries(loads);
  result.mobility = prepared.mobility.mobility;
  result.redundant_equations = prepared.mobility.redundant;
  for (const Loop& loop : prepared.model.tree.loops) {
    result.cut_joints.push_back(study.mechanism.joints[loop.joint].name);
  }
  result.idle = prepared.idle;
  result.norm_length = study.norm_length > 0 ? study.norm_length : prepared.model.tree.length;
  result.warnings = prepared.warnings;
  result.notes = prepared.notes;
  RequireFinite(result.poses);
  const LoadPeaks peaks = FindPeaks(*loads);
  for (std::string& doubt : DoubtsOf(study, result)) result.warnings.push_back(std::move(doubt));
  const std::vector<size_t> judged = JudgedPoses(motion.size());
  result.certainty = JudgeStudy(prepared.model, motion, judged);
  AddRuleDependence(prepared, motion, judged, peaks, &result);
  WatchLimits(study, &result);
  Summarise(prepared.model, motion, peaks.force, loads.get(), &result);
  return result;
}

}  // namespace vmech
