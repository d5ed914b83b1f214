#include "vmech/hw_interface/rendering/coupling_choice.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "vmech/dynamics/rigid_body/newton_euler.h"
#include "vmech/hw_interface/rendering/free_motions.h"
#include "vmech/kinematics/loops/assembly.h"
#include "vmech/kinematics/tree/forward_kinematics.h"
#include "vmech/kinematics/tree/grasp_rows.h"

namespace vmech {
namespace {

constexpr double kFaithful = 100;  // w_v [1/s]: 3 Hz over it, squared, is 3.6 %
constexpr double kMargin = 1.2;    // where the device bears it
constexpr double kPhase = 0.7;     // w_d times the loop's delay [rad]
constexpr double kDampingRatio = 0.4;
constexpr double kJerk = 20;    // [m/s^2]: what a step of the encoders may do to the handle
constexpr double kLever = 0.1;  // [m], of a hand that turns
constexpr double kLeastScale = 1e-6;
constexpr double kStiffest = 1e8;  // [N/m], at the mechanism, beyond what its inertia needs

/// w_d: as fast as hold, delay and filter let a handle swing on the coupling, and no faster than
/// the steps of its encoders allow, w^2 D <= kJerk, and than a brisk hand may change the force.
double FastestRate(const DeviceInfo& device, double smoothing) {
  constexpr double kBrisk = 0.15, kOfPeak = 0.1;  // [m/s]; of the peak in a tick
  const double by_delay = kPhase / (0.5 * device.period + device.delay + smoothing);
  const double step = std::max(device.linear.resolution, kLever * device.angular.resolution);
  const double by_step = step > 0 ? std::sqrt(kJerk / step) : by_delay;
  const double stiffest = kOfPeak * device.linear.peak / (kBrisk * device.period);
  const double by_peak = stiffest > 0 ? std::sqrt(stiffest / device.linear.mass) : by_delay;
  return std::min({by_delay, by_step, by_peak});
}

/// w_q: what a step of the encoders pulls by spring and damper is kQuiet of the peak. Zero where
/// the device states no peak or no steps.
double QuietRate(const DeviceInfo& device, double smoothing) {
  constexpr double kQuiet = 0.02;
  const HandlePhysics& handle = device.linear;
  const double step = handle.mass * handle.resolution;
  if (step == 0) return 0;
  // step (w^2 + 2 b w) = kQuiet peak, with the share of the step that the filter takes for speed.
  const double share = 1 - std::exp(-device.period / smoothing);
  const double b = kDampingRatio * share / device.period;
  return std::sqrt(b * b + kQuiet * handle.peak / step) - b;
}

double UnseenWork(const DeviceInfo& device) {
  constexpr double kLeast = 0.02, kMost = 0.5;  // [J]
  const double work = device.linear.peak * device.linear.resolution +
                      device.angular.peak * device.angular.resolution;
  return std::clamp(work, kLeast, kMost);
}

HandCoupling SoftCoupling(const DeviceInfo& device) {
  constexpr double kSoft = 250, kOffForce = 1000;  // [N/m]; where there is no force to be felt
  constexpr double kLever2 = 0.05 * 0.05;          // [m^2], of a hand
  const bool has_force = device.takes_wrench || device.takes_torque;
  const double stiffness = has_force ? kSoft : kOffForce;
  const double damping = 4 * device.period * stiffness;
  HandCoupling coupling;
  coupling.stiffness << Vector3d::Constant(stiffness), Vector3d::Constant(kLever2 * stiffness);
  coupling.damping << Vector3d::Constant(damping), Vector3d::Constant(kLever2 * damping);
  return coupling;
}

/// The free motions at q, so large that the joint that moves most turns by `angle`, or slides by
/// that part of the mechanism's length.
MatrixXd Excursions(const KinematicTree& tree, const VectorXd& q, double angle) {
  TreeWorkspace<double> ws(tree);
  ForwardKinematics(tree, q.data(), &ws);
  MatrixXd N = FreeMotions(tree, &ws);
  for (const TreeNode& node : tree.nodes) {
    if (node.v >= 0 && node.motion == NodeMotion::kPrismatic) N.row(node.v) /= tree.length;
  }
  const Eigen::RowVectorXd largest = N.cwiseAbs().colwise().maxCoeff();
  for (const TreeNode& node : tree.nodes) {
    if (node.v >= 0 && node.motion == NodeMotion::kPrismatic) N.row(node.v) *= tree.length;
  }
  return N * (angle / largest.array().max(1e-12)).matrix().asDiagonal();
}

/// lambda for the coupling: that of the pose, but no more than four times the least of the poses
/// about it. At a dead centre of the hand it has no bound, and says nothing of the motion.
double RatioAlongThePath(const KinematicTree& tree, const GraspFrame& grasp, const VectorXd& q,
                         const DeviceInfo& device) {
  constexpr double kSteps[] = {-0.3, -0.1, 0.1, 0.3};  // [rad]
  constexpr double kAtMost = 4;
  const double here = InertiaRatio(tree, grasp, q, device);
  if (device.linear.mass == 0) return 0;
  double least = std::numeric_limits<double>::infinity();
  for (const double step : kSteps) {
    const MatrixXd excursions = Excursions(tree, q, step);
    for (Eigen::Index k = 0; k < excursions.cols(); ++k) {
      VectorXd there = q;
      MoveCoordinates(tree, excursions.col(k), &there);
      if (!Assemble(tree, AssemblyOptions::Nearby(), &there).closed) continue;
      const double ratio = InertiaRatio(tree, grasp, there, device);
      if (ratio > 0) least = std::min(least, ratio);
    }
  }
  if (here > 0) return std::min(here, kAtMost * least);
  return std::isfinite(least) ? kAtMost * least : 0;
}

/// Force on a hand that stays where the mechanism is, once that hangs still on a soft spring.
double WeightAtHand(const KinematicTree& tree, const GraspFrame& grasp, const VectorXd& q,
                    const HandCoupling& coupling) {
  constexpr double kStep = 1e-2;
  constexpr int kSteps = 500;
  CoupledDynamics dynamics(tree, grasp, coupling, kStep, q);
  const Posed X_WH = dynamics.X_WG();
  for (int i = 0; i < kSteps; ++i) {
    if (dynamics.Step(X_WH, Vector6d::Zero()) == CoupledStatus::kFailed) break;
  }
  return dynamics.w().head<3>().norm();
}

double OrInfinite(double peak) {
  return peak > 0 ? peak : std::numeric_limits<double>::infinity();
}

/// A device that exerts forces and no moments cannot pay for moments on the mechanism.
void WithoutMoments(const DeviceInfo& device, HandCoupling* coupling) {
  const bool has_force = device.takes_wrench || device.takes_torque;
  if (!has_force || device.angular.peak > 0) return;
  coupling->stiffness = RowsThatCount(coupling->stiffness, GraspKind::kPoint);
  coupling->damping = RowsThatCount(coupling->damping, GraspKind::kPoint);
}

/// Of the handle's masses D at the rate w.
HandCoupling CouplingAt(double rate, const Vector6d& D, const DeviceInfo& device) {
  HandCoupling coupling;
  coupling.stiffness = rate * rate * D;
  coupling.damping = 2 * kDampingRatio * rate * D;
  WithoutMoments(device, &coupling);
  return coupling;
}

}  // namespace

SafetyOptions CouplingChoice::Safety() const {
  SafetyOptions safety;
  if (inertia_ratio == 0) return WithoutBlows(safety, device);
  safety.carried_start = true;
  safety.passivity.grace = unseen_work;
  safety.passivity.forgiven = 5 * unseen_work;
  safety.energy_trip = 10 * unseen_work;
  safety.force_slew = 5e4;
  safety.moment_slew = 2500;
  return WithoutBlows(safety, device);
}

CouplingChoice ChooseCoupling(const KinematicTree& tree, const GraspFrame& grasp, const VectorXd& q,
                              const DeviceInfo& device, double smoothing, double scale) {
  CouplingChoice choice;
  choice.device = device;
  choice.inertia_ratio = RatioAlongThePath(tree, grasp, q, device);
  if (choice.inertia_ratio == 0) {
    choice.coupling = SoftCoupling(device);
    if (scale > 0) choice.scale = scale;
    WithoutMoments(device, &choice.coupling);
    return choice;
  }
  const Vector6d D = HandleMasses(grasp, device);
  const double fastest = FastestRate(device, smoothing);
  const double faithful = kFaithful * std::sqrt(choice.inertia_ratio);
  const double unscaled = kMargin * faithful;
  choice.weight = WeightAtHand(tree, grasp, q, CouplingAt(std::min(unscaled, fastest), D, device));
  choice.unseen_work = UnseenWork(device);
  const double by_inertia = std::pow(fastest / faithful, 2);
  const double by_weight = 0.5 * OrInfinite(device.linear.peak) / choice.weight;
  choice.scale = scale > 0 ? scale : std::max(kLeastScale, std::min({1.0, by_inertia, by_weight}));
  const double needed = unscaled * std::sqrt(choice.scale);
  const double stiffest = std::sqrt(kStiffest * choice.scale / device.linear.mass);
  const double quiet = std::min({unscaled, QuietRate(device, smoothing), stiffest});
  choice.coupling = CouplingAt(std::min(std::max(needed, quiet), fastest), D, device);
  choice.coupling.max_force = OrInfinite(device.linear.peak);
  choice.coupling.max_moment = OrInfinite(device.angular.peak);
  return choice;
}

Vector6d HandleMasses(const GraspFrame& grasp, const DeviceInfo& device) {
  Vector6d D;
  D << Vector3d::Constant(device.linear.mass), Vector3d::Constant(device.angular.mass);
  return RowsThatCount(D, grasp.kind);
}

double InertiaRatio(const KinematicTree& tree, const GraspFrame& grasp, const VectorXd& q,
                    const DeviceInfo& device) {
  TreeWorkspace<double> ws(tree);
  ForwardKinematics(tree, q.data(), &ws);
  const MatrixXd N = FreeMotions(tree, &ws);
  if (N.cols() == 0) {
    throw std::invalid_argument(
        fmt::format("'{}' has no freedom at this pose: there is nothing that a hand could move",
                    tree.mechanism.name));
  }
  if (device.linear.mass == 0) return 0;
  Matrix6Xd J(6, tree.nv);
  GraspJacobian(tree, ws, grasp.node, grasp.X_BG, &J);
  // The handle's masses move the mechanism by D^1/2 J N (N'MN)^-1 N'J' D^1/2: eigenvalues 1/lambda.
  const MatrixXd JN = HandleMasses(grasp, device).cwiseSqrt().asDiagonal() * J * N;
  MatrixXd M = N.transpose() * MassMatrix(tree, q) * N;
  M.diagonal().array() += 1e-12 * M.diagonal().maxCoeff();
  const MatrixXd mobility = JN * M.llt().solve(JN.transpose());
  const VectorXd eigen = Eigen::SelfAdjointEigenSolver<MatrixXd>(mobility).eigenvalues();
  constexpr double kMoves = 1e-6;  // of the largest: less is a direction that the joints bar
  double least = eigen.maxCoeff();
  for (double value : eigen) {
    if (value > kMoves * eigen.maxCoeff()) least = std::min(least, value);
  }
  return least > 0 ? 1 / least : 0;
}

}  // namespace vmech
