#include "vmech/solvers/packages/tangent_chart.h"

#include <algorithm>
#include <cmath>

#include "vmech/base/linear_algebra/complete_orthogonal.h"

namespace vmech {
namespace {

constexpr double kRankTolerance = 1e-7;
constexpr double kChartRadius = 2;   // [rad]; the exponential map folds at pi
constexpr double kNeighbour = 0.02;  // distance of the poses over which rank is judged
constexpr int kMaxCharts = 20;
constexpr double kNoMotion = 1e-14;

// A point near x where c = 0, as far as damped Gauss-Newton steps get there.
VectorXd ClosedNear(CountedProblem& problem, VectorXd x, Linearization* at_x) {
  constexpr int kMaxSteps = 20;
  constexpr double kClosed = 1e-11;
  at_x->Evaluate(problem, x);
  for (int i = 0; i < kMaxSteps && at_x->AllFinite() && at_x->c.norm() > kClosed; ++i) {
    const double damping = 0.01 * std::min(at_x->c.squaredNorm(), at_x->C.squaredNorm());
    CompleteOrthogonal factors(at_x->C, kRankTolerance);
    factors.SetDamping(damping);
    const VectorXd step = factors.Solve(-at_x->c);
    problem.Plus(x, step, &x);
    at_x->Evaluate(problem, x);
  }
  return x;
}

// The range of C, of the largest rank among closed poses about the base; the rows as they are where
// none is redundant.
MatrixXd RangeOfConstraints(CountedProblem& problem, const VectorXd& base) {
  Linearization at_x(problem.sizes());
  const VectorXd closed = ClosedNear(problem, base, &at_x);
  if (!at_x.AllFinite()) return MatrixXd::Identity(at_x.c.size(), at_x.c.size());
  CompleteOrthogonal best(at_x.C, kRankTolerance);
  for (int k = 1; k <= 2; ++k) {
    VectorXd aside(problem.sizes().tangents);
    for (int i = 0; i < aside.size(); ++i) aside[i] = kNeighbour * std::sin(1.0 + k + 2.3 * i);
    VectorXd neighbour(closed.size());
    problem.Plus(closed, aside, &neighbour);
    ClosedNear(problem, neighbour, &at_x);
    if (!at_x.AllFinite() || at_x.c.norm() > kRankTolerance) continue;
    CompleteOrthogonal other(at_x.C, kRankTolerance);
    if (other.rank() > best.rank()) best = std::move(other);
  }
  const Eigen::Index m = at_x.c.size();
  return best.rank() == m ? MatrixXd::Identity(m, m) : MatrixXd(best.V());
}

bool Met(CountedProblem& problem, const StoppingRule& rule, const VectorXd& x) {
  Linearization at_x(problem.sizes());
  at_x.Evaluate(problem, x);
  if (!at_x.AllFinite()) return false;
  const Optimality now = MeasureOptimality(problem.bounds(), x, at_x);
  return now.constraint_norm <= rule.constraint_tolerance &&
         now.bound_violation <= rule.constraint_tolerance &&
         now.kkt_error <= rule.optimality_tolerance;
}

}  // namespace

TangentChart::TangentChart(CountedProblem& problem, const VectorXd& base)
    : problem_(problem),
      base_(base),
      V_(RangeOfConstraints(problem, base)),
      at_x_(problem.sizes()),
      at_y_(problem.sizes()) {
  const ProblemSizes& sizes = problem.sizes();
  const bool flat = sizes.coordinates == sizes.tangents;
  const double reach = flat ? std::numeric_limits<double>::infinity() : kChartRadius;
  lower = VectorXd::Constant(sizes.tangents, -reach);
  upper = VectorXd::Constant(sizes.tangents, reach);
  for (const Bound& bound : problem.bounds()) {
    lower[bound.tangent] = bound.lower - base[bound.coordinate];
    upper[bound.tangent] = bound.upper - base[bound.coordinate];
  }
}

VectorXd TangentChart::Point(const VectorXd& y) const {
  VectorXd x(base_.size());
  problem_.Plus(base_, y, &x);
  return x;
}

const Linearization& TangentChart::At(const VectorXd& y) {
  if (y_.size() == y.size() && y_ == y) return at_y_;
  y_ = y;
  x_ = Point(y);
  at_x_.Evaluate(problem_, x_);
  T_ = PlusDerivative(y);
  at_y_.r = at_x_.r;
  at_y_.J = at_x_.J * T_;
  at_y_.c = V_.transpose() * at_x_.c;
  at_y_.C = V_.transpose() * at_x_.C * T_;
  return at_y_;
}

MatrixXd TangentChart::Hessian(double sigma, const VectorXd& mu) {
  MatrixXd H = at_y_.J.transpose() * at_y_.J;
  if (problem_.has_second_derivatives()) {
    MatrixXd S = MatrixXd::Zero(H.rows(), H.cols());
    problem_.Curvature(x_, V_ * mu / sigma, &S);
    H += T_.transpose() * S * T_;
  }
  return sigma * H;
}

// T with Plus(base, y + dy) = Plus(Plus(base, y), T dy): by central differences on both sides,
// which is good enough, since a solve ends at y = 0 where T = 1.
MatrixXd TangentChart::PlusDerivative(const VectorXd& y) const {
  const Eigen::Index n = y.size();
  if (base_.size() == n || y.isZero(0)) return MatrixXd::Identity(n, n);
  constexpr double kStep = 1e-5;
  MatrixXd from_base(base_.size(), n), from_here(base_.size(), n);
  VectorXd plus(base_.size()), minus(base_.size());
  const VectorXd here = Point(y);
  for (Eigen::Index i = 0; i < n; ++i) {
    const VectorXd h = kStep * VectorXd::Unit(n, i);
    from_base.col(i) = (Point(y + h) - Point(y - h)) / (2 * kStep);
    problem_.Plus(here, h, &plus);
    problem_.Plus(here, -h, &minus);
    from_here.col(i) = (plus - minus) / (2 * kStep);
  }
  CompleteOrthogonal factors(from_here, kRankTolerance);
  MatrixXd T(n, n);
  for (Eigen::Index i = 0; i < n; ++i) T.col(i) = factors.Solve(from_base.col(i));
  return T;
}

Outcome SolveInCharts(CountedProblem& problem, const StoppingRule& rule, VectorXd* x,
                      const ChartSolve& solve) {
  Outcome total{SolveStatus::kStalled, "no further progress"};
  for (int round = 0; round < kMaxCharts; ++round) {
    if (Met(problem, rule, *x)) {
      total.claim = SolveStatus::kConverged;
      return total;
    }
    if (total.iterations >= rule.max_iterations) {
      total.claim = SolveStatus::kIterationLimit;
      return total;
    }
    TangentChart chart(problem, *x);
    VectorXd y = VectorXd::Zero(chart.num_variables());
    const Outcome outcome = solve(chart, rule.max_iterations - total.iterations, &y);
    total.iterations += outcome.iterations;
    total.claim = outcome.claim;
    total.message = outcome.message;
    if (!y.allFinite() || y.cwiseAbs().maxCoeff() <= kNoMotion) return total;
    *x = chart.Point(y);
  }
  return total;
}

}  // namespace vmech
