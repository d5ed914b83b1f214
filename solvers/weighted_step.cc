#include "vmech/solvers/weighted_step.h"

#include <algorithm>
#include <cmath>

#include "vmech/base/linear_algebra/small_ldlt.h"

namespace vmech {
namespace {

constexpr double kMaxDamping = 1e12;
constexpr double kFirstDamping = 1e-6;  // after the first refusal
constexpr double kDampingGrowth = 4;
constexpr double kSufficient = 1e-4;  // part of the promised decrease that accepts a step
constexpr int kMaxCorrections = 2;
constexpr double kNegligibleStep = 1e-13;  // [unit of the tangent]
// A step is taken, whatever becomes of phi, if the next one is expected to be shorter by this.
constexpr double kContraction = 0.25;
constexpr double kScaleFloor = 1e-9;  // of the damping of a column that nothing depends on
// A step this much shorter than the one before may be the last that needs derivatives.
constexpr double kFast = 0.05;
// Changes of phi smaller than this (relative) are rounding and do not refuse a step.
constexpr double kRounding = 1e-13;

double MaxAbs(const VectorXd& v) noexcept {
  double largest = 0;
  for (double v_i : v) largest = std::max(largest, std::abs(v_i));
  return largest;
}

bool WithinBounds(const ConstrainedLeastSquares& problem, const VectorXd& x) noexcept {
  return std::ranges::all_of(problem.bounds(), [&](const Bound& bound) {
    return x[bound.coordinate] >= bound.lower && x[bound.coordinate] <= bound.upper;
  });
}

}  // namespace

WeightedStep::WeightedStep(const ConstrainedLeastSquares& problem)
    : at_x(problem.sizes()),
      equations_(problem.sizes().tangents),
      null_(problem.sizes().tangents),
      at_trial_(problem.sizes()) {
  const ProblemSizes& sizes = problem.sizes();
  dx = chord_dx_ = scale_ = damping_ = VectorXd::Zero(sizes.tangents);
  S_ = MatrixXd::Zero(sizes.tangents, sizes.tangents);
  c_model_ = forces_ = VectorXd::Zero(sizes.constraints);
  trial_x_ = VectorXd::Zero(sizes.coordinates);
}

bool WeightedStep::Linearize(ConstrainedLeastSquares& problem, const VectorXd& x, double lambda,
                             const VectorXd& mu) noexcept {
  at_x.Evaluate(problem, x);
  return FormEquations(problem, x, lambda, mu);
}

bool WeightedStep::FormEquations(ConstrainedLeastSquares& problem, const VectorXd& x, double lambda,
                                 const VectorXd& mu) noexcept {
  const double weight = lambda * lambda;
  for (int i = 0; i < forces_.size(); ++i) forces_[i] = mu[i] + weight * at_x.c[i];
  equations_.Form(at_x, weight, forces_);
  HoldAtBounds(problem, x);
  if (first_look_ || some_null_) null_.Find(at_x, equations_.held);
  some_null_ |= null_.count() > 0;
  first_look_ = false;
  if (use_curvature || null_.count() > 0) AddCurvature(problem, x);
  double sum = 0;
  for (int j = 0; j < equations_.size(); ++j) sum += std::abs(equations_.g[j]) + equations_.H(j, j);
  return std::isfinite(sum);
}

void WeightedStep::AddCurvature(ConstrainedLeastSquares& problem, const VectorXd& x) noexcept {
  if (use_curvature)
    problem.Curvature(x, forces_, &S_);
  else
    S_.setZero();
  if (null_.count() > 0) null_.Stiffen(equations_.H.trace() / equations_.size(), &S_);
  equations_.H += S_;
}

void WeightedStep::HoldAtBounds(const ConstrainedLeastSquares& problem,
                                const VectorXd& x) noexcept {
  equations_.held.setConstant(false);
  for (const Bound& bound : problem.bounds()) {
    const double value = x[bound.coordinate], slope = equations_.g[bound.tangent];
    equations_.held[bound.tangent] |= (value <= bound.lower && slope > 0) ||
                                      bound.lower == bound.upper ||
                                      (value >= bound.upper && slope < 0);
  }
}

bool WeightedStep::Compute(const ConstrainedLeastSquares& problem, const VectorXd& x,
                           double damping, double max_step) noexcept {
  const int n = equations_.size();
  double largest = 1e-30;
  for (int j = 0; j < n; ++j) {
    scale_[j] = std::max(scale_[j], std::abs(equations_.H(j, j)));
    largest = std::max(largest, scale_[j]);
  }
  for (int j = 0; j < n; ++j) damping_[j] = damping * (scale_[j] + kScaleFloor * largest);
  if (!equations_.Factor(damping_)) return false;
  for (int j = 0; j < n; ++j) dx[j] = -equations_.g[j];
  equations_.Solve(&dx);
  Clip(problem, x, max_step);
  return std::isfinite(dx.sum());
}

bool WeightedStep::ComputeChord(ConstrainedLeastSquares& problem, const VectorXd& x, double lambda,
                                const VectorXd& mu, double max_step) noexcept {
  problem.Evaluate(x, &at_trial_.r, nullptr, &at_trial_.c, nullptr);
  FindChordStep(lambda, mu);
  dx.swap(chord_dx_);
  at_x.r.swap(at_trial_.r);
  at_x.c.swap(at_trial_.c);
  Clip(problem, x, max_step);
  return std::isfinite(dx.sum());
}

// Multipliers for the step alone: c + C dx shrinks from one solve to the next.
bool WeightedStep::ComputeClosure(const ConstrainedLeastSquares& problem, const VectorXd& x,
                                  double lambda, const VectorXd& c, double max_step) noexcept {
  constexpr int kSolves = 2;
  const int closures = static_cast<int>(c.size()), n = equations_.size();
  std::copy_n(c.data(), closures, at_x.c.data());
  std::copy_n(c.data(), closures, c_model_.data());
  std::fill_n(dx.data(), n, 0.0);
  for (int solve = 0; solve < kSolves; ++solve) {
    const double* C_j = at_x.C.data();
    for (int j = 0; j < n; ++j, C_j += closures) {
      chord_dx_[j] = -lambda * lambda * Dot(C_j, c_model_.data(), closures);
    }
    equations_.Solve(&chord_dx_);
    for (int j = 0; j < n; ++j) dx[j] += chord_dx_[j];
    if (solve + 1 < kSolves) PredictConstraints();
  }
  Clip(problem, x, max_step);
  return std::isfinite(dx.sum());
}

const VectorXd& WeightedStep::PredictConstraints() noexcept {
  const int closures = static_cast<int>(at_x.c.size());
  const double* C_j = at_x.C.data();
  double* const c_model = c_model_.data();
  for (int i = 0; i < closures; ++i) c_model[i] = at_x.c[i];
  for (double dx_j : dx) {
    for (int i = 0; i < closures; ++i) c_model[i] += C_j[i] * dx_j;
    C_j += closures;
  }
  return c_model_;
}

double WeightedStep::LargestResidualAhead() const noexcept {
  const Eigen::Index rows = at_x.r.size();
  double largest = 0;
  for (Eigen::Index i = 0; i < rows; ++i) {
    double r_i = at_x.r[i];
    for (Eigen::Index j = 0; j < dx.size(); ++j) r_i += at_x.J.data()[j * rows + i] * dx[j];
    largest = std::max(largest, std::abs(r_i));
  }
  return largest;
}

void WeightedStep::Clip(const ConstrainedLeastSquares& problem, const VectorXd& x,
                        double max_step) noexcept {
  const double largest = MaxAbs(dx);
  clipped_ = largest > max_step;
  if (clipped_) dx *= max_step / largest;
  for (const Bound& bound : problem.bounds()) {
    const double value = x[bound.coordinate], wanted = dx[bound.tangent];
    dx[bound.tangent] =
        std::clamp(wanted, std::min(bound.lower - value, 0.0), std::max(bound.upper - value, 0.0));
    clipped_ |= dx[bound.tangent] != wanted;
  }
}

WeightedStep::Descent WeightedStep::Minimize(ConstrainedLeastSquares& problem, double lambda,
                                             const VectorXd& mu, double damping, double max_step,
                                             double tolerance, int max_iterations,
                                             VectorXd* x) noexcept {
  Descent descent;
  if (!Linearize(problem, *x, lambda, mu)) return descent;
  ForgetScale();
  const double least_damping = damping;
  double growth = kDampingGrowth, last_length = 0;
  while (!(descent.stationary = GradientError() <= tolerance)) {
    if (descent.iterations == max_iterations) break;
    double gain = -1;
    if (Compute(problem, *x, damping, max_step)) {
      const double length = MaxAbs(dx);
      const bool full = damping == least_damping && !clipped_;
      if (full && length <= kNegligibleStep) {
        descent.stationary = true;  // what is left of the gradient is rounding, times lambda^2
        break;
      }
      if (full && FinishWithoutDerivatives(problem, lambda, mu, last_length, x)) {
        ++descent.iterations;
        descent.stationary = true;
        break;
      }
      gain = TryStep(problem, lambda, mu, max_step, x);
      if (gain >= 0) last_length = length;
    }
    ++descent.iterations;
    // Damping follows the gain of the step (Nielsen 1999).
    if (gain >= 0) {
      const double surplus = 2 * gain - 1;
      damping *= std::max(0.1, 1 - surplus * surplus * surplus);
      damping = std::max(damping, least_damping);
      growth = kDampingGrowth;
    } else if ((damping = std::max(growth * damping, kFirstDamping)) > kMaxDamping) {
      descent.ok = descent.stationary = WithinNoise();  // as low as rounding lets it get
      return descent;
    } else {
      growth *= 2;
    }
  }
  descent.ok = true;
  return descent;
}

// 1/2 |r|^2 + (mu + lambda^2/2 c)'c, in plain loops: the vectors are short.
double WeightedStep::Phi(const VectorXd& r, const VectorXd& c, double lambda,
                         const VectorXd& mu) noexcept {
  const double half_weight = 0.5 * lambda * lambda;
  double half_squares = 0, penalty = 0;
  for (double r_i : r) half_squares += 0.5 * r_i * r_i;
  for (int i = 0; i < c.size(); ++i) penalty += (mu[i] + half_weight * c[i]) * c[i];
  return half_squares + penalty;
}

double WeightedStep::GradientError() const noexcept {
  double error = 0, scale = 1;
  for (int j = 0; j < equations_.size(); ++j) {
    if (!equations_.held[j]) error = std::max(error, std::abs(equations_.g[j]));
    scale = std::max(scale, std::abs(equations_.objective_gradient[j]));
  }
  return error / scale;
}

// Moves *x by dx and linearises there if phi falls enough, if need be after second-order
// corrections; returns the part of the promised decrease that came true, or -1 and stays. Where
// rounding hides the decrease, the gradient has to fall instead.
double WeightedStep::TryStep(ConstrainedLeastSquares& problem, double lambda, const VectorXd& mu,
                             double max_step, VectorXd* x) noexcept {
  const double phi = Phi(at_x.r, at_x.c, lambda, mu);
  const double error = GradientError();
  promised_ = PromisedDecrease();
  noise_ = kRounding * std::abs(phi);
  for (int correction = 0;; ++correction) {
    problem.Plus(*x, dx, &trial_x_);
    at_trial_.Evaluate(problem, trial_x_);  // with derivatives: most steps are taken
    const double decrease = phi - Phi(at_trial_.r, at_trial_.c, lambda, mu);
    if (decrease >= kSufficient * promised_ - noise_) {
      const bool finite = MoveToTrial(problem, lambda, mu, x);
      if (finite && !WithinNoise()) return std::clamp(decrease / promised_, 0.0, 1.0);
      if (finite && GradientError() < error) return 1;
      static_cast<void>(MoveToTrial(problem, lambda, mu, x));  // back
      return -1;
    }
    if (correction == 0 && ContractsAtTrial(lambda, mu)) {
      if (MoveToTrial(problem, lambda, mu, x)) return 1;
      static_cast<void>(MoveToTrial(problem, lambda, mu, x));  // back
      return -1;
    }
    if (correction == kMaxCorrections || !at_trial_.c.allFinite()) return -1;
    CorrectForCurvature(problem, *x, lambda, max_step);
  }
}

// The natural monotonicity test: -H^-1 g with H of here and g of the trial point is about the step
// that will follow. Where lambda is large, steps of Gauss-Newton raise phi by their curvature times
// lambda^2 while they converge quadratically. [Deuflhard, Newton Methods for Nonlinear
// Problems, 3.3]
bool WeightedStep::ContractsAtTrial(double lambda, const VectorXd& mu) noexcept {
  FindChordStep(lambda, mu);
  return MaxAbs(chord_dx_) < kContraction * MaxAbs(dx);
}

void WeightedStep::FindChordStep(double lambda, const VectorXd& mu) noexcept {
  const double weight = lambda * lambda;
  const VectorXd &r = at_trial_.r, &c = at_trial_.c;
  const double *J_j = at_x.J.data(), *C_j = at_x.C.data();
  for (int j = 0; j < equations_.size(); ++j, J_j += r.size(), C_j += c.size()) {
    double g_j = 0;
    for (int i = 0; i < r.size(); ++i) g_j += J_j[i] * r[i];
    for (int i = 0; i < c.size(); ++i) g_j += C_j[i] * (mu[i] + weight * c[i]);
    chord_dx_[j] = -g_j;
  }
  equations_.Solve(&chord_dx_);
}

// After a step so much shorter than the one before that even linear convergence leaves a negligible
// one, x is stationary. The same holds for the chord step that follows, as long as nothing pulls:
// J and C change by about `length` on the way, and the gradient by that times the pull. The linear
// model tells r and c after such a step.
bool WeightedStep::FinishWithoutDerivatives(ConstrainedLeastSquares& problem, double lambda,
                                            const VectorXd& mu, double last_length,
                                            VectorXd* x) noexcept {
  const double length = MaxAbs(dx);
  if (length * length <= kNegligibleStep * last_length) {
    problem.Plus(*x, dx, x);
    MoveAlong(dx, &at_x);
    return true;
  }
  if (length > kFast * last_length || length * MaxAbs(mu) > kNegligibleStep) return false;
  problem.Plus(*x, dx, &trial_x_);
  problem.Evaluate(trial_x_, &at_trial_.r, nullptr, &at_trial_.c, nullptr);
  if (!std::isfinite(at_trial_.r.sum() + at_trial_.c.sum())) return false;  // MaxAbs sees no NaN
  if (length * MaxAbs(at_trial_.r) > kNegligibleStep) return false;
  FindChordStep(lambda, mu);
  const double chord = MaxAbs(chord_dx_);
  if (chord * chord > kNegligibleStep * length) return false;
  problem.Plus(trial_x_, chord_dx_, &trial_x_);
  if (!WithinBounds(problem, trial_x_)) return false;
  std::swap_ranges(x->begin(), x->end(), trial_x_.begin());
  MoveAlong(chord_dx_, &at_trial_);
  at_x.r.swap(at_trial_.r);
  at_x.c.swap(at_trial_.c);
  return true;
}

// r += J step, c += C step, with J and C of at_x.
void WeightedStep::MoveAlong(const VectorXd& step, Linearization* at) const noexcept {
  const double *J_j = at_x.J.data(), *C_j = at_x.C.data();
  for (double step_j : step) {
    for (double& r_i : at->r) r_i += *J_j++ * step_j;
    for (double& c_i : at->c) c_i += *C_j++ * step_j;
  }
}

// Exchanges *x and the trial point, and what is known of them.
bool WeightedStep::MoveToTrial(ConstrainedLeastSquares& problem, double lambda, const VectorXd& mu,
                               VectorXd* x) noexcept {
  std::swap_ranges(x->begin(), x->end(), trial_x_.begin());
  at_x.Swap(&at_trial_);
  return FormEquations(problem, *x, lambda, mu);
}

// -(g'dx + dx'H dx / 2), from the lower triangle of H.
double WeightedStep::PromisedDecrease() const noexcept {
  const MatrixXd& H = equations_.H;
  double decrease = 0;
  for (int j = 0; j < equations_.size(); ++j) {
    double slope = equations_.g[j] + 0.5 * H(j, j) * dx[j];
    for (int i = j + 1; i < equations_.size(); ++i) slope += H(i, j) * dx[i];
    decrease -= slope * dx[j];
  }
  return std::max(decrease, std::numeric_limits<double>::min());
}

// The step that would have closed the constraints had the model known their curvature: dx again,
// with the error of the model, c(x + dx) - (c + C dx), added to c. It keeps long steps along a
// curved constraint, which a large lambda would otherwise refuse.
void WeightedStep::CorrectForCurvature(const ConstrainedLeastSquares& problem, const VectorXd& x,
                                       double lambda, double max_step) noexcept {
  forces_ = lambda * lambda * (at_trial_.c - PredictConstraints());
  for (Eigen::Index j = 0; j < dx.size(); ++j) {
    dx[j] = -equations_.g[j] - at_x.C.col(j).dot(forces_);
  }
  equations_.Solve(&dx);
  Clip(problem, x, max_step);
}

}  // namespace vmech
