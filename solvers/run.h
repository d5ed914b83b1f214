#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "vmech/solvers/constrained_least_squares.h"
#include "vmech/solvers/stopping_rule.h"
#include "vmech/solvers/summary.h"

namespace vmech {

/// A problem that counts how often it is evaluated, and is otherwise the one given.
class CountedProblem final : public ConstrainedLeastSquares {
 public:
  /// Keeps a reference.
  explicit CountedProblem(ConstrainedLeastSquares& problem)
      : ConstrainedLeastSquares(problem.sizes(), problem.bounds()), problem_(problem) {}

  void Evaluate(const VectorXd& x, VectorXd* r, MatrixXd* J, VectorXd* c, MatrixXd* C) override {
    if (r || c) ++evaluations;
    if (J || C) ++jacobian_evaluations;
    problem_.Evaluate(x, r, J, c, C);
  }
  void Plus(const VectorXd& x, const VectorXd& dx, VectorXd* x_plus) const override {
    problem_.Plus(x, dx, x_plus);
  }
  bool has_second_derivatives() const override { return problem_.has_second_derivatives(); }
  void Curvature(const VectorXd& x, const VectorXd& mu, MatrixXd* S) override {
    problem_.Curvature(x, mu, S);
  }

  int evaluations = 0;           ///< of r or c
  int jacobian_evaluations = 0;  ///< of J or C

 private:
  ConstrainedLeastSquares& problem_;
};

/// What a back end says of itself when it stops. Run() has the last word on the status.
struct Outcome {
  SolveStatus claim = SolveStatus::kStalled;  ///< before it is judged
  std::string message;                        ///< why it stopped
  int iterations = 0;                         ///< of its own count
  double bias_bound = 0;                      ///< penalty only: |c|_2 is at most this
};

/// How a package solves a problem: x is its start, and afterwards where it ended.
using BackEnd = std::function<Outcome(CountedProblem& problem, VectorXd* x)>;

/// Runs a back end from x0 and judges where it ended: kConverged where `rule` is met, else
/// kInfeasible where |c| is stationary but not zero, else what the back end claims. An exception
/// of the back end becomes kFailed; a point that is not finite is replaced by x0. Throws
/// std::invalid_argument where x0 has the wrong size, is not finite, or `rule` is invalid.
Summary Run(std::string_view solver, ConstrainedLeastSquares& problem, const StoppingRule& rule,
            const VectorXd& x0, const BackEnd& back_end);

}  // namespace vmech
