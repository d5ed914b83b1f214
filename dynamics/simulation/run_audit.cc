#include "vmech/dynamics/simulation/run_audit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "vmech/kinematics/loops/dimensionless_loops.h"

namespace vmech {

RunAudit::RunAudit(const SimulationOptions& options, EquationsOfMotion* equations)
    : options_(options),
      equations_(*equations),
      unit_(VelocityScale(equations->tree())),
      weighed_(VectorXd::Constant(equations->size(), std::numeric_limits<double>::quiet_NaN())) {}

void RunAudit::Begin() {
  pivot_ = equations_.motion().smallest_pivot();
  // Of forces: over a radian, or a characteristic length.
  const LoadWorkspace<double>& ws = equations_.motion().ws();
  const double size = unit_.dot(ws.tau.cwiseAbs() + ws.passive.cwiseAbs());
  largest_ = std::max({largest_, equations_.KineticEnergyHere(), size});
}

bool RunAudit::IsDoubtful(double step) const {
  constexpr double kReach = 2;
  if (equations_.tree().loops.empty()) return false;
  const ConstrainedMotion& motion = equations_.motion();
  const double moved = step * motion.ws().v.cwiseQuotient(unit_).lpNorm<Eigen::Infinity>();
  return std::min(pivot_, motion.smallest_pivot()) < kReach * kReach * moved * moved;
}

bool RunAudit::Holds(double from, double to, const VectorXd& start, double drift,
                     const std::function<const double*(double)>& state_at) {
  // Loops that miss each other by less are taken to meet (Leap).
  constexpr double kMeets = 1e-8, kDrifts = 10;
  constexpr int kPlaces = 4;
  for (int i = 1; i < kPlaces; ++i) {
    const double time = from + (to - from) * i / kPlaces;
    const double* const y = state_at(time);
    const double* const v = y + equations_.tree().nq;
    equations_.TakeState(time, y, v, v);
    if (!(equations_.motion().closure() <= std::max(kMeets, kDrifts * drift))) return false;
  }
  return KeepsEnergy(from, start.data(), to, state_at(to));
}

bool RunAudit::KeepsEnergy(double from, const double* start, double to, const double* end) {
  constexpr double kTolerances = 1e3, kRounding = 1e-8;
  const double share = std::max(kRounding, kTolerances * options_.relative_tolerance);
  const Energy before = EnergyAt(from, start), after = EnergyAt(to, end);
  const double lost = std::abs(after.balance - before.balance);
  return lost <= share * std::max(before.moving, after.moving);
}

/// A step most often begins with the state that ended the last one.
RunAudit::Energy RunAudit::EnergyAt(double time, const double* y) {
  const Eigen::Map<const VectorXd> state(y, weighed_.size());
  if (time == weighed_at_ && state == weighed_) return energy_;
  weighed_at_ = time;
  weighed_ = state;
  const double* const v = y + equations_.tree().nq;
  equations_.Place(time, y, v);
  const double* const exchanged = v + equations_.tree().nv;
  const double moving =
      equations_.KineticEnergyHere() + equations_.forces().SpringEnergy(equations_.motion());
  energy_ = {moving + equations_.WeightEnergyHere() - exchanged[0] + exchanged[1], moving};
  return energy_;
}

std::string RunAudit::DescribeImbalance(const EnergySample& sample, long steps) {
  // Some hundred tolerances a step; and beyond the other share nobody would call it an energy.
  constexpr double kPerStep = 100, kAtMost = 0.05, kAtLeast = 1e-6;
  if (!first_weight_) first_weight_ = sample.weight;
  const double fallen = std::abs(sample.weight - *first_weight_);
  largest_ = std::max({largest_, sample.kinetic, sample.springs, fallen});
  const double explained = std::clamp(
      kPerStep * options_.relative_tolerance * static_cast<double>(steps), kAtLeast, kAtMost);
  if (std::abs(sample.error) <= explained * largest_) return {};
  return fmt::format(
      "the balance of energy misses {:.3g} J of {:.3g} J, which the tolerance does not explain: "
      "what follows is not the mechanism's motion; ask for more accuracy (a smaller tolerance)",
      sample.error, largest_);
}

std::string RunAudit::DescribeCreeping(long steps, double time, double end) {
  constexpr long kLook = 1000, kLongLook = 100'000;
  constexpr double kTimes = 1000, kRounding = 1e-15;
  if (steps < stood_.steps + kLook) return {};
  const double passed = time - stood_.time;
  const bool stands = passed <= kRounding * static_cast<double>(kLook) * std::abs(time);
  stood_ = {steps, time};
  constexpr std::string_view kText = "the last {} steps led on by {:.3g} s";
  if (stands) return fmt::format(kText, kLook, passed);
  const long taken = steps - crept_.steps;
  if (taken < kLongLook) return {};
  const double crept = time - crept_.time;
  crept_ = {steps, time};
  const double reach = crept / static_cast<double>(taken) * static_cast<double>(options_.max_steps);
  return kTimes * reach >= end - time ? "" : fmt::format(kText, taken, crept);
}

std::string RunAudit::DescribeChatter(double time, const Simulation& simulation,
                                      const std::vector<SimulationEvent>& events) {
  constexpr long kMany = 2000;
  constexpr double kNoTime = 1e-6;  // of the run
  if (++changes_ % kMany != 0) return {};
  const double passed = time - changed_at_.value_or(simulation.times.front());
  changed_at_ = time;
  if (passed > kNoTime * (simulation.times.back() - simulation.times.front())) return {};
  const FreedomId at = events.empty() ? FreedomId{} : events.back().at;
  const std::vector<Joint>& joints = equations_.tree().mechanism.joints;
  const std::string_view drives =
      simulation.drives.empty()
          ? ""
          : "; a drive moves as prescribed whatever it takes: where it runs into a limit, end "
            "the run there (`watch` with `ends`), widen the limit, or take a motor";
  return fmt::format(
      "contacts stick, slip, open and close {} times within {:.3g} s, last that of "
      "'{}', and nothing else happens; give limits some restitution or none, or "
      "friction to fewer joints{}",
      kMany, passed, at.joint < 0 ? "a drive" : NameOfFreedom(joints[at.joint], at.freedom),
      drives);
}

}  // namespace vmech
