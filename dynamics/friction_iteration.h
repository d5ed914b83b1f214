#pragma once

#include <functional>
#include <vector>

#include "vmech/mechanisms/pose.h"

namespace vmech {

template <typename T>
struct JointLoad;

/// Joint wrenches and the friction that depends on them: x = G(x) for the wrenches x of all joints,
/// moments divided by a length, by fixed-point iteration with Aitken's relaxation,
/// x += beta r, r = G(x) - x, which converges where the plain iteration swings or creeps. Without a
/// solution the mechanism locks itself.
class FrictionIteration {
 public:
  /// `pass` replaces the wrenches of `loads` by G of them. Returns false where they do not settle.
  [[nodiscard]] bool Run(double length, std::vector<JointLoad<double>>* loads,
                         const std::function<void()>& pass);

 private:
  bool Settled() const;
  void Relax(bool first);

  VectorXd x_, G_, residual_, last_residual_;
  double beta_ = 0;
};

}  // namespace vmech
