#include "vmech/solvers/optimality.h"

#include <algorithm>
#include <cmath>

#include "vmech/base/linear_algebra/complete_orthogonal.h"

namespace vmech {
namespace {

// A bound nearer than this (relative to 1 or to its own size) may carry a multiplier; what it then
// carries times the distance left counts as an error.
constexpr double kNearBound = 1e-6;
constexpr double kRankTolerance = 1e-9;
constexpr double kFlat = 1e-6;  // curvature, relative to the Hessian's, that counts as none

struct ActiveBound {
  int index;  // in the problem's list
  int tangent;
  double sign;      // +1 at the upper bound, -1 at the lower
  double distance;  // to the bound
};

std::vector<ActiveBound> NearBounds(const std::vector<Bound>& bounds, const VectorXd& x) {
  std::vector<ActiveBound> near;
  for (int k = 0; k < static_cast<int>(bounds.size()); ++k) {
    const Bound& bound = bounds[k];
    const double value = x[bound.coordinate];
    const double reach = kNearBound * std::max(1.0, std::abs(value));
    const double to_lower = value - bound.lower, to_upper = bound.upper - value;
    if (to_upper <= reach) near.push_back({k, bound.tangent, 1, std::abs(to_upper)});
    if (to_lower <= reach) near.push_back({k, bound.tangent, -1, std::abs(to_lower)});
  }
  return near;
}

// min |g + C'mu + sum_k sign_k y_k e_k| over mu and y >= 0: the non-negative least squares of
// Lawson and Hanson (1974, chapter 23), with mu eliminated from every sub-problem as free.
class SignedMultipliers {
 public:
  SignedMultipliers(const VectorXd& g, const MatrixXd& C, const std::vector<ActiveBound>& active,
                    double rank_tolerance)
      : g_(g),
        C_(C),
        active_(active),
        rank_tolerance_(rank_tolerance),
        used_(active.size(), false),
        y(VectorXd::Zero(static_cast<int>(active.size()))) {
    SolveWithUsed();
    for (size_t round = 0; round < 3 * active.size(); ++round) {
      const int next = SteepestUnused();
      if (next < 0) break;
      used_[next] = true;
      y = Clipped(SolveWithUsed());
    }
  }

 private:
  // The unused bound whose force would reduce the residual most, or -1.
  int SteepestUnused() const {
    const double threshold = 1e-14 * std::max(1.0, g_.cwiseAbs().maxCoeff());
    int best = -1;
    double best_slope = threshold;
    for (int k = 0; k < static_cast<int>(active_.size()); ++k) {
      const double slope = -active_[k].sign * residual[active_[k].tangent];
      if (!used_[k] && slope > best_slope) best = k, best_slope = slope;
    }
    return best;
  }

  // Bounds that would pull are let go one by one, the worst first.
  VectorXd Clipped(VectorXd trial) {
    int worst = 0;
    while (trial.size() > 0 && trial.minCoeff(&worst) < 0) {
      used_[worst] = false;
      trial = SolveWithUsed();
    }
    return trial;
  }

  // Least squares over mu and the used y; sets mu and residual, returns y.
  VectorXd SolveWithUsed() {
    const int m = static_cast<int>(C_.rows());
    std::vector<int> columns;
    for (int k = 0; k < static_cast<int>(active_.size()); ++k) {
      if (used_[k]) columns.push_back(k);
    }
    MatrixXd A(m + columns.size(), C_.cols());  // transposed: a row per unknown
    A.topRows(m) = C_;
    A.bottomRows(columns.size()).setZero();
    for (size_t i = 0; i < columns.size(); ++i) {
      A(m + i, active_[columns[i]].tangent) = active_[columns[i]].sign;
    }
    const VectorXd solution = CompleteOrthogonal(A, rank_tolerance_).SolveTransposed(-g_);
    residual = g_ + A.transpose() * solution;
    mu = solution.head(m);
    VectorXd trial = VectorXd::Zero(y.size());
    for (size_t i = 0; i < columns.size(); ++i) trial[columns[i]] = solution[m + i];
    return trial;
  }

  const VectorXd& g_;
  const MatrixXd& C_;
  const std::vector<ActiveBound>& active_;
  double rank_tolerance_;
  std::vector<bool> used_;

