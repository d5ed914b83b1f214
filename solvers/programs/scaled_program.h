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
    VectorXd u;            ///< [n] variables, 0 at a lower bound, 1 at an upper one
    double f = 0;          ///< the objective
    VectorXd df, g;        ///< [n], [m]
    MatrixXd dg;           ///< [m, n]
    bool defined = false;  ///< the program has values here
  };

  /// Keeps a reference; `feasibility` as ProgramOptions::feasibility.
  ScaledProgram(NonlinearProgram& program, double feasibility)
      : program_(program), feasibility_(feasibility) {}

  int variables() const { return static_cast<int>(program_.lower().size()); }  ///< n
  int constraints() const { return program_.constraints(); }                   ///< m
  double feasibility() const { return feasibility_; }  ///< largest g that counts as zero
  int evaluations() const { return evaluations_; }     ///< so far
  const Point& best() const { return best_; }          ///< as ProgramResult describes it
  bool IsFeasible(const Point& point) const;           ///< no g above feasibility()

  const Point& At(const VectorXd& u);          ///< evaluates it, or gives the last one again
  VectorXd Unscaled(const VectorXd& u) const;  ///< x of u
  VectorXd Range() const { return program_.upper() - program_.lower(); }  ///< upper - lower [n]

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
