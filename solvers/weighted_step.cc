#include "vmech/solvers/weighted_step.h"

#include <algorithm>
#include <cmath>

namespace vmech {
namespace {

constexpr double kMaxDamping = 1e12;
constexpr double kFirstDamping = 1e-6;  // after the first refusal
constexpr double kDampingGrowth = 4;
constexpr double kSufficient = 1e-4;  // part of the promised decrease that accepts a step
constexpr int kMaxCorrections = 2;
// Changes of phi smaller than this (relative) are rounding and do not refuse a step.
constexpr double kRounding = 1e-13;

}  // namespace

WeightedStep::WeightedStep(const ConstrainedLeastSquares& problem) : at_x(problem.sizes()) {
  const ProblemSizes& sizes = problem.sizes();
  dx = g_ = scale_ = objective_gradient_ = VectorXd::Zero(sizes.tangents);
  H_ = factor_ = S_ = MatrixXd::Zero(sizes.tangents, sizes.tangents);
  c_model = shifted_ = trial_c_ = VectorXd::Zero(sizes.constraints);
  trial_r_ = VectorXd::Zero(sizes.residuals);
  trial_x_ = saved_x_ = VectorXd::Zero(sizes.coordinates);
  held_.setConstant(sizes.tangents, false);
}

bool WeightedStep::Linearize(ConstrainedLeastSquares& problem, const VectorXd& x, double lambda,
                             const VectorXd& mu) noexcept {
  at_x.Evaluate(problem, x);
  const double weight = lambda * lambda;
  const Eigen::Index n = g_.size();
  // g = J'r + C'(mu + lambda^2 c),   H = J'J + lambda^2 C'C (lower triangle)
  shifted_ = mu + weight * at_x.c;
  for (Eigen::Index j = 0; j < n; ++j) {
    objective_gradient_[j] = at_x.J.col(j).dot(at_x.r);
    g_[j] = objective_gradient_[j] + at_x.C.col(j).dot(shifted_);
    for (Eigen::Index i = j; i < n; ++i) {
      H_(i, j) = at_x.J.col(i).dot(at_x.J.col(j)) + weight * at_x.C.col(i).dot(at_x.C.col(j));
    }
  }
  if (use_curvature) {
    problem.Curvature(x, shifted_, &S_);
    H_ += S_;
  }
  HoldAtBounds(problem, x);
  return g_.allFinite() && std::isfinite(H_.diagonal().sum());
}

void WeightedStep::HoldAtBounds(const ConstrainedLeastSquares& problem,
                                const VectorXd& x) noexcept {
  held_.setConstant(false);
  for (const Bound& bound : problem.bounds()) {
    const double value = x[bound.coordinate], slope = g_[bound.tangent];
    held_[bound.tangent] |= (value <= bound.lower && slope > 0) || bound.lower == bound.upper ||
                            (value >= bound.upper && slope < 0);
  }
}

bool WeightedStep::Compute(const ConstrainedLeastSquares& problem, const VectorXd& x,
                           double damping, double max_step) noexcept {
  scale_ = scale_.cwiseMax(H_.diagonal().cwiseAbs());
  if (!Factorize(damping)) return false;
  for (Eigen::Index j = 0; j < dx.size(); ++j) dx[j] = held_[j] ? 0.0 : -g_[j];
  BackSubstitute();
  Clip(problem, x, max_step);
  c_model = at_x.c;
  for (Eigen::Index j = 0; j < dx.size(); ++j) c_model += dx[j] * at_x.C.col(j);
  return dx.allFinite();
}

// H + damping diag(scale) = L D L', unit L below the diagonal of factor_, 1/D on it.
bool WeightedStep::Factorize(double damping) noexcept {
  const Eigen::Index n = g_.size();
  const double floor = 1e-9 * std::max(scale_.maxCoeff(), 1e-30);
  for (Eigen::Index j = 0; j < n; ++j) {
    for (Eigen::Index i = j; i < n; ++i) {
      factor_(i, j) = held_[i] || held_[j] ? double(i == j) : H_(i, j);
    }
    if (!held_[j]) factor_(j, j) += damping * (scale_[j] + floor);
  }
  for (Eigen::Index j = 0; j < n; ++j) {
    const double pivot = factor_(j, j);
    if (!(pivot > 0)) return false;
    const double inverse = 1 / pivot;
    for (Eigen::Index k = j + 1; k < n; ++k) {
      const double scaled = factor_(k, j) * inverse;
      for (Eigen::Index i = k; i < n; ++i) factor_(i, k) -= scaled * factor_(i, j);
    }
    for (Eigen::Index i = j + 1; i < n; ++i) factor_(i, j) *= inverse;
    factor_(j, j) = inverse;
  }
  return true;
}

void WeightedStep::BackSubstitute() noexcept {
  const Eigen::Index n = g_.size();
  for (Eigen::Index j = 0; j < n; ++j) {
    for (Eigen::Index i = j + 1; i < n; ++i) dx[i] -= factor_(i, j) * dx[j];
  }
  for (Eigen::Index j = n - 1; j >= 0; --j) {
    dx[j] *= factor_(j, j);
    for (Eigen::Index i = j + 1; i < n; ++i) dx[j] -= factor_(i, j) * dx[i];
  }
}

void WeightedStep::Clip(const ConstrainedLeastSquares& problem, const VectorXd& x,
                        double max_step) noexcept {
  const double largest = dx.cwiseAbs().maxCoeff();
  if (largest > max_step) dx *= max_step / largest;
  for (const Bound& bound : problem.bounds()) {
    const double value = x[bound.coordinate];
    dx[bound.tangent] = std::clamp(dx[bound.tangent], std::min(bound.lower - value, 0.0),
                                   std::max(bound.upper - value, 0.0));
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
  double growth = kDampingGrowth;
  while (!(descent.stationary = GradientError() <= tolerance)) {
    if (descent.iterations == max_iterations) break;
    ++descent.iterations;
    double gain = -1;
    if (Compute(problem, *x, damping, max_step)) {
      gain = TryStep(problem, lambda, mu, max_step, x);
    }
    // Damping follows the gain of the step (Nielsen 1999).
    if (gain >= 0) {
      damping = std::max(damping * std::max(0.1, 1 - std::pow(2 * gain - 1, 3)), least_damping);
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

double WeightedStep::Phi(const VectorXd& r, const VectorXd& c, double lambda,
                         const VectorXd& mu) noexcept {
  return 0.5 * r.squaredNorm() + mu.dot(c) + 0.5 * lambda * lambda * c.squaredNorm();
}

double WeightedStep::GradientError() const noexcept {
  double error = 0;
  for (Eigen::Index i = 0; i < g_.size(); ++i) {
    if (!held_[i]) error = std::max(error, std::abs(g_[i]));
  }
  return error / std::max(1.0, objective_gradient_.cwiseAbs().maxCoeff());
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
    problem.Evaluate(trial_x_, &trial_r_, nullptr, &trial_c_, nullptr);
    const double decrease = phi - Phi(trial_r_, trial_c_, lambda, mu);
    if (decrease >= kSufficient * promised_ - noise_) {
      saved_x_ = *x;
      *x = trial_x_;
      const bool finite = Linearize(problem, *x, lambda, mu);
      if (finite && !WithinNoise()) return std::clamp(decrease / promised_, 0.0, 1.0);
      if (finite && GradientError() < error) return 1;
      *x = saved_x_;
      static_cast<void>(Linearize(problem, *x, lambda, mu));
      return -1;
    }
    if (correction == kMaxCorrections || !trial_c_.allFinite()) return -1;
    CorrectForCurvature(problem, *x, lambda, max_step);
  }
}

// -(g'dx + dx'H dx / 2), from the lower triangle of H.
double WeightedStep::PromisedDecrease() const noexcept {
  double decrease = -g_.dot(dx);
  for (Eigen::Index j = 0; j < dx.size(); ++j) {
    decrease -= 0.5 * H_(j, j) * dx[j] * dx[j];
    for (Eigen::Index i = j + 1; i < dx.size(); ++i) decrease -= H_(i, j) * dx[i] * dx[j];
  }
  return std::max(decrease, std::numeric_limits<double>::min());
}

// The step that would have closed the constraints had the model known their curvature: dx again,
// with the error of the model, c(x + dx) - (c + C dx), added to c. It keeps long steps along a
// curved constraint, which a large lambda would otherwise refuse.
void WeightedStep::CorrectForCurvature(const ConstrainedLeastSquares& problem, const VectorXd& x,
                                       double lambda, double max_step) noexcept {
  trial_c_ -= at_x.c;
  for (Eigen::Index j = 0; j < dx.size(); ++j) trial_c_ -= dx[j] * at_x.C.col(j);
  for (Eigen::Index j = 0; j < dx.size(); ++j) {
    dx[j] = held_[j] ? 0.0 : -g_[j] - lambda * lambda * at_x.C.col(j).dot(trial_c_);
  }
  BackSubstitute();
  Clip(problem, x, max_step);
}

void WeightedStep::UpdateMultipliers(double lambda, VectorXd* mu) noexcept {
  *mu += lambda * lambda * c_model;
}

}  // namespace vmech
