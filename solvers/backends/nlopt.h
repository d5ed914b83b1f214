#pragma once

#include <string_view>

#include "vmech/solvers/constrained_least_squares.h"
#include "vmech/solvers/stopping_rule.h"
#include "vmech/solvers/summary.h"

namespace vmech {

/// The algorithms of NLopt that keep equality constraints.
enum class NloptMethod {
  kSlsqp,         ///< sequential quadratic programming [Kraft 1994]
  kAuglagLbfgs,   ///< augmented Lagrangian [Birgin & Martinez 2008], L-BFGS inside
  kAuglagCobyla,  ///< the same with COBYLA inside, which uses no derivatives [Powell 1994]
  kAuglagMma,     ///< the same with the method of moving asymptotes inside [Svanberg 2002]
};

/// The name of the back end.
constexpr std::string_view NameOf(NloptMethod method) {
  constexpr std::string_view kNames[] = {"nlopt_slsqp", "nlopt_auglag_lbfgs", "nlopt_auglag_cobyla",
                                         "nlopt_auglag_mma"};
  return kNames[static_cast<int>(method)];
}

/// The algorithms of NLopt. Redundant rows are taken out first (tangent_chart.h). They stop where
/// the objective no longer changes: SLSQP and L-BFGS leave a KKT error near 1e-8, MMA one near
/// 1e-7, COBYLA one near 1e-4 and |c| near 1e-6. Under a tighter rule the status is kStalled.
///
/// COBYLA never returns, whatever the limits on evaluations and time, once it is given infinite
/// values or constraints of its own that no longer decide (NLopt's issues 118 and 370). AUGLAG
/// arrives at infinite values, because it raises its penalty tenfold for as long as |c| does not
/// fall. So here COBYLA is given no bounds, which AUGLAG takes as inequalities instead, and is
/// stopped after a number of rounds that keeps every value finite.
/// [Johnson, The NLopt nonlinear-optimization package, 2.7]
struct NloptOptions {
  NloptMethod method = NloptMethod::kSlsqp;  ///< which of its algorithms
  /// Steps and changes of the objective that end a run, relative, in [1e-17, 1e-3].
  double tolerance = 1e-15;
  /// First step of COBYLA [unit of the tangent], in [1e-6, 10].
  double initial_step = 0.1;
  /// Size of COBYLA's trust region that ends it [unit of the tangent], in [1e-12, 1e-3].
  double final_step = 1e-6;
  /// Time after which a solve is given up [s], in [1e-3, 1e6].
  double max_seconds = 60;
  StoppingRule stopping;  ///< the verdict on where it ended

  void Validate() const;  ///< @throws std::invalid_argument naming field, value and range
};

/// Solves by NLopt from x0; where it ended is judged by `options.stopping`.
/// @throws std::invalid_argument as Validate.
Summary Solve(ConstrainedLeastSquares& problem, const NloptOptions& options, const VectorXd& x0);

}  // namespace vmech
