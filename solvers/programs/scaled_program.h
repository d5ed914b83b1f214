#pragma once

#include <string>

#include "vmech/solvers/programs/nonlinear_program.h"

namespace vmech {

/// A program in u from 0 to 1, x = lower + u (upper - lower), that is defined everywhere, and
/// remembers the best point. It is evaluated once where f and g are asked for one after the other.
class ScaledProgram {
 public:
  /// The program's values and slopes at one point, in scaled variables.
  struct Point {
    VectorXd u;
    double f = 0;
    VectorXd df, g;
    MatrixXd dg;
    bool defined = false;
  };

  ScaledProgram(NonlinearProgram& program, double feasibility)
      : program_(program), feasibility_(feasibility) {}

  int variables() const { return static_cast<int>(program_.lower().size()); }
  int constraints() const { return program_.constraints(); }
  double feasibility() const { return feasibility_; }
  int evaluations() const { return evaluations_; }
  const Point& best() const { return best_; }
  bool IsFeasible(const Point& point) const;

  const Point& At(const VectorXd& u);
  VectorXd Unscaled(const VectorXd& u) const;
  VectorXd Range() const { return program_.upper() - program_.lower(); }

 private:
  void Evaluate(const VectorXd& u);
  /// Draws the search back to the last point at which the program was defined.
  void DrawBack();
  bool IsBetter(const Point& a, const Point& b) const;

  NonlinearProgram& program_;
  double feasibility_;
  int evaluations_ = 0;
  Point here_, last_, best_;
};

/// What the library of a package holds for this, as its variable vmech_minimise: runs from u and
/// says why it stopped.
using MinimiseFunction = std::string (*)(ScaledProgram& program, const ProgramOptions& options,
                                         const VectorXd& u);

}  // namespace vmech
