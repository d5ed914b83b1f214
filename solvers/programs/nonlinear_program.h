#pragma once

#include <utility>

#include "vmech/base/pose.h"

namespace vmech {

/// minimise f(x) subject to g(x) <= 0, lower <= x <= upper. Bounds are finite.
class NonlinearProgram {
 public:
  /// Bounds [n] of x; `constraints`: m, rows of g.
  NonlinearProgram(VectorXd lower, VectorXd upper, int constraints)
      : lower_(std::move(lower)), upper_(std::move(upper)), constraints_(constraints) {}
  virtual ~NonlinearProgram() = default;

  const VectorXd& lower() const { return lower_; }  ///< [n]
  const VectorXd& upper() const { return upper_; }  ///< [n], above lower
  int constraints() const { return constraints_; }  ///< m, rows of g

  /// Writes f, df/dx [n], g [m] and dg/dx [m, n]. False where the program is not defined.
  virtual bool Evaluate(const VectorXd& x, double* f, VectorXd* df, VectorXd* g, MatrixXd* dg) = 0;

 private:
  VectorXd lower_, upper_;
  int constraints_;
};

/// The algorithms that keep inequality constraints by their slopes: of NLopt, and Ipopt.
enum class ProgramMethod {
  kSlsqp,  ///< sequential quadratic programming [Kraft 1994]
  kMma,    ///< the method of moving asymptotes [Svanberg 2002]
  kIpopt,  ///< an interior-point method [Waechter & Biegler 2006], curvature by L-BFGS
};

/// How a nonlinear program is solved, and when it counts as solved.
struct ProgramOptions {
  ProgramMethod method = ProgramMethod::kSlsqp;  ///< of NLopt
  double tolerance = 1e-10;                      ///< of f and x, relative
  /// Largest g that counts as zero. Packages stop a little on either side of a constraint: they are
  /// asked for half of this inside of it.
  double feasibility = 1e-6;
  int max_evaluations = 500;  ///< of f and g with their slopes
};

}  // namespace vmech
