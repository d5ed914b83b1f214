#include "vmech/dynamics/simulation/equations/small_motions.h"

#include <limits>

#include "vmech/kinematics/loops/closure.h"
#include "vmech/kinematics/loops/dimensionless_loops.h"
#include "vmech/kinematics/tree/forward_kinematics.h"

namespace vmech {
namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

Simulation WithoutContacts(Simulation simulation) {
  for (Joint& joint : simulation.mechanism.joints) {
    for (Passive& passive : joint.passive) passive.coulomb = 0;
    joint.load_friction = {};
    for (double& lower : joint.lower) lower = -kNoLimit;
    for (double& upper : joint.upper) upper = kNoLimit;
  }
  return simulation;
}

}  // namespace

SmallMotions::SmallMotions(const Simulation& simulation)
    : prepared_(PrepareSimulation(WithoutContacts(simulation))),
      equations_(prepared_),
      q_(prepared_.q),
      time_(simulation.times.front()) {
  equations_.Close(time_, q_.data());
  ChooseFreedoms();
}

void SmallMotions::ChooseFreedoms() {
  equations_.ChooseFreedoms(q_);
  equations_.Place(time_, q_.data(), VectorXd::Zero(tree().nv).eval().data());
  const VectorXd all = VelocityScale(tree());
  scale_.resize(static_cast<Eigen::Index>(velocities().size()));
  for (int k = 0; k < freedoms(); ++k) scale_[k] = all[velocities()[static_cast<size_t>(k)]];
}

std::vector<int> SmallMotions::velocities() const {
  const std::vector<int>& independent = equations_.model().partition.driven;
  return {independent.begin() + equations_.drives(), independent.end()};
}

bool SmallMotions::PoseAt(const VectorXd& x, VectorXd* q) {
  constexpr int kSteps = 20;
  const double tolerance = std::max(1e-14, 0.1 * prepared_.closure_tolerance);
  *q = q_;
  ConstrainedMotion& motion = equations_.motion();
  motion.SetPose(q->data());
  const VectorXd step = motion.N().rightCols(freedoms()) * x;
  MoveCoordinates(tree(), step, q);
  LoadWorkspace<double>& ws = motion.ws();
  const double error =
      CloseByNewton(tree(), tolerance, kSteps, &ws.dependents, &ws.tree, q->data());
  return error <= std::max(prepared_.closure_tolerance, 1e-12);
}

bool SmallMotions::MoveTo(const VectorXd& x) {
  VectorXd q;
  if (!PoseAt(x, &q)) return false;
  q_ = q;
  equations_.Place(time_, q_.data(), VectorXd::Zero(tree().nv).eval().data());
  equations_.forces().Remember(equations_.motion());
  if (equations_.ChoosesBadly()) ChooseFreedoms();
  return true;
}

VectorXd SmallMotions::Force(const VectorXd& q, const VectorXd& rates) {
  ConstrainedMotion& motion = equations_.motion();
  motion.SetPose(q.data());
  const VectorXd v = motion.N().rightCols(freedoms()) * rates;
  equations_.Evaluate(time_, q.data(), v.data());
  return motion.driving().tail(freedoms());
}

template <typename At>
MatrixXd SmallMotions::Derivative(const At& force_at) {
  constexpr double kStep = 0.01;
  constexpr double kWeights[] = {4. / 5, -1. / 5, 4. / 105, -1. / 280};
  MatrixXd derivative = MatrixXd::Zero(freedoms(), freedoms());
  for (int k = 0; k < freedoms(); ++k) {
    const double step = kStep * scale_[k];
    for (int i = 1; i <= 4; ++i) {
      const VectorXd x = i * step * VectorXd::Unit(freedoms(), k);
      derivative.col(k) += kWeights[i - 1] / step * (force_at(x) - force_at(-x));
    }
  }
  return derivative;
}

MatrixXd SmallMotions::Stiffness() {
  const VectorXd at_rest = VectorXd::Zero(freedoms());
  VectorXd q;
  return -Derivative([&](const VectorXd& x) -> VectorXd {
    PoseAt(x, &q);
    return Force(q, at_rest);
  });
}

/// Rates as they are: those of motions without inertia are damped too.
MatrixXd SmallMotions::Damping() {
  const VectorXd none = VectorXd::Zero(tree().nv);
  return -Derivative([&](const VectorXd& rates) -> VectorXd {
    equations_.motion().SetPose(q_.data());
    const VectorXd v = equations_.motion().N().rightCols(freedoms()) * rates;
    equations_.TakeState(time_, q_.data(), v.data(), none.data());
    const ConstrainedMotion& motion = equations_.motion();
    return motion.N().rightCols(freedoms()).transpose() * (motion.ws().passive - motion.ws().tau);
  });
}

MatrixXd SmallMotions::Inertia() {
  equations_.motion().SetPose(q_.data());
  return equations_.motion().inertia().bottomRightCorner(freedoms(), freedoms());
}

MatrixXd SmallMotions::FreeMotions() {
  equations_.motion().SetPose(q_.data());
  return equations_.motion().N().rightCols(freedoms());
}

}  // namespace vmech
