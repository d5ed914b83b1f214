#pragma once

namespace vmech {

/// When a solve is done: the same for every back end, and measured by this module at the returned
/// point (optimality.h), whatever the back end claims of itself.
struct StoppingRule {
  /// Largest |c_i| that counts as c = 0 [unit of c], in (0, 1]. Raise it if c is noisy.
  double constraint_tolerance = 1e-10;
  /// Largest relative KKT error that counts as a minimum, in (0, 1]. Raise it to stop earlier on
  /// flat valleys; below 1e-12 rounding decides.
  double optimality_tolerance = 1e-9;
  /// Iterations after which a solve is given up, in [1, 1e9]; a back end that nests loops counts
  /// the inner ones.
  int max_iterations = 500;

  /// Throws std::invalid_argument with the name, the value and the range of what is wrong.
  void Validate() const;
};

}  // namespace vmech
