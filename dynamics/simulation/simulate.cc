#include "vmech/dynamics/simulation/simulate.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "vmech/dynamics/simulation/equations/equations_of_motion.h"
#include "vmech/dynamics/simulation/equations/index_two.h"
#include "vmech/dynamics/simulation/equilibrium.h"
#include "vmech/dynamics/simulation/integrator.h"
#include "vmech/dynamics/simulation/motions_without_inertia.h"
#include "vmech/dynamics/simulation/prepared_simulation.h"
#include "vmech/dynamics/simulation/recorder.h"
#include "vmech/dynamics/simulation/rough_places.h"
#include "vmech/dynamics/simulation/run_audit.h"
#include "vmech/dynamics/simulation/start_state.h"
#include "vmech/dynamics/simulation/sudden_events.h"
#include "vmech/dynamics/simulation/tolerances.h"
#include "vmech/kinematics/loops/loops.h"

namespace vmech {
namespace {

using Clock = std::chrono::steady_clock;

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
        events_(
            simulation_, &equations_, [this](double time) { return StateAt(time); },
            &result->events),
        audit_(options, &equations_),
        stiffness_(prepared.simulation),
        y_(VectorXd::Zero(equations_.size())),
        dense_(y_) {
    problem_.size = equations_.size();
    problem_.evaluate = [this](double t, const double* y, const double*, double* slopes) {
      return equations_.Slopes(t, y, slopes);
    };
    problem_.relative_tolerance = options.relative_tolerance;
    problem_.absolute_tolerances = AbsoluteTolerances(prepared, options.absolute_tolerance);
    problem_.max_step = options.max_step;
    // Within a step one turn of a freedom is seen (SuddenEvents), not two.
    constexpr double kLooks = 200;
    if (problem_.max_step == 0 && !equations_.contacts().empty()) {
      problem_.max_step = (end() - simulation_.times.front()) / kLooks;
    }
  }

  void Go() {
    const Clock::time_point start = Clock::now();
    FindStart();
    statistics_.method = options_.method == SimulationMethod::kAutomatic ? SimulationMethod::kAdams
                                                                         : options_.method;
    if (statistics_.method == SimulationMethod::kIdas) PoseIndexTwo();
    integrator_ = MakeIntegrator(problem_, statistics_.method);
    Restart();
    RecordUntil(time_);
    TellOfStanding();
    while (GoesOn()) TakeStep();
    if (result_.times.empty() || result_.times.back() < time_) RecordHere();
    CountUp();
    statistics_.seconds = std::chrono::duration<double>(Clock::now() - start).count();
    recorder_.Finish();
  }

 private:
  double start() const { return simulation_.times.front(); }
  double end() const { return simulation_.times.back(); }

  /// Within the last step.
  const double* StateAt(double time) {
    if (leap_) {
      leap_->At(time, &leapt_);
      dense_.head(leapt_.size()) = leapt_;
    } else {
      integrator_->At(time, dense_.data());
    }
    return dense_.data();
  }

  void FindStart() {
    time_ = start();
    audit_.BeginAt(time_);
    stiffness_.BeginAt(time_);
    const StartState start = FindStartState(prepared_, &equations_);
    result_.moved_rates = start.moved_rates;
    if (!start.note.empty()) result_.notes.push_back(start.note);
    const KinematicTree& tree = equations_.tree();
    y_.head(tree.nq) = start.q;
    y_.segment(tree.nq, tree.nv) = start.v;
    events_.Start(time_, &y_);
    events_.LookAround(time_, y_);
    audit_.Begin();
  }

  /// What stands still for want of inertia, or of an answer to a force.
  void TellOfStanding() {
    StopIfUnresisted();
    if (result_.status != SimulationStatus::kNotRun) return;
    for (std::string& note : DescribeStanding(equations_.tree(), equations_.motion())) {
      result_.notes.push_back(std::move(note));
    }
  }

  /// The problem for IDAS. Its unknowns begin with those of the other methods.
  void PoseIndexTwo() {
    constexpr double kFirstStep = 1e-5, kDoesNotCount = 1e30;
    index_two_ = std::make_unique<IndexTwo>(prepared_, &equations_);
    problem_.size = index_two_->size();
    problem_.evaluate = [this](double t, const double* y, const double* slopes, double* F) {
      return index_two_->Residual(t, y, slopes, F);
    };
    problem_.absolute_tolerances.resize(static_cast<size_t>(problem_.size), kDoesNotCount);
    problem_.differential = index_two_->Differential();
    problem_.first_step = kFirstStep * (end() - time_);
    dense_ = VectorXd::Zero(problem_.size);
  }

