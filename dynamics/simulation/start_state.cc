#include "vmech/dynamics/simulation/start_state.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

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

std::vector<MovedRate> FindMoved(const PreparedSimulation& prepared,
                                 const LoadWorkspace<double>& ws) {
  constexpr double kMoved = 1e-9;
  std::vector<MovedRate> moved;
  for (const StartRate& given : prepared.simulation.start_rates) {
    const double rate = ws.loads[given.at.joint].rate[given.at.freedom];
    const double unit =
        IsShift(prepared.model.tree.mechanism, given.at) ? prepared.model.tree.length : 1;
    if (std::abs(rate - given.rate) <= kMoved * std::max(unit, std::abs(given.rate))) continue;
    moved.push_back({given.at, given.rate, rate});
  }
  return moved;
}

}  // namespace

StartState FindStartState(const PreparedSimulation& prepared, EquationsOfMotion* equations) {
  const KinematicTree& tree = prepared.model.tree;
  const double time = prepared.simulation.times.front();
  StartState start{prepared.q, VectorXd::Zero(tree.nv), {}};
  equations->Close(time, start.q.data());
  ConstrainedMotion& motion = equations->motion();
  if (!prepared.simulation.start_rates.empty() && motion.freedoms() > 0) {
    const GivenRates given = FindGivenRates(prepared, &motion, start.q);
    start.v = motion.N() * LeastEnergy(motion.inertia(), given);
  }
  equations->Place(time, start.q.data(), start.v.data());
  start.v = motion.ws().v;
  start.moved_rates = FindMoved(prepared, motion.ws());
  return start;
}

}  // namespace vmech
