#include "vmech/solvers/optimality.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "vmech/base/linear_algebra/small_ldlt.h"

namespace vmech {
namespace {

// A bound nearer than this (relative to 1 or to its own size) may carry a multiplier; what it then
// carries times the distance left counts as an error.
constexpr double kNearBound = 1e-6;
constexpr double kRankTolerance = 1e-9;
constexpr double kFlat = 1e-6;  // curvature, relative to the Hessian's, that counts as none

double Reach(double value) {
  return kNearBound * std::max(1.0, std::abs(value));
}

bool IsNear(const Bound& bound, double value) {
  return bound.upper - value <= Reach(value) || value - bound.lower <= Reach(value);
}

double MaxAbs(const VectorXd& v) noexcept {
  double largest = 0;
  for (double v_i : v) largest = std::max(largest, std::abs(v_i));
  return largest;
}

double Norm(const Eigen::Ref<const MatrixXd>& A) noexcept {
  const int size = static_cast<int>(A.size());
  return std::sqrt(Dot(A.data(), A.data(), size));
}

// y += C'mu
void MultiplyTransposedAdd(const MatrixXd& C, const double* mu, double* y) noexcept {
  const int m = static_cast<int>(C.rows());
  for (int j = 0; j < C.cols(); ++j) y[j] += Dot(C.data() + j * m, mu, m);
}

// Rows that are redundant where c = 0 are so elsewhere only up to the order of c: a pivot below |c|
// says nothing.
double RankTolerance(const Linearization& at_x, double rank_tolerance) {
  const double scale = Norm(at_x.C);
  if (scale == 0) return rank_tolerance;
  constexpr double kCoarsest = 0.01;
  return std::clamp(Norm(at_x.c) / scale, rank_tolerance, std::max(kCoarsest, rank_tolerance));
}

double BoundViolation(const std::vector<Bound>& bounds, const VectorXd& x) {
  double worst = 0;
  for (const Bound& bound : bounds) {
    worst = std::max({worst, bound.lower - x[bound.coordinate], x[bound.coordinate] - bound.upper});
  }
  return worst;
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

void OptimalityMeter::FindNearBounds(const std::vector<Bound>& bounds, const VectorXd& x) {
  near_.clear();
  for (int k = 0; k < static_cast<int>(bounds.size()); ++k) {
    const Bound& bound = bounds[k];
    const double value = x[bound.coordinate], reach = Reach(value);
    const double to_lower = value - bound.lower, to_upper = bound.upper - value;
    if (to_upper <= reach) near_.push_back({k, bound.tangent, 1, std::abs(to_upper), false, 0});
    if (to_lower <= reach) near_.push_back({k, bound.tangent, -1, std::abs(to_lower), false, 0});
  }
}

// min |g + C'mu + sum_k sign_k y_k e_k| over mu and y >= 0: the non-negative least squares of
// Lawson and Hanson (1974, chapter 23), with mu eliminated from every sub-problem as free.
void OptimalityMeter::FindMultipliers(const Linearization& at_x, double rank_tolerance) {
  const MatrixXd& C = at_x.C;
  const double tolerance = RankTolerance(at_x, rank_tolerance);
  factors_.Prepare(static_cast<int>(C.rows()), static_cast<int>(C.cols())) = C.transpose();
  factors_.Factor(rank_tolerance);
  factors_.SetRank(tolerance);
  factors_.SolveTransposed(negative_.data(), result_.multipliers.data());
  residual_ = gradient_;
  MultiplyTransposedAdd(C, result_.multipliers.data(), residual_.data());
  for (size_t round = 0; round < 3 * near_.size() && UseSteepest(); ++round) {
    SolveWithUsed(C, tolerance);
    // Bounds that would pull are let go one by one, the worst first.
    for (NearBound* worst = WorstPulling(); worst != nullptr; worst = WorstPulling()) {
      worst->used = false;
      worst->force = 0;
      SolveWithUsed(C, tolerance);
    }
  }
}

// Lets the bound carry a force that would reduce the residual most; false if there is none.
bool OptimalityMeter::UseSteepest() {
  double steepest = 1e-14 * std::max(1.0, MaxAbs(gradient_));
  NearBound* best = nullptr;
  for (NearBound& bound : near_) {
    const double slope = -bound.sign * residual_[bound.tangent];
    if (!bound.used && slope > steepest) best = &bound, steepest = slope;
  }
  if (best != nullptr) best->used = true;
  return best != nullptr;
}

// Least squares over mu and the forces of the bounds in use; sets them and the residual.
void OptimalityMeter::SolveWithUsed(const MatrixXd& C, double rank_tolerance) {
  const int m = static_cast<int>(C.rows()), n = static_cast<int>(C.cols());
  int rows = m;
  for (const NearBound& bound : near_) rows += bound.used;
  auto transposed = factors_with_bounds_.Prepare(rows, n);
  transposed.leftCols(m) = C.transpose();
  transposed.rightCols(rows - m).setZero();
  int row = m;
  for (const NearBound& bound : near_) {
    if (bound.used) transposed(bound.tangent, row++) = bound.sign;
  }
  factors_with_bounds_.Factor(rank_tolerance);
  solution_.resize(rows);
  factors_with_bounds_.SolveTransposed(negative_.data(), solution_.data());
  std::copy_n(solution_.begin(), m, result_.multipliers.data());
  residual_ = gradient_;
  MultiplyTransposedAdd(C, solution_.data(), residual_.data());
  row = m;
  for (NearBound& bound : near_) {
    if (!bound.used) continue;
    bound.force = solution_[row++];
    residual_[bound.tangent] += bound.sign * bound.force;
  }
}

OptimalityMeter::NearBound* OptimalityMeter::WorstPulling() {
  NearBound* worst = nullptr;
  for (NearBound& bound : near_) {
    if (bound.used && bound.force < (worst != nullptr ? worst->force : 0)) worst = &bound;
  }
  return worst;
}

double OptimalityMeter::InfeasibilitySlope(const Linearization& at_x) {
  const double error = Norm(at_x.c);
  if (error == 0) return 1;
  // Where C vanishes too, linear equations close c by steps of more than one unit only.
  const double scale = error * std::max(Norm(at_x.C), error);
  residual_.setZero();
  MultiplyTransposedAdd(at_x.C, at_x.c.data(), residual_.data());
  for (const NearBound& bound : near_) {
    if (bound.sign * residual_[bound.tangent] < 0) residual_[bound.tangent] = 0;  // held by it
  }
  return Norm(residual_) / scale;
}

const Optimality& OptimalityMeter::Measure(const std::vector<Bound>& bounds, const VectorXd& x,
                                           const Linearization& at_x, double rank_tolerance) {
  const int rows = static_cast<int>(at_x.r.size()), n = static_cast<int>(at_x.J.cols());
  result_.objective = 0.5 * Dot(at_x.r.data(), at_x.r.data(), rows);
  result_.constraint_norm = MaxAbs(at_x.c);
  result_.bound_violation = BoundViolation(bounds, x);

  FindNearBounds(bounds, x);
  gradient_.resize(n), residual_.resize(n), negative_.resize(n);
  MultiplyTransposed(at_x.J.data(), rows, n, at_x.r.data(), gradient_.data());
  for (int i = 0; i < n; ++i) negative_[i] = -gradient_[i];
  result_.multipliers.resize(at_x.c.size());
  FindMultipliers(at_x, rank_tolerance);
  result_.bound_multipliers.setZero(static_cast<int>(bounds.size()));
  double error = MaxAbs(residual_);
  for (const NearBound& bound : near_) {
    result_.bound_multipliers[bound.index] += bound.sign * bound.force;
    error = std::max(error, bound.force * bound.distance);
  }
  result_.kkt_error = error / std::max(1.0, MaxAbs(gradient_));
  result_.infeasibility_slope = InfeasibilitySlope(at_x);
  return result_;
}

Optimality MeasureOptimality(const std::vector<Bound>& bounds, const VectorXd& x,
                             const Linearization& at_x, double rank_tolerance) {
  return OptimalityMeter().Measure(bounds, x, at_x, rank_tolerance);
}

bool CurvesUpwards(ConstrainedLeastSquares& problem, const VectorXd& x, const Linearization& at_x,
                   const VectorXd& multipliers) {
  if (!problem.has_second_derivatives()) return true;
  const Eigen::Index m = at_x.C.rows(), n = at_x.C.cols();
  std::vector<int> held;
  for (const Bound& bound : problem.bounds()) {
    if (IsNear(bound, x[bound.coordinate])) held.push_back(bound.tangent);
  }
  MatrixXd rows = MatrixXd::Zero(m + static_cast<Eigen::Index>(held.size()), n);
  rows.topRows(m) = at_x.C;
  for (size_t k = 0; k < held.size(); ++k) rows(m + k, held[k]) = 1;
  const CompleteOrthogonal factors(rows, kRankTolerance);
  const auto Z = factors.Z();
  MatrixXd hessian = MatrixXd::Zero(n, n);
  problem.Curvature(x, multipliers, &hessian);
  hessian += at_x.J.transpose() * at_x.J;
  MatrixXd reduced = Z.transpose() * hessian * Z;
  reduced.diagonal().array() += kFlat * hessian.norm() + std::numeric_limits<double>::min();
  return Eigen::LLT<MatrixXd>(reduced).info() == Eigen::Success;
}

}  // namespace vmech
