#include "vmech/dynamics/simulation/equilibrium.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "vmech/dynamics/simulation/equations/small_motions.h"
#include "vmech/kinematics/loops/assembled_mechanism.h"

namespace vmech {
namespace {

constexpr int kIterations = 500;
constexpr double kLongestStep = 0.3;  // [rad], or characteristic lengths
/// Of the forces that there would be a radian away: what is left counts as none.
constexpr double kBalanced = 1e-13, kRounding = 1e-9;
constexpr double kNeutral = 1e-9;

/// Of all links, at the characteristic length.
double Weight(const KinematicTree& tree) {
  double mass = 0;
  for (const TreeNode& node : tree.nodes) mass += node.mass;
  return mass * tree.mechanism.gravity_W.norm() * tree.length;
}

/// Everything in radians and characteristic lengths.
class Descent {
 public:
  Descent(SmallMotions* motions, Equilibrium* result)
      : motions_(*motions), result_(*result), weight_(Weight(motions->tree())) {}

  void Go() {
    const char* why = "it has not come to rest";
    for (; result_.iterations < kIterations; ++result_.iterations) {
      FindStiffness();
      if (force_.lpNorm<Eigen::Infinity>() <= kBalanced * size_) {
        result_.found = true;
        return;
      }
      if (Step()) continue;
      why = "no step along the forces brings them nearer to a balance";
      break;
    }
    // Rounding may leave more than the bound above.
    result_.found = force_.lpNorm<Eigen::Infinity>() <= kRounding * size_;
    if (!result_.found) Fail(why);
  }

  Stability Judge() const {
    const double least = stiffnesses_.minCoeff(), largest = stiffnesses_.lpNorm<Eigen::Infinity>();
    if (least < -kNeutral * largest) return Stability::kUnstable;
    return least > kNeutral * largest ? Stability::kStable : Stability::kNeutral;
  }

 private:
  VectorXd ForceAt(const VectorXd& x) {
    VectorXd q;
    const VectorXd moved = motions_.scale().cwiseProduct(x);
    if (!motions_.PoseAt(moved, &q)) return {};
    const VectorXd at_rest = VectorXd::Zero(motions_.freedoms());
    return motions_.scale().cwiseProduct(motions_.Force(q, at_rest));
  }

  void FindStiffness() {
    force_ = ForceAt(VectorXd::Zero(motions_.freedoms()));
    const auto scale = motions_.scale().asDiagonal();
    const MatrixXd K = scale * motions_.Stiffness() * scale;
    const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(0.5 * (K + K.transpose()));
    stiffnesses_ = eigen.eigenvalues();
    directions_ = eigen.eigenvectors();
    size_ = std::max({K.lpNorm<Eigen::Infinity>(), force_.lpNorm<Eigen::Infinity>(), weight_});
    result_.residual =
        motions_.Force(motions_.q(), VectorXd::Zero(motions_.freedoms())).lpNorm<Eigen::Infinity>();
  }

  /// Newton's, downhill along every direction, shortened until it leads no higher.
  bool Step() {
    constexpr double kSoftest = 1e-8;
    constexpr int kHalvings = 30;
    VectorXd along = directions_.transpose() * force_;
    for (Eigen::Index i = 0; i < along.size(); ++i) {
      along[i] /= std::max(std::abs(stiffnesses_[i]), kSoftest * size_);
    }
    VectorXd step = directions_ * along;
    step *= std::min(1.0, kLongestStep / step.lpNorm<Eigen::Infinity>());
    for (int halving = 0; halving < kHalvings; ++halving, step *= 0.5) {
      const VectorXd there = ForceAt(step);
      if (there.size() == 0) continue;
      const bool lower = there.dot(step) >= -0.5 * force_.dot(step);
      if (!lower && there.norm() >= force_.norm()) continue;
      return motions_.MoveTo(motions_.scale().cwiseProduct(step));
    }
    return false;
  }

  void Fail(const char* why) {
    result_.message = fmt::format(
        "no equilibrium was found: {}; after {} steps {:.3g} N or N m are left along a free motion",
        why, result_.iterations, result_.residual);
  }

  SmallMotions& motions_;
  Equilibrium& result_;
  VectorXd force_, stiffnesses_;
  MatrixXd directions_;
  double size_ = 0;  ///< of forces a radian away, at this pose: near a singular one they are huge
  double weight_;
};

}  // namespace

Equilibrium FindEquilibrium(const Simulation& simulation) {
  SmallMotions motions(simulation);
  Equilibrium result;
  result.tree = motions.tree();
  if (motions.freedoms() > 0) {
    Descent descent(&motions, &result);
    descent.Go();
    if (result.found) result.stability = descent.Judge();
  } else {
    result.found = true;
  }
  result.q = motions.q();
  return result;
}

Simulation AtItsStart(Simulation simulation) {
  if (simulation.start != SimulationStart::kEquilibrium) return simulation;
  const Equilibrium equilibrium = FindEquilibrium(simulation);
  if (!equilibrium.found) throw std::runtime_error(equilibrium.message);
  // The tree's mechanism has neither friction nor limits, but the starts.
  Mechanism at = equilibrium.tree.mechanism;
  SetStarts(equilibrium.tree, equilibrium.q, &at);
  for (size_t j = 0; j < at.joints.size(); ++j) {
    simulation.mechanism.joints[j].start = at.joints[j].start;
    simulation.mechanism.joints[j].start_given = true;
  }
  simulation.start = SimulationStart::kAsDrawn;
  return simulation;
}

}  // namespace vmech