  void Restart(double step = 0) {
    if (index_two_) index_two_->Start(time_, &y_, &slopes_);
    integrator_->Restart(time_, y_.data(), slopes_.data(), step);
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
    const std::string creeping = audit_.DescribeCreeping(integrator_->counts().steps, time_, end());
    return creeping.empty() || Stop(SimulationStatus::kFailed, DescribeFailure(creeping));
  }

  bool Stop(SimulationStatus status, const std::string& why) {
    result_.status = status;
    result_.message = fmt::format("{} at t = {:.6g} s", why, time_);
    return false;
  }

  /// Fails for a reason, if there is one and the run has not ended before.
  void StopFor(const std::string& why) {
    if (result_.status != SimulationStatus::kNotRun || why.empty()) return;
    Stop(SimulationStatus::kFailed, why);
  }

  void TakeStep() {
    if (integrator_->Step(end())) {
      const double to = integrator_->time();
      IsTrusted(to) ? GoThrough(to) : TakeShorterStep(to - time_);
    } else {
      const std::string why = integrator_->error();
      if (!TryAgain()) Stop(SimulationStatus::kFailed, DescribeFailure(why));
    }
  }

  bool IsTrusted(double to) {
    return !audit_.IsDoubtful(to - time_) ||
           audit_.Holds(time_, to, y_, LargestDrift(options_, equations_.tree(), y_),
                        [this](double time) { return StateAt(time); });
  }

  /// The last step again, which has led astray.
  void TakeShorterStep(double step) {
    constexpr double kShorter = 0.1, kShortest = 1e-15;  // of the run
    ++statistics_.error_test_failures;
    if (step < kShortest * (end() - start())) {
      Stop(SimulationStatus::kFailed, DescribeFailure("steps do not keep loops and energy"));
    } else {
      equations_.Place(time_, y_.data(), y_.data() + equations_.tree().nq);
      Restart(kShorter * step);
    }
  }

  /// Through the last step, to its end at `to` or to what happens before.
  void GoThrough(double to) {
    const double from = time_;
    const SuddenEvents::Found found = events_.FindFirst(from, std::min(to, end()));
    time_ = found.time;
    StateAt(time_);
    y_ = dense_;
    if (found.ends_run)
      Stop(SimulationStatus::kReached, "a coordinate that ends the run is reached");
    StopIfUnresisted();
    RecordUntil(time_);
    const bool leapt = leap_.has_value();
    bool near_singular = false;
    leap_.reset();
    if (found.changes) {
      equations_.Close(time_, y_.data());
      events_.Pass(time_, &y_);
      Restart();
      StopFor(audit_.DescribeChatter(time_, simulation_, result_.events));
    } else if (leapt) {
      BringBack();
    } else {
      ReturnToLoops();
      near_singular = NearSingularPose(equations_, time_ - from);
      if (!near_singular) tried_pivot_ = 0;
      if (!near_singular) ChangeMethodIfStiff();
    }
    events_.LookAround(time_, y_);
    audit_.Begin();
    if (near_singular && time_ < end() && result_.status == SimulationStatus::kNotRun) {
      LeapIfElsewhere();
    }
  }

  std::string DescribeFailure(const std::string& why) {
    return fmt::format(
        "the mechanism cannot be followed on ({}): {}; the run ends", why,
        DescribePlace(time_, y_.head(equations_.size()), simulation_.units, &equations_));
  }

  /// After a step that has failed: over a singular pose, or with equations chosen anew.
  bool TryAgain() {
    if (Leap()) return true;
    if (failed_at_ == time_ || !index_two_) return false;
    failed_at_ = time_;
    BringBack();
    return true;
  }

  /// Where there was no leap there is none until the pose is nearer, or another one.
  void LeapIfElsewhere() {
    constexpr double kElsewhere = 1.1;
    const double pivot = equations_.motion().smallest_pivot();
    if (pivot < kElsewhere * tried_pivot_ && tried_pivot_ < kElsewhere * pivot) return;
    tried_pivot_ = pivot;
    Leap();
  }

  bool Leap() {
    equations_.Close(time_, y_.data());
    leap_ = LeapOverSingularPose(time_, y_.head(equations_.size()), &equations_);
    if (!leap_) return false;
    const double to = leap_->from + leap_->step;
    if (!audit_.KeepsEnergy(time_, y_.data(), to, StateAt(to))) {
      leap_.reset();
      return false;
    }
    GoThrough(to);
    return true;
  }

