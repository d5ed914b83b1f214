#include "vmech/dynamics/simulation/start_state.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "vmech/base/linear_algebra/linear_algebra.h"
#include "vmech/mechanisms/freedoms.h"

namespace vmech {
namespace {

/// What the given rates are as s moves, and what they are to be.
struct GivenRates {
  MatrixXd B;  ///< [rates, freedoms]
  VectorXd rates;
};

bool IsShift(const Mechanism& mechanism, const FreedomId& at) {
  return !FreedomsOfType(mechanism.joints[at.joint].type).rotates[at.freedom];
}

GivenRates FindGivenRates(const PreparedSimulation& prepared, ConstrainedMotion* motion,
                          const VectorXd& q) {
  const KinematicTree& tree = prepared.model.tree;
  const std::vector<StartRate>& given = prepared.simulation.start_rates;
  std::vector<RateRow> rows;
  for (const StartRate& rate : given) rows.push_back(RateRowOf(tree, rate.at));
  const std::vector<RateRow> held = motion->held();
  motion->Hold(rows);
  motion->SetPose(q.data());
  GivenRates result{motion->held_motions(), VectorXd(given.size())};
  for (size_t i = 0; i < given.size(); ++i) {
    const double unit = IsShift(tree.mechanism, given[i].at) ? 1 / tree.length : 1;
    result.rates[static_cast<Eigen::Index>(i)] = unit * given[i].rate;
    result.B.row(static_cast<Eigen::Index>(i)) *= unit;
  }
  motion->Hold(held);
  motion->SetPose(q.data());
  return result;
}

/// s with the least s'A s of those that fit B s = rates best.
VectorXd LeastEnergy(const MatrixXd& inertia, const GivenRates& given) {
  constexpr double kRank = 1e-9, kNoInertia = 1e-12;
  MatrixXd A = inertia;
  A.diagonal().array() += kNoInertia * std::max(A.diagonal().maxCoeff(), 1e-300);
  const Eigen::LLT<MatrixXd> factors(A);
  // x = L's: |x|^2 is twice the energy.
  const MatrixXd along = factors.matrixL().solve(given.B.transpose()).transpose();
  const double size = along.lpNorm<Eigen::Infinity>();
  if (size == 0) return VectorXd::Zero(A.rows());
  const VectorXd x = MinimumNormSolution(along / size, given.rates / size, kRank);
  return factors.matrixU().solve(x);
}

std::string RateInWords(const PreparedSimulation& prepared, const FreedomId& at, double rate) {
  const DisplayUnits& units = prepared.simulation.units;
  const bool shift = IsShift(prepared.model.tree.mechanism, at);
  return fmt::format("{:.6g} {}/s", rate / (shift ? units.metres : units.radians),
                     shift ? units.length : units.angle);
}

std::string Describe(const PreparedSimulation& prepared, const std::vector<MovedRate>& moved) {
  std::string text;
  for (const MovedRate& rate : moved) {
    const Joint& joint = prepared.model.tree.mechanism.joints[rate.at.joint];
    text += fmt::format("{}'{}' is given {} and has {}", text.empty() ? "" : ", ",
                        NameOfFreedom(joint, rate.at.freedom),
                        RateInWords(prepared, rate.at, rate.from),
                        RateInWords(prepared, rate.at, rate.to));
  }
  return text;
}

/// As rounded figures do; what is moved by more contradicts the others, drives or the loops.
void FindMoved(const PreparedSimulation& prepared, const LoadWorkspace<double>& ws,
               StartState* start) {
  constexpr double kMoved = 1e-9, kRounded = 1e-3;
  double largest = 0, furthest = 0;
  for (const StartRate& given : prepared.simulation.start_rates) {
    const double rate = ws.loads[given.at.joint].rate[given.at.freedom];
    const double unit =
        IsShift(prepared.model.tree.mechanism, given.at) ? prepared.model.tree.length : 1;
    largest = std::max(largest, std::abs(given.rate) / unit);
    if (std::abs(rate - given.rate) <= kMoved * std::max(unit, std::abs(given.rate))) continue;
    furthest = std::max(furthest, std::abs(rate - given.rate) / unit);
    start->moved_rates.push_back({given.at, given.rate, rate});
  }
  if (start->moved_rates.empty()) return;
  const std::string text = Describe(prepared, start->moved_rates);
  if (furthest > kRounded * largest) {
    throw std::invalid_argument(
        "the rates at the start contradict each other, the drives or the loops: in the nearest "
        "motion " +
        text + "; give rates that fit together, or fewer of them");
  }
  start->note = "to fit together the rates at the start are moved: " + text;
}

}  // namespace

StartState FindStartState(const PreparedSimulation& prepared, EquationsOfMotion* equations) {
  const KinematicTree& tree = prepared.model.tree;
  const double time = prepared.simulation.times.front();
  StartState start{prepared.q, VectorXd::Zero(tree.nv), {}, {}};
  equations->Close(time, start.q.data());
  ConstrainedMotion& motion = equations->motion();
  if (!prepared.simulation.start_rates.empty() && motion.freedoms() > 0) {
    const GivenRates given = FindGivenRates(prepared, &motion, start.q);
    start.v = motion.N() * LeastEnergy(motion.inertia(), given);
  }
  equations->Place(time, start.q.data(), start.v.data());
  start.v = motion.ws().v;
  FindMoved(prepared, motion.ws(), &start);
  return start;
}

}  // namespace vmech
