#pragma once

#include <functional>
#include <vector>

#include "vmech/base/dual.h"
#include "vmech/dynamics/loads/pose/joint_load.h"

namespace vmech {

/// Joint wrenches and the friction that depends on them: x = G(x) for the wrenches x of all joints,
/// moments divided by a length, by fixed-point iteration with Aitken's relaxation,
/// x += beta r, r = G(x) - x, which converges where the plain iteration swings or creeps; where it
/// does not, by Anderson's mixing of the last few iterates [Walker and Ni 2011]. Without a solution
/// the mechanism locks itself.
class FrictionIteration {
 public:
  /// `pass` replaces the wrenches of `loads` by G of them. Returns false where they do not settle.
  [[nodiscard]] bool Run(double length, std::vector<JointLoad<double>>* loads,
                         const std::function<void()>& pass);
  /// First the values, then their slopes, whose fixed point is that of dG/dx dx + dG/dp.
  [[nodiscard]] bool Run(double length, std::vector<JointLoad<Dual>>* loads,
                         const std::function<void()>& pass);

 private:
  /// x := G(x) for a part of the loads: their numbers, the values of duals or their slopes.
  struct Map;
  bool Solve(const Map& map);
  /// Iterates with x += Step; false if it does not settle.
  bool Iterate(const Map& map, void (FrictionIteration::*step)(int));
  bool Settled() const;
  void RelaxByAitken(int iteration);
  void MixByAnderson(int iteration);

  VectorXd x_, G_, residual_, last_residual_, start_;
  MatrixXd steps_, changes_;  ///< of x and of r, of the last iterations
  double beta_ = 0;
};

}  // namespace vmech