  /// Onto the loops, and on from there.
  void BringBack() {
    equations_.Close(time_, y_.data());
    const KinematicTree& tree = equations_.tree();
    equations_.Place(time_, y_.data(), y_.data() + tree.nq);
    y_.segment(tree.nq, tree.nv) = equations_.motion().ws().v;
    ++statistics_.projections;
    Restart();
  }

  /// Results that are due by then.
  void RecordUntil(double time) {
    while (next_ < simulation_.times.size() && simulation_.times[next_] <= time) {
      const double at = simulation_.times[next_++];
      if (at == time_) {
        dense_ = y_;
      } else {
        StateAt(at);
      }
      recorder_.Record(at, dense_.data());
      StopFor(audit_.DescribeImbalance(result_.energies.back(),
                                       statistics_.steps + integrator_->counts().steps));
    }
  }

  /// A force along a motion without inertia has no answer.
  void StopIfUnresisted() {
    if (result_.status != SimulationStatus::kNotRun) return;
    if (index_two_) equations_.Evaluate(time_, y_.data(), y_.data() + equations_.tree().nq);
    StopFor(DescribeUnresisted(equations_.tree(), equations_.motion()));
  }

  void RecordHere() {
    dense_ = y_;
    recorder_.Record(time_, dense_.data());
  }

  /// Brings the state back on its loops where it has left them. What an integrator evaluates last
  /// is the end of its step but for less than its tolerance, or a pose beside it for a slope: where
  /// that is well on the loops, so is the end.
  void ReturnToLoops() {
    constexpr double kWell = 0.5, kFarFromSingular = 1e-3;
    const KinematicTree& tree = equations_.tree();
    if (tree.loops.empty() && tree.nq == tree.nv) return;
    const bool is_well =
        equations_.motion().closure() <= kWell * LargestDrift(options_, equations_.tree(), y_) &&
        equations_.motion().smallest_pivot() > kFarFromSingular;
    if (is_well) {
      equations_.GoOnFromHere();
    } else {
      equations_.Place(time_, y_.data(), y_.data() + tree.nq);
    }
    const double drift = equations_.motion().closure();
    statistics_.largest_drift = std::max(statistics_.largest_drift, drift);
    statistics_.largest_rate_drift =
        std::max(statistics_.largest_rate_drift, equations_.RateDrift(y_.data() + tree.nq));
    if (equations_.ChoosesBadly()) equations_.ChooseFreedoms(y_.head(tree.nq));
    const bool worn = index_two_ && index_two_->ChoosesBadly(time_, y_.data());
    if (drift <= LargestDrift(options_, equations_.tree(), y_) && !worn) return;
    BringBack();
  }

  /// Adams takes steps that are short for what decays fastest, though it has long decayed: BDF does
  /// not.
  void ChangeMethodIfStiff() {
    if (options_.method != SimulationMethod::kAutomatic) return;
    if (statistics_.method != SimulationMethod::kAdams) return;
    if (!stiffness_.Limits(integrator_->counts().steps, time_, y_, &equations_)) return;
    CountUp();
    statistics_.method = SimulationMethod::kBdf;
    result_.events.push_back({time_, SimulationEvent::Kind::kMethodChanged, {}, 0, 0});
    integrator_ = MakeIntegrator(problem_, statistics_.method);
    audit_.BeginAt(time_);
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
  SuddenEvents events_;
  RunAudit audit_;
  StiffnessWatch stiffness_;
  InitialValueProblem problem_;
  std::unique_ptr<Integrator> integrator_;
  double time_ = 0;
  std::unique_ptr<IndexTwo> index_two_;
  VectorXd y_, dense_, slopes_, leapt_;
  std::optional<vmech::Leap> leap_;  ///< the last step was one
  size_t next_ = 0;                  ///< of the times
  double tried_pivot_ = 0;           ///< where no leap was found, near a singular pose
  double failed_at_ = -1;            ///< when a step failed last [s]
};

}  // namespace

SimulationResult Simulate(const Simulation& simulation, const SimulationOptions& options) {
  options.Validate();
  const PreparedSimulation prepared = PrepareSimulation(AtItsStart(simulation));
  SimulationResult result;
  result.tree = prepared.model.tree;
  result.notes = prepared.notes;
  Run(prepared, options, &result).Go();
  return result;
}

}  // namespace vmech
