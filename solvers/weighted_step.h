#pragma once

#include "vmech/solvers/normal_equations.h"
#include "vmech/solvers/null_motions.h"
#include "vmech/solvers/optimality.h"

namespace vmech {

/// The step that `penalty` and `augmented_lagrangian` share: Gauss-Newton on
///
///     phi(x) = 1/2 |r|^2 + mu' c + lambda^2/2 |c|^2
///
/// that is, paper eq. (8) with the loop error shifted by mu / lambda^2,
///
///     [ J        ]        [ r                        ]
///     [ lambda C ] dx = - [ lambda (c + mu/lambda^2) ]
///
/// solved by its normal equations, with Marquardt damping relative to the diagonal of H (the
/// largest so far in one minimisation, as in MINPACK), and with coordinates held that press
/// against a bound. Steps that neither residuals nor constraints see are left out (null_motions.h);
/// the first step looks for them, later ones if there ever were any. All memory is taken by
/// the constructor; nothing else here allocates or throws.
class WeightedStep {
 public:
  explicit WeightedStep(const ConstrainedLeastSquares& problem);  ///< of its sizes

  /// Evaluates the problem at x, then H and g. False if anything is not finite.
  [[nodiscard]] bool Linearize(ConstrainedLeastSquares& problem, const VectorXd& x, double lambda,
                               const VectorXd& mu) noexcept;

  /// H and g of at_x as it stands, which is the problem at x.
  [[nodiscard]] bool FormEquations(ConstrainedLeastSquares& problem, const VectorXd& x,
                                   double lambda, const VectorXd& mu) noexcept;

  /// dx from H and g, clipped to the bounds and to max |dx_i| <= max_step. False if H + damping is
  /// not positive definite.
  [[nodiscard]] bool Compute(const ConstrainedLeastSquares& problem, const VectorXd& x,
                             double damping, double max_step) noexcept;

  // Chord steps go from another x, near by, with the derivatives and the factors of the last
  // Compute(); r and c of at_x become those there. False if dx is not finite.
  /// dx of r and c there, clipped.
  [[nodiscard]] bool ComputeChord(ConstrainedLeastSquares& problem, const VectorXd& x,
                                  double lambda, const VectorXd& mu, double max_step) noexcept;
  /// The step to C dx = -c that changes r least, clipped.
  [[nodiscard]] bool ComputeClosure(const ConstrainedLeastSquares& problem, const VectorXd& x,
                                    double lambda, const VectorXd& c, double max_step) noexcept;

  /// c + C dx: the constraint error that the linear model expects after the step.
  const VectorXd& PredictConstraints() noexcept;

  /// Largest |r_i + J_i dx|: the residual that the linear model expects after the step.
  double LargestResidualAhead() const noexcept;

  /// Forgets the scale of the damping that Compute() has gathered.
  void ForgetScale() noexcept { scale_.setZero(); }

  /// How a descent ended.
  struct Descent {
    bool ok = false;          ///< false: values that are not finite, or no step that descends
    bool stationary = false;  ///< the gradient is below the tolerance
    int iterations = 0;       ///< steps
  };
  /// Levenberg-Marquardt on phi from *x until the largest entry of its gradient (held coordinates
  /// left out) is below tolerance * max(1, |J'r|), no step descends, or max_iterations are spent.
  [[nodiscard]] Descent Minimize(ConstrainedLeastSquares& problem, double lambda,
                                 const VectorXd& mu, double damping, double max_step,
                                 double tolerance, int max_iterations, VectorXd* x) noexcept;

  Linearization at_x;          ///< of the last Linearize(); r and c where Minimize() has ended
  VectorXd dx;                 ///< the step
  bool use_curvature = false;  ///< H + S, S the problem's Curvature() at mu + lambda^2 c

 private:
  static double Phi(const VectorXd& r, const VectorXd& c, double lambda,
                    const VectorXd& mu) noexcept;
  double GradientError() const noexcept;
  double TryStep(ConstrainedLeastSquares& problem, double lambda, const VectorXd& mu,
                 double max_step, VectorXd* x) noexcept;
  bool ContractsAtTrial(double lambda, const VectorXd& mu) noexcept;
  void FindChordStep(double lambda, const VectorXd& mu) noexcept;
  bool FinishWithoutDerivatives(ConstrainedLeastSquares& problem, double lambda, const VectorXd& mu,
                                double last_length, VectorXd* x) noexcept;
  void MoveAlong(const VectorXd& step, Linearization* at) const noexcept;
  bool MoveToTrial(ConstrainedLeastSquares& problem, double lambda, const VectorXd& mu,
                   VectorXd* x) noexcept;
  bool WithinNoise() const noexcept { return promised_ <= noise_; }
  double PromisedDecrease() const noexcept;
  void CorrectForCurvature(const ConstrainedLeastSquares& problem, const VectorXd& x, double lambda,
                           double max_step) noexcept;
  void AddCurvature(ConstrainedLeastSquares& problem, const VectorXd& x) noexcept;
  void HoldAtBounds(const ConstrainedLeastSquares& problem, const VectorXd& x) noexcept;
  void Clip(const ConstrainedLeastSquares& problem, const VectorXd& x, double max_step) noexcept;

  NormalEquations equations_;
  NullMotions null_;
  bool first_look_ = true, some_null_ = false;  // null motions have been found once
  Linearization at_trial_;
  VectorXd trial_x_;
  VectorXd scale_;  // largest diagonal of H so far: a column that fades keeps its damping (MINPACK)
  VectorXd damping_, c_model_, chord_dx_;
  VectorXd forces_;  // mu + lambda^2 c, what the constraints pull with
  MatrixXd S_;
  bool clipped_ = false;             // Clip() has changed dx
  double promised_ = 0, noise_ = 0;  // decrease of phi: by the model, and lost in rounding
};

}  // namespace vmech
