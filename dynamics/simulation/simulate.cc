#include "vmech/dynamics/simulation/simulate.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>

#include "vmech/dynamics/simulation/equations_of_motion.h"
#include "vmech/dynamics/simulation/integrator.h"
#include "vmech/dynamics/simulation/prepared_simulation.h"
#include "vmech/dynamics/simulation/recorder.h"
#include "vmech/dynamics/simulation/start_state.h"
#include "vmech/kinematics/loops/loops.h"

namespace vmech {
namespace {

using Clock = std::chrono::steady_clock;

/// Absolute tolerances of a state: coordinates and rates in radians and characteristic lengths;
/// energies do not count.
std::vector<double> AbsoluteTolerances(const KinematicTree& tree, double tolerance) {
  constexpr double kDoesNotCount = 1e30;
  std::vector<double> tolerances(static_cast<size_t>(tree.nq + tree.nv), tolerance);
  for (const TreeNode& node : tree.nodes) {
    if (node.motion != NodeMotion::kPrismatic) continue;
    tolerances[static_cast<size_t>(node.q)] *= tree.length;
    tolerances[static_cast<size_t>(tree.nq + node.v)] *= tree.length;
  }
  tolerances.insert(tolerances.end(), 2, kDoesNotCount);
  return tolerances;
}

/// A simulation on its way.
class Run {
 public:
  Run(const PreparedSimulation& prepared, const SimulationOptions& options,
      SimulationResult* result)
      : prepared_(prepared),
        simulation_(prepared.simulation),
        options_(options),
        result_(*result),
        statistics_(result->statistics),
        equations_(prepared),
        recorder_(prepared, options, &equations_, result),
        y_(VectorXd::Zero(equations_.size())),
        dense_(y_) {
    problem_.size = equations_.size();
    problem_.evaluate = [this](double t, const double* y, const double*, double* slopes) {
      return equations_.Slopes(t, y, slopes);
    };
    problem_.relative_tolerance = options.relative_tolerance;
    problem_.absolute_tolerances =
        AbsoluteTolerances(equations_.tree(), options.absolute_tolerance);
    problem_.max_step = options.max_step;
  }

  void Go() {
    const Clock::time_point start = Clock::now();
    FindStart();
    statistics_.method = options_.method == SimulationMethod::kAutomatic ? SimulationMethod::kAdams
                                                                         : options_.method;
    integrator_ = MakeIntegrator(problem_, statistics_.method);
    Restart();
    RecordUntil(time_);
    while (GoesOn()) TakeStep();
    if (result_.times.empty() || result_.times.back() < time_) RecordHere();
    CountUp();
    statistics_.seconds = std::chrono::duration<double>(Clock::now() - start).count();
    recorder_.Finish();
  }

 private:
  double end() const { return simulation_.times.back(); }

  void FindStart() {
    time_ = simulation_.times.front();
    const StartState start = FindStartState(prepared_, &equations_);
    result_.moved_rates = start.moved_rates;
    const KinematicTree& tree = equations_.tree();
    y_.head(tree.nq) = start.q;
    y_.segment(tree.nq, tree.nv) = start.v;
  }

  void Restart() {
    integrator_->Restart(time_, y_.data(), nullptr);
    ++statistics_.restarts;
  }

  bool GoesOn() {
    if (result_.status != SimulationStatus::kNotRun) return false;
    if (time_ >= end()) {
      result_.status = SimulationStatus::kFinished;
      return false;
    }
    if (options_.progress && !options_.progress(time_)) {
      return Stop(SimulationStatus::kInterrupted, "stopped by the user");
    }
    if (integrator_->counts().steps >= options_.max_steps) {
      return Stop(
          SimulationStatus::kFailed,
          fmt::format("{} steps were taken; allow more of them (max_steps), or ask for less "
                      "accuracy",
                      options_.max_steps));
    }
    return true;
  }

  bool Stop(SimulationStatus status, const std::string& why) {
    result_.status = status;
    result_.message = fmt::format("{} at t = {:.6g} s", why, time_);
    return false;
  }

