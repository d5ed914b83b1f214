#pragma once

#include <string>

#include "vmech/solvers/programs/nonlinear_program.h"

namespace vmech {

/// The best point that was evaluated: the least f among those that are feasible, or, if none is,
/// the least violation.
struct ProgramResult {
  VectorXd x;             ///< [n] within the bounds
  double f = 0;           ///< the objective there
  VectorXd g;             ///< [m] the constraints there
  bool defined = false;   ///< the program is defined anywhere that was tried
  bool feasible = false;  ///< g is at most ProgramOptions::feasibility
  std::string message;    ///< why it stopped
  int evaluations = 0;    ///< of f and g with their slopes
  /// df/dx + dg/dx' lambda + mu = 0: what f loses by loosening a constraint; zero where it is not
  /// active. mu > 0 at an upper bound, < 0 at a lower one.
  VectorXd lambda, mu;    ///< [m], [n]
  double optimality = 0;  ///< size of the left side of that over f, x from 0 to 1
};

/// @throws std::invalid_argument if x0 does not fit or is not within the bounds;
/// std::runtime_error if the package of the method is not there.
ProgramResult Minimise(NonlinearProgram& program, const ProgramOptions& options,
                       const VectorXd& x0);

}  // namespace vmech
