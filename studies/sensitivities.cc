#include "vmech/studies/sensitivities.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <exception>
#include <functional>
#include <limits>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <utility>

#include "vmech/dynamics/loads/track_motion.h"
#include "vmech/dynamics/sensitivity/load_derivatives.h"
#include "vmech/dynamics/sensitivity/load_gradient.h"
#include "vmech/studies/figure_values.h"

namespace vmech {
namespace {

constexpr double kStep = 1e-3;  // of a parameter's scale, for the slopes of the file's numbers
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Poses at which loops are seen to stay closed, whatever else matters.
std::vector<size_t> SpreadPoses(size_t poses) {
  constexpr size_t kSpread = 8;
  std::set<size_t> spread;
  for (size_t k = 0; k < kSpread; ++k) spread.insert(k * poses / kSpread);
  return {spread.begin(), spread.end()};
}

/// Calls work(0), work(1), .. work(count - 1), divided among threads.
void Share(size_t count, int threads, const std::function<void(size_t)>& work) {
  std::atomic<size_t> next{0};
  std::mutex mutex;
  std::exception_ptr error;
  const auto take = [&] {
    try {
      for (size_t k; (k = next.fetch_add(1)) < count;) work(k);
    } catch (...) {
      const std::scoped_lock lock(mutex);
      error = std::current_exception();
    }
  };
  std::vector<std::thread> helpers;
  for (int i = 1; i < threads; ++i) helpers.emplace_back(take);
  take();
  for (std::thread& helper : helpers) helper.join();
  if (error) std::rethrow_exception(error);
}

/// The study with its parameters.
class Differentiator {
 public:
  Differentiator(const StudyFile& file, const StudyOutcome& outcome, Sensitivities* result)
      : file_(file),
        outcome_(outcome),
        result_(*result),
        prepared_(PrepareStudy(file.study)),
        motion_(TrackMotion(file.study, prepared_, LoadStudyOptions().closure_tolerance)) {}

  const LoadModel& model() const { return prepared_.model; }

  void Run(int threads) {
    Evaluate();
    changes_.resize(result_.parameters.size());
    requests_.resize(changes_.size());
    Share(changes_.size(), threads, [this](size_t p) { Change(p); });
    if (!gradients()) return;
    LeaveOutRefused();
    if (changes_.empty()) return;
    Share(result_.figures.size(), threads, [this](size_t f) { TakeGradient(f); });
  }

 private:
  bool gradients() const { return LoadGradients::Exist(model(), motion_); }

  /// The values of the figures, and at which poses they depend on the loads.
  void Evaluate() {
    const LoadRows<double> loads = EvaluateLoads(prepared_, motion_);
    FigureValues figures(file_, outcome_, loads);
    const std::vector<size_t> spread = SpreadPoses(motion_.size());
    std::set<size_t> poses(spread.begin(), spread.end());
    for (FigureSlopes& f : result_.figures) {
      values_.push_back(figures.Of(f.figure, !f.slopes.empty()));
      f.value = values_.back().value;
      f.pose = values_.back().pose;
      poses.insert(values_.back().by_loads.poses.begin(), values_.back().by_loads.poses.end());
    }
    if (poses.size() < motion_.size()) TakePart({poses.begin(), poses.end()});
    for (const size_t pose : spread) spread_.push_back(PlaceOf(pose));
  }

  void TakePart(std::vector<size_t> poses) {
    poses_ = std::move(poses);
    motion_ = PartOf(motion_, poses_);
    for (FigureValue& value : values_) {
      for (size_t& pose : value.by_loads.poses) pose = PlaceOf(pose);
    }
  }

  /// Of a pose of the study in `motion_`.
  size_t PlaceOf(size_t pose) const {
    if (poses_.empty()) return pose;
    return static_cast<size_t>(std::lower_bound(poses_.begin(), poses_.end(), pose) -
                               poses_.begin());
  }