  void TakeStep() {
    if (!integrator_->Step(end())) {
      Stop(SimulationStatus::kFailed, DescribeFailure());
      return;
    }
    time_ = integrator_->time();
    std::copy(integrator_->y(), integrator_->y() + y_.size(), y_.data());
    RecordUntil(time_);
    ReturnToLoops();
    ChangeMethodIfStiff();
  }

  std::string DescribeFailure() const {
    return integrator_->error() +
           ": the mechanism cannot be followed on (it locks, or moves beyond "
           "all bounds)";
  }

  /// Results that are due by then.
  void RecordUntil(double time) {
    while (next_ < simulation_.times.size() && simulation_.times[next_] <= time) {
      const double at = simulation_.times[next_++];
      if (at == time_) {
        dense_ = y_;
      } else {
        integrator_->At(at, dense_.data());
      }
      recorder_.Record(at, dense_.data());
    }
  }

  void RecordHere() {
    dense_ = y_;
    recorder_.Record(time_, dense_.data());
  }

  /// Brings the state back on its loops where it has left them.
  void ReturnToLoops() {
    const KinematicTree& tree = equations_.tree();
    if (tree.loops.empty() && tree.nq == tree.nv) return;
    equations_.Place(time_, y_.data(), y_.data() + tree.nq);
    const double drift = equations_.motion().closure();
    statistics_.largest_drift = std::max(statistics_.largest_drift, drift);
    if (equations_.ChoosesBadly()) equations_.ChooseFreedoms(y_.head(tree.nq));
    if (drift <= options_.drift_tolerance) return;
    equations_.Close(time_, y_.data());
    equations_.Place(time_, y_.data(), y_.data() + tree.nq);
    y_.segment(tree.nq, tree.nv) = equations_.motion().ws().v;
    ++statistics_.projections;
    Restart();
  }

  /// Fixed-point iterations that fail to converge are those of a stiff mechanism.
  void ChangeMethodIfStiff() {
    constexpr long kWindow = 50, kFailures = 10;
    if (options_.method != SimulationMethod::kAutomatic ||
        statistics_.method != SimulationMethod::kAdams) {
      return;
    }
    const IntegratorCounts counts = integrator_->counts();
    if (counts.steps < window_.steps + kWindow) return;
    const bool stiff = counts.nonlinear_failures - window_.nonlinear_failures > kFailures;
    window_ = counts;
    if (!stiff) return;
    CountUp();
    statistics_.method = SimulationMethod::kBdf;
    result_.events.push_back({time_, SimulationEvent::Kind::kMethodChanged, {}, 0, 0});
    integrator_ = MakeIntegrator(problem_, statistics_.method);
    Restart();
  }

  /// The integrator's counts into the statistics.
  void CountUp() {
    const IntegratorCounts counts = integrator_->counts();
    statistics_.steps += counts.steps;
    statistics_.error_test_failures += counts.error_test_failures;
    statistics_.nonlinear_iterations += counts.nonlinear_iterations;
    statistics_.nonlinear_failures += counts.nonlinear_failures;
    statistics_.jacobians += counts.jacobians;
    statistics_.evaluations = equations_.evaluations;
    statistics_.partitions = equations_.partitions;
    statistics_.singular_poses = equations_.singular_poses;
  }

  const PreparedSimulation& prepared_;
  const Simulation& simulation_;
  const SimulationOptions& options_;
  SimulationResult& result_;
  SimulationStatistics& statistics_;
  EquationsOfMotion equations_;
  Recorder recorder_;
  InitialValueProblem problem_;
  std::unique_ptr<Integrator> integrator_;
  double time_ = 0;
  VectorXd y_, dense_;
  size_t next_ = 0;  ///< of the times
  IntegratorCounts window_;
};

}  // namespace

SimulationResult Simulate(const Simulation& simulation, const SimulationOptions& options) {
  options.Validate();
  const PreparedSimulation prepared = PrepareSimulation(simulation);
  SimulationResult result;
  result.tree = prepared.model.tree;
  result.notes = prepared.notes;
  Run(prepared, options, &result).Go();
  return result;
}

}  // namespace vmech