 public:
  VectorXd mu, y, residual;
};

// Rows that are redundant where c = 0 are so elsewhere only up to the order of c: a pivot below |c|
// says nothing.
double RankTolerance(const Linearization& at_x, double rank_tolerance) {
  const double scale = at_x.C.norm();
  if (scale == 0) return rank_tolerance;
  constexpr double kCoarsest = 0.01;
  return std::clamp(at_x.c.norm() / scale, rank_tolerance, std::max(kCoarsest, rank_tolerance));
}

double BoundViolation(const std::vector<Bound>& bounds, const VectorXd& x) {
  double worst = 0;
  for (const Bound& bound : bounds) {
    worst = std::max({worst, bound.lower - x[bound.coordinate], x[bound.coordinate] - bound.upper});
  }
  return worst;
}

double InfeasibilitySlope(const Linearization& at_x, const std::vector<ActiveBound>& active) {
  const double error = at_x.c.norm();
  if (error == 0) return 1;
  // Where C vanishes too, linear equations close c by steps of more than one unit only.
  const double scale = error * std::max(at_x.C.norm(), error);
  VectorXd slope = at_x.C.transpose() * at_x.c;
  for (const ActiveBound& bound : active) {
    if (bound.sign * slope[bound.tangent] < 0) slope[bound.tangent] = 0;  // held by the bound
  }
  return slope.norm() / scale;
}

}  // namespace

Linearization::Linearization(const ProblemSizes& sizes)
    : r(VectorXd::Zero(sizes.residuals)),
      c(VectorXd::Zero(sizes.constraints)),
      J(MatrixXd::Zero(sizes.residuals, sizes.tangents)),
      C(MatrixXd::Zero(sizes.constraints, sizes.tangents)) {}

void Linearization::Evaluate(ConstrainedLeastSquares& problem, const VectorXd& x) {
  problem.Evaluate(x, &r, &J, &c, &C);
}

bool Linearization::AllFinite() const {
  return r.allFinite() && c.allFinite() && J.allFinite() && C.allFinite();
}

void Linearization::Swap(Linearization* other) noexcept {
  r.swap(other->r);
  c.swap(other->c);
  J.swap(other->J);
  C.swap(other->C);
}

Optimality MeasureOptimality(const std::vector<Bound>& bounds, const VectorXd& x,
                             const Linearization& at_x, double rank_tolerance) {
  Optimality result;
  result.objective = 0.5 * at_x.r.squaredNorm();
  result.constraint_norm = at_x.c.lpNorm<Eigen::Infinity>();
  result.bound_violation = BoundViolation(bounds, x);

  const std::vector<ActiveBound> active = NearBounds(bounds, x);
  const VectorXd gradient = at_x.J.transpose() * at_x.r;
  const SignedMultipliers best(gradient, at_x.C, active, RankTolerance(at_x, rank_tolerance));
  result.multipliers = best.mu;
  result.bound_multipliers = VectorXd::Zero(static_cast<int>(bounds.size()));
  double error = best.residual.lpNorm<Eigen::Infinity>();
  for (size_t k = 0; k < active.size(); ++k) {
    result.bound_multipliers[active[k].index] += active[k].sign * best.y[k];
    error = std::max(error, best.y[k] * active[k].distance);
  }
  result.kkt_error = error / std::max(1.0, gradient.lpNorm<Eigen::Infinity>());
  result.infeasibility_slope = InfeasibilitySlope(at_x, active);
  return result;
}

bool CurvesUpwards(ConstrainedLeastSquares& problem, const VectorXd& x, const Linearization& at_x,
                   const VectorXd& multipliers) {
  if (!problem.has_second_derivatives()) return true;
  const std::vector<ActiveBound> active = NearBounds(problem.bounds(), x);
  const Eigen::Index m = at_x.C.rows(), n = at_x.C.cols();
  MatrixXd rows = MatrixXd::Zero(m + static_cast<Eigen::Index>(active.size()), n);
  rows.topRows(m) = at_x.C;
  for (size_t k = 0; k < active.size(); ++k) rows(m + k, active[k].tangent) = 1;
  const MatrixXd Z = CompleteOrthogonal(rows, kRankTolerance).Z;
  MatrixXd hessian = MatrixXd::Zero(n, n);
  problem.Curvature(x, multipliers, &hessian);
  hessian += at_x.J.transpose() * at_x.J;
  MatrixXd reduced = Z.transpose() * hessian * Z;
  reduced.diagonal().array() += kFlat * hessian.norm() + std::numeric_limits<double>::min();
  return Eigen::LLT<MatrixXd>(reduced).info() == Eigen::Success;
}

}  // namespace vmech