  /// How the study goes with a parameter; and the figures, where the loads have no gradient.
  void Change(size_t p) {
    try {
      const StudyParameter& parameter = result_.parameters[p];
      const double step = kStep * parameter.scale;
      std::array<std::vector<double>, 5> requests;
      size_t calls = 0;
      const auto at = [&](double value) {
        StudyFile changed = file_;
        parameter.put(value, &changed);
        requests[calls++] = RequestNumbers(changed);
        LeavePart(&changed.study);
        return std::move(changed.study);
      };
      changes_[p] = ChangeOfStudy(prepared_, motion_, at, parameter.value, step);
      changes_[p].pose_numbers = poses_;
      RequireSameForm(requests);
      RequireSameShares(changes_[p]);
      requests_[p] = FivePointSlopes(requests, step);
      if (gradients()) {
        DifferentiateLoads(prepared_, motion_, changes_[p], spread_);  // throws where a loop opens
      } else {
        TakeSlopes(p, DifferentiateLoads(prepared_, motion_, changes_[p]));
      }
    } catch (const std::exception& error) {
      result_.refusals[p] = error.what();
    }
  }

  void RequireSameForm(const std::array<std::vector<double>, 5>& requests) const {
    for (const std::vector<double>& numbers : requests) {
      if (numbers.size() == RequestNumbers(file_).size()) continue;
      throw std::invalid_argument(
          "a parameter that changes how many bearings or points there are has no derivative");
    }
  }

  /// What statics leaves open goes by stiffnesses, whose slopes are not taken along.
  void RequireSameShares(const StudyChange& change) const {
    if (!change.shares || model().rule != ReactionRule::kStiffness) return;
    for (const FigureSlopes& f : result_.figures) {
      if (f.slopes.empty() || f.not_determined.empty()) continue;
      throw std::invalid_argument(
          fmt::format("it changes stiffnesses, by which the rule settles what statics does not "
                      "determine of {}: that has no derivative here",
                      f.figure.name));
    }
  }

  void TakeSlopes(size_t p, const LoadRows<Dual>& loads) {
    for (size_t f = 0; f < values_.size(); ++f) {
      if (result_.figures[f].slopes.empty()) continue;
      double slope = SlopeBesideLoads(values_[f], changes_[p], requests_[p]);
      const LoadRows<double>& by_loads = values_[f].by_loads;
      for (size_t i = 0; i < by_loads.poses.size(); ++i) {
        for (size_t k = 0; k < loads.layout.width(); ++k) {
          slope += by_loads.row(i)[k] * loads.row(by_loads.poses[i])[k].slope;
        }
      }
      result_.figures[f].slopes[p] = slope;
    }
  }

  void LeaveOutRefused() {
    for (size_t p = 0; p < changes_.size(); ++p) {
      if (!result_.refusals[p].empty()) continue;
      if (varied_.size() < p) changes_[varied_.size()] = std::move(changes_[p]);
      varied_.push_back(p);
    }
    changes_.resize(varied_.size());
  }

  void TakeGradient(size_t f) {
    if (result_.figures[f].slopes.empty()) return;
    LoadGradients gradients(prepared_, motion_, changes_);
    const StudyGradient gradient = gradients.Of(values_[f].by_loads);
    for (size_t k = 0; k < varied_.size(); ++k) {
      result_.figures[f].slopes[varied_[k]] =
          SlopeBesideLoads(values_[f], changes_[k], requests_[varied_[k]]) +
          SlopeAlong(changes_[k], gradient, model(), motion_);
    }
  }

  /// Leaves a study the poses of `motion_`. One that has others altogether is left alone.
  void LeavePart(LoadStudy* study) const {
    if (poses_.empty() || study->times.size() != file_.study.times.size()) return;
    std::vector<double> times;
    for (const size_t pose : poses_) times.push_back(study->times[pose]);
    study->times = std::move(times);
  }

  const StudyFile& file_;
  const StudyOutcome& outcome_;
  Sensitivities& result_;
  const PreparedStudy prepared_;
  Motion motion_;                     // at the poses that matter,
  std::vector<size_t> poses_;         // which are these; all if there are none
  std::vector<size_t> spread_;        // of motion_, those at which loops are seen to stay closed
  std::vector<FigureValue> values_;   // [figures]
  std::vector<StudyChange> changes_;  // by parameter, in the end by those in
  std::vector<size_t> varied_;        // which have derivatives
  std::vector<std::vector<double>> requests_;  // [parameters] slopes of RequestNumbers
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
  differentiator.Run(options.threads);
  return result;
}

}  // namespace vmech
