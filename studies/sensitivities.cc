#include "vmech/studies/sensitivities.h"

#include <atomic>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <thread>
#include <utility>

#include "vmech/dynamics/loads/track_motion.h"
#include "vmech/dynamics/sensitivity/motion_part.h"

namespace vmech {
namespace {

constexpr double kStep = 1e-3;  // of a parameter's scale, for the slopes of the file's numbers
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Poses at which loops are seen to stay closed, whatever else matters.
std::set<size_t> SpreadPoses(size_t poses) {
  constexpr size_t kSpread = 8;
  std::set<size_t> spread;
  for (size_t k = 0; k < kSpread; ++k) spread.insert(k * poses / kSpread);
  return spread;
}

/// The study with one parameter after the other.
class Differentiator {
 public:
  Differentiator(const StudyFile& file, const StudyOutcome& outcome, Sensitivities* result)
      : file_(file),
        outcome_(outcome),
        result_(*result),
        prepared_(PrepareStudy(file.study)),
        motion_(TrackMotion(file.study, prepared_, LoadStudyOptions().closure_tolerance)) {}

  const LoadModel& model() const { return prepared_.model; }

  /// The values of the figures, which depend on no parameter.
  void Evaluate() {
    const StudyChange still = ChangeOfStudy(
        prepared_, motion_, [this](double) { return file_.study; }, 0, 1);
    const LoadDerivatives loads = DifferentiateLoads(prepared_, motion_, still);
    std::set<size_t> poses = SpreadPoses(motion_.size());
    for (FigureSlopes& f : result_.figures) {
      f.value = ValueOf(f.figure, file_, outcome_, still, loads).value;
      f.pose = PeakPose(f.figure, file_, loads);
      if (f.slopes.empty()) continue;
      for (const size_t pose : PosesThatMatter(f.figure, file_, loads)) poses.insert(pose);
    }
    if (poses.size() == motion_.size()) return;
    poses_.assign(poses.begin(), poses.end());
    motion_ = PartOf(motion_, poses_);
  }

  void Differentiate(size_t p) {
    try {
      const StudyParameter& parameter = result_.parameters[p];
      const auto at = [&](double value) {
        StudyFile changed = file_;
        parameter.put(value, &changed);
        TakePart(&changed.study);
        return std::move(changed.study);
      };
      StudyChange change =
          ChangeOfStudy(prepared_, motion_, at, parameter.value, kStep * parameter.scale);
      change.pose_numbers = poses_;
      const LoadDerivatives loads = DifferentiateLoads(prepared_, motion_, change);
      for (FigureSlopes& f : result_.figures) {
        if (f.slopes.empty()) continue;
        f.slopes[p] = ValueOf(f.figure, file_, outcome_, change, loads).slope;
      }
    } catch (const std::exception& error) {
      result_.refusals[p] = error.what();
    }
  }

 private:
  /// Leaves a study the poses of `motion_`. One that has others altogether is left alone.
  void TakePart(LoadStudy* study) const {
    if (poses_.empty() || study->times.size() != file_.study.times.size()) return;
    std::vector<double> times;
    for (const size_t pose : poses_) times.push_back(study->times[pose]);
    study->times = std::move(times);
  }

  const StudyFile& file_;
  const StudyOutcome& outcome_;
  Sensitivities& result_;
  const PreparedStudy prepared_;
  Motion motion_;              // at the poses that matter,
  std::vector<size_t> poses_;  // which are these; all if there are none
};

}  // namespace

double FigureSlopes::Elasticity(size_t parameter, const StudyParameter& of) const {
  if (slopes.empty() || value == 0) return kNone;
  return slopes[parameter] * of.value / value;
}

Sensitivities FindSensitivities(const StudyFile& file, const StudyOutcome& outcome,
                                std::vector<Figure> figures, std::vector<StudyParameter> parameters,
                                const SensitivityOptions& options) {
  if (file.simulation) {
    throw std::invalid_argument(
        "a simulation has no sensitivities: its motion depends on all of its past. Prescribe the "
        "motion by a drive");
  }
  Sensitivities result;
  result.parameters = std::move(parameters);
  result.refusals.resize(result.parameters.size());
  for (Figure& figure : figures) {
    FigureSlopes slopes;
    slopes.not_determined = NotDeterminedIn(figure, file, outcome);
    slopes.figure = std::move(figure);
    if (slopes.not_determined.empty() || options.undetermined) {
      slopes.slopes.assign(result.parameters.size(), kNone);
    }
    result.figures.push_back(std::move(slopes));
  }
  Differentiator differentiator(file, outcome, &result);
  const std::string reason = ReasonAgainstDerivatives(differentiator.model());
  if (!reason.empty()) throw std::invalid_argument("the study has no sensitivities: " + reason);
  differentiator.Evaluate();
  std::atomic<size_t> next{0};
  const auto work = [&] {
    for (size_t p; (p = next.fetch_add(1)) < result.parameters.size();) {
      differentiator.Differentiate(p);
    }
  };
  std::vector<std::thread> helpers;
  for (int i = 1; i < options.threads; ++i) helpers.emplace_back(work);
  work();
  for (std::thread& helper : helpers) helper.join();
  return result;
}

}  // namespace vmech
