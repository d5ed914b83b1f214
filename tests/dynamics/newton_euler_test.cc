#include "vmech/dynamics/rigid_body/newton_euler.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "support/examples.h"
#include "vmech/kinematics/loops/closure.h"
#include "vmech/kinematics/tree/forward_kinematics.h"

namespace vmech {
namespace {

constexpr double kIdentity = 1e-10;  // sums of a few hundred terms

class EveryTree : public testing::TestWithParam<std::string> {
 protected:
  EveryTree()
      : tree_(BuildKinematicTree(Example(GetParam()))),
        ws_(tree_),
        inertias_(tree_),
        q_(RandomCoordinates(tree_, &random_)),
        v_(random_.Vector(tree_.nv)) {
    SetGravity(tree_.mechanism.gravity_W, &ws_);
  }

  VectorXd InverseDynamics(const VectorXd& v, const VectorXd& vdot) {
    EvaluatePose(tree_, q_, &ws_, false);
    ForwardVelocities(tree_, v.data(), &ws_);
    VelocityProducts(tree_, &ws_);
    ForwardAccelerations(tree_, vdot.data(), &ws_);
    BodyInertias(tree_, ws_, &inertias_);
    GyroscopicWrenches(tree_, inertias_, &ws_);
    VectorXd tau(tree_.nv);
    NewtonEuler<double>(tree_, inertias_, nullptr, &ws_, tau.data());
    return tau;
  }

  double PotentialEnergy(const VectorXd& q) {
    EvaluatePose(tree_, q, &ws_, false);
    double energy = 0;
    for (size_t i = 0; i < tree_.nodes.size(); ++i) {
      const TreeNode& node = tree_.nodes[i];
      const Posed X_WB = PoseInWorld(ws_, static_cast<int>(i), {});
      energy -= node.mass * tree_.mechanism.gravity_W.dot(X_WB * node.p_BoBcm);
    }
    return energy;
  }

  double KineticEnergy(const VectorXd& v) {
    EvaluatePose(tree_, q_, &ws_, false);
    ForwardVelocities(tree_, v.data(), &ws_);
    double energy = 0;
    for (size_t i = 0; i < tree_.nodes.size(); ++i) {
      const TreeNode& node = tree_.nodes[i];
      const Matrix3d R_WB = PoseInWorld(ws_, static_cast<int>(i), {}).R;
      const Posed X_Bcm{Matrix3d::Identity(), node.p_BoBcm};
      const Vector6d V = GraspTwist(ws_, static_cast<int>(i), X_Bcm);
      const Vector3d v_cm = V.head<3>(), w_B = R_WB.transpose() * V.tail<3>();
      energy += 0.5 * (node.mass * v_cm.squaredNorm() + w_B.dot(node.I_Bcm * w_B));
    }
    return energy;
  }

  Random random_{11};
  KinematicTree tree_;
  TreeWorkspace<double> ws_;
  TreeInertias<double> inertias_;
  VectorXd q_, v_;
};

TEST_P(EveryTree, RecursiveNewtonEulerIsMassMatrixTimesAccelerationAndBias) {
  const VectorXd vdot = random_.Vector(tree_.nv, 5);
  const VectorXd inertial = MassMatrix(tree_, q_) * vdot, bias = BiasForces(tree_, q_, v_);
  const VectorXd tau = InverseDynamics(v_, vdot);
  EXPECT_GT(tau.norm(), 0);
  EXPECT_LE((tau - inertial - bias).norm(), kIdentity * (inertial.norm() + bias.norm()));
}

TEST_P(EveryTree, MassMatrixIsSymmetricAndGivesTheKineticEnergy) {
  const MatrixXd M = MassMatrix(tree_, q_);
  EXPECT_LE((M - M.transpose()).norm(), kIdentity * M.norm());
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(M);
  EXPECT_GE(eigen.eigenvalues().minCoeff(), -kIdentity * M.norm());
  const double energy = KineticEnergy(v_);
  EXPECT_GT(energy, 0);
  EXPECT_NEAR(0.5 * v_.dot(M * v_), energy, kIdentity * energy);
}

TEST_P(EveryTree, BiasAtRestIsTheSlopeOfThePotentialEnergy) {
  constexpr double kStep = 1e-5, kDifference = 1e-8;
  const VectorXd bias = BiasForces(tree_, q_, VectorXd::Zero(tree_.nv));
  for (int k = 0; k < tree_.nv; ++k) {
    auto energy = [&](double step) {
      VectorXd moved = q_;
      MoveCoordinates(tree_, step * VectorXd::Unit(tree_.nv, k), &moved);
      return PotentialEnergy(moved);
    };
    const double slope = (energy(kStep) - energy(-kStep)) / (2 * kStep);
    EXPECT_NEAR(bias[k], slope, kDifference * (1 + bias.norm())) << NameOfVelocity(tree_, k);
  }
}

TEST_P(EveryTree, PowerOfTheBiasIsHalfTheRateOfTheMassMatrix) {
  // Velocity-dependent forces do work only to change the mass matrix: v' (h(v) - h(0)) is half of
  // v' dM/dt v.
  constexpr double kStep = 1e-5, kDifference = 1e-7;
  const double bias_power =
      v_.dot(BiasForces(tree_, q_, v_) - BiasForces(tree_, q_, VectorXd::Zero(tree_.nv)));
  auto twice_energy = [&](double t) {
    VectorXd moved = q_;
    MoveCoordinates(tree_, t * v_, &moved);
    return v_.dot(MassMatrix(tree_, moved) * v_);
  };
  const double slope = (twice_energy(kStep) - twice_energy(-kStep)) / (4 * kStep);
  EXPECT_NEAR(bias_power, slope, kDifference * (1 + std::abs(slope) + twice_energy(0)));
}

TEST_P(EveryTree, MomentaAreTheMassMatrixTimesVelocities) {
  ForwardKinematics(tree_, q_.data(), &ws_);
  BodyInertias(tree_, ws_, &inertias_);
  VectorXd momenta(tree_.nv);
  Momenta(tree_, inertias_, v_.data(), &ws_, momenta.data());
  const VectorXd expected = MassMatrix(tree_, q_) * v_;
  EXPECT_LE((momenta - expected).norm(), kIdentity * expected.norm());
  const double energy = KineticEnergy(v_);
  EXPECT_NEAR(vmech::KineticEnergy(tree_, inertias_, ws_), energy, kIdentity * energy);
}

TEST_P(EveryTree, WeightEnergyChangesAsTheCentresOfGravityRise) {
  const auto weight_energy = [&](const VectorXd& q) {
    ForwardKinematics(tree_, q.data(), &ws_);
    BodyInertias(tree_, ws_, &inertias_);
    return WeightEnergy(tree_.mechanism.gravity_W, inertias_);
  };
  const VectorXd other = RandomCoordinates(tree_, &random_);
  const double change = weight_energy(other) - weight_energy(q_);
  const double expected = PotentialEnergy(other) - PotentialEnergy(q_);
  EXPECT_NEAR(change, expected, kIdentity * (1 + std::abs(PotentialEnergy(q_))));
}

INSTANTIATE_TEST_SUITE_P(Examples, EveryTree, testing::ValuesIn(ExampleNames()),
                         [](const auto& info) { return TestName(info.param); });

}  // namespace
}  // namespace vmech
