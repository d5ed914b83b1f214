#pragma once

#include "vmech/dynamics/simulation/equations/equations_of_motion.h"
#include "vmech/dynamics/simulation/prepared_simulation.h"
#include "vmech/dynamics/simulation/simulation.h"

namespace vmech {

/// A mechanism near a pose where it stands still, as its independent freedoms x move a little, the
/// drives held: force(x, x') = N'(forces - h), and
///
///   (N'M N) x'' = force(x, x') = force(0, 0) - K x - D x'.
///
/// Without dry friction and limits, at the time of the simulation's start. Derivatives are central
/// differences of eighth order, good to 1e-12 of what they are.
class SmallMotions {
 public:
  /// @throws as PrepareSimulation.
  explicit SmallMotions(const Simulation& simulation);

  const KinematicTree& tree() const { return equations_.tree(); }  ///< of the assembled mechanism
  const VectorXd& q() const { return q_; }  ///< [nq], the pose that motions are small about
  const PreparedSimulation& prepared() const { return prepared_; }  ///< with loads and tolerance
  int freedoms() const { return static_cast<int>(scale_.size()); }  ///< independent motions
  /// Velocities that the freedoms are, and what of each is one: 1 rad, or the characteristic
  /// length.
  std::vector<int> velocities() const;
  const VectorXd& scale() const { return scale_; }  ///< [freedoms] what of each counts as one

  /// The pose to which x moves q, loops closed. False if they do not close there.
  bool PoseAt(const VectorXd& x, VectorXd* q);
  /// That pose is the one to move from now on.
  bool MoveTo(const VectorXd& x);

  /// [freedoms] N'(forces - h) at rates x' [freedoms]
  VectorXd Force(const VectorXd& q, const VectorXd& rates);
  MatrixXd Stiffness();    ///< K = -dF/dx [freedoms, freedoms]
  MatrixXd Damping();      ///< D = -dF/dx' [freedoms, freedoms]
  MatrixXd Inertia();      ///< N'M N
  MatrixXd FreeMotions();  ///< N [nv, freedoms]

 private:
  void ChooseFreedoms();
  template <typename At>
  MatrixXd Derivative(const At& force_at);

  PreparedSimulation prepared_;
  EquationsOfMotion equations_;
  VectorXd q_, scale_;
  double time_;
};

}  // namespace vmech
