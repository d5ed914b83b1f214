#pragma once

#include "vmech/dynamics/simulation/equations/equations_of_motion.h"
#include "vmech/dynamics/simulation/prepared_simulation.h"

namespace vmech {

/// The same motion as a differential-algebraic problem F(t, y, y') = 0 in which nothing is solved
/// for, the stabilised form of index two [Gear, Gupta and Leimkuhler 1985]:
///
///   q' = v (+) G'm,   M v' + h = forces - G'l,
///   G v = rates of drives,   g(q) = positions of drives,
///   y = [q; v; supplied; dissipated; l; m]
///
/// G are the loops' C in an orthonormal basis of what its dimensionless columns span at one pose,
/// since redundant rows would leave F singular, and the rows of the drives. Without contacts.
class IndexTwo {
 public:
  /// Keeps references. @throws std::invalid_argument if there is dry friction or a limit.
  IndexTwo(const PreparedSimulation& prepared, EquationsOfMotion* equations);

  /// Numbers in y: those of EquationsOfMotion, and two multipliers for each constraint.
  int size() const { return equations_.size() + 2 * constraints(); }
  /// y is that of EquationsOfMotion with room for the rest; chooses the basis there.
  void Start(double time, VectorXd* y, VectorXd* slopes);
  /// Writes F [size]. False if it is not finite, or where loops lose rank, over which steps lead:
  /// multipliers are not determined there.
  bool Residual(double time, const double* y, const double* slopes, double* F);
  /// Has the basis become bad?
  bool ChoosesBadly(double time, const double* y);
  /// Which unknowns have slopes.
  std::vector<bool> Differential() const;

 private:
  int constraints() const { return rank_ + equations_.drives(); }
  void ChooseRows();
  MatrixXd Rows() const;
  double LeastPivot() const;

  const PreparedSimulation& prepared_;
  EquationsOfMotion& equations_;
  int rank_ = 0;
  VectorXd row_scale_;
  MatrixXd basis_;  ///< [rows, rank] orthonormal
  double best_pivot_ = 0;
  bool from_singular_ = false;  ///< it began at such a pose
};

}  // namespace vmech
