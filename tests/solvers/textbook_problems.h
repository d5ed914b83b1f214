#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "dual2.h"
#include "vmech/solvers/constrained_least_squares.h"

namespace vmech::textbook {

using Functions = std::function<std::vector<Dual2>(const std::vector<Dual2>& x)>;

/// A problem on plain vectors given by formulas, with exact first and second derivatives.
class FormulaProblem final : public ConstrainedLeastSquares {
 public:
  FormulaProblem(const ProblemSizes& sizes, Functions residuals, Functions constraints,
                 std::vector<Bound> bounds = {}, bool second_derivatives = true)
      : ConstrainedLeastSquares(sizes, std::move(bounds)),
        residuals_(std::move(residuals)),
        constraints_(std::move(constraints)),
        second_derivatives_(second_derivatives) {}

  void Evaluate(const VectorXd& x, VectorXd* r, MatrixXd* J, VectorXd* c, MatrixXd* C) override;
  bool has_second_derivatives() const override { return second_derivatives_; }
  void Curvature(const VectorXd& x, const VectorXd& mu, MatrixXd* S) override;

 private:
  Functions residuals_, constraints_;
  bool second_derivatives_;
};

/// A problem whose solution is known.
struct TextbookProblem {
  std::string name;
  std::function<std::unique_ptr<ConstrainedLeastSquares>()> make;
  VectorXd start;
  VectorXd solution;     ///< empty where it is not unique
  double objective = 0;  ///< 1/2 |r|^2 there
  double solution_tolerance = 1e-7;
};

const std::vector<TextbookProblem>& TextbookProblems();
const TextbookProblem& FindProblem(const std::string& name);

/// Problems whose constraints no point meets; their `solution` is empty.
const std::vector<TextbookProblem>& InfeasibleProblems();

}  // namespace vmech::textbook
