#include "vmech/hw_interface/arm/arm_model.h"

#include <array>

#include <gtest/gtest.h>

#include "support/examples.h"
#include "vmech/dynamics/rigid_body/newton_euler.h"
#include "vmech/hw_interface/arm/sarcos_arm.h"
#include "vmech/kinematics/loops/closure.h"

namespace vmech::arm_model_test {
namespace {

using Row7 = Eigen::Matrix<double, 7, 1>;

constexpr double kPrinted = 1e-9;  // the tables carry ten decimals
constexpr double kIdentity = 1e-10;

/// Torques without friction, from generated code of another project (the SL simulator's
/// Newton-Euler of this arm, parameters of January 2012), evaluated in its own harness.
struct Case {
  Row7 q, v, vdot, torque;
};
const std::array<Case, 4> kCases{{
    {{0.0, -0.3, 0.0, 1.57, 0.0, 0.0, 0.0},
     Row7::Zero(),
     Row7::Zero(),
     {6.3356919058, -9.4792874867, 2.6478673818, 8.5597791749, -2.5226448096, 0.3019179196,
      0.663739059}},
    {{0.809, -1.025, -0.4, 0.596, -0.675, -0.075, -0.499},
     {0.615, -0.275, 1.469, 0.529, 1.241, -0.633, 0.175},
     {-3.89, -6.829, -3.875, 4.21, 3.166, -5.941, -1.98},
     {11.2304758159, -25.1217285449, 6.0358319537, 1.0099285051, -0.1561591477, 1.3481218552,
      -0.5114784947}},
    {{1.307, -0.697, -0.698, 1.961, -1.089, 0.439, -0.384},
     {-0.44, 1.899, 0.501, 0.774, 0.086, -0.764, -0.418},
     {4.133, -2.243, 2.264, -1.904, -1.896, 0.061, -7.732},
     {9.9417345201, -8.7463852992, 8.3786614717, 1.3709808812, 1.3329491024, 0.257097992,
      -0.9502801108}},
    {{-0.311, 0.13, 0.025, 1.842, 0.126, 0.238, -0.601},
     {-1.366, 1.808, -1.383, 0.041, -1.424, 0.869, -0.895},
     {-4.931, 0.592, -0.783, 7.317, 7.266, 4.745, 2.745},
     {4.0277337133, -3.5099630432, 0.2520046873, 12.1343337134, -2.5312432398, -0.1592544311,
      1.2121620602}},
}};

class SarcosArm : public testing::Test {
 protected:
  ArmModel arm_{std::make_shared<const ArmDescription>(SarcosMasterArm())};
  Random random_{5};
};

TEST_F(SarcosArm, PoseOfTheHandIsThatOfThePublishedTransforms) {
  // T_R_WAA at the fifth random posture of the generated code.
  arm_.SetPosture(kCases[1].q.data());
  Matrix3d R;
  R << 0.740335786549, 0.592666405967, -0.317252981693, -0.525947542407, 0.804585427225,
      0.275719917549, 0.418667058401, -0.037266895983, 0.907374824796;
  const Vector3d p(0.535034462161, 0.46576116287, 0.180274265419);
  EXPECT_LT((arm_.X_DH().R - R).norm(), kPrinted);
  EXPECT_LT((arm_.X_DH().p - (R * Vector3d(-0.03, 0.1, 0.02) + p)).norm(), kPrinted);
}

TEST_F(SarcosArm, TorquesOfTheIndependentTableGiveItsAccelerations) {
  for (const Case& c : kCases) {
    arm_.SetPosture(c.q.data());
    const VectorXd vdot = arm_.Accelerations(c.v, c.torque, Wrenchd{});
    // 1e-10 of torque over the least eigenvalue of M, 2e-3.
    EXPECT_LT((vdot - c.vdot).norm(), 1e-6);
    EXPECT_LT((arm_.MassMatrix() * (vdot - c.vdot)).norm(), kPrinted);
  }
}

TEST_F(SarcosArm, GravityTorquesAreThoseOfTheIndependentTable) {
  arm_.SetPosture(kCases[0].q.data());
  EXPECT_LT((arm_.GravityTorques() - kCases[0].torque).norm(), kPrinted);
}

TEST_F(SarcosArm, PowerOfTorquesAndHandIsTheRateOfTheEnergy) {
  const VectorXd q = arm_.description().posture + random_.Vector(7, 0.3);
  const VectorXd v = random_.Vector(7, 2);
  const VectorXd torque = random_.Vector(7, 10);
  const Wrenchd F_Ho{random_.Vector(3, 10), random_.Vector(3, 2)};
  const auto energy = [&](const VectorXd& at, const VectorXd& rate) {
    arm_.SetPosture(at.data());
    return 0.5 * rate.dot(arm_.MassMatrix() * rate) + arm_.PotentialEnergy();
  };
  arm_.SetPosture(q.data());
  const Vector6d V_DH = arm_.J() * v;
  const VectorXd vdot = arm_.Accelerations(v, torque, F_Ho);
  constexpr double kStep = 1e-5;  // central difference: error near 1e-10 of curvatures near 1e3
  const double rate =
      (energy(q + kStep * v, v + kStep * vdot) - energy(q - kStep * v, v - kStep * vdot)) /
      (2 * kStep);
  EXPECT_NEAR(rate, torque.dot(v) + F_Ho.Stacked().dot(V_DH), 1e-6);
}

TEST_F(SarcosArm, HandMassMovesWithTheHandle) {
  ArmModel with(std::make_shared<const ArmDescription>(WithMassAtHandle(SarcosMasterArm(), 0.5)));
  const VectorXd q = arm_.description().posture + random_.Vector(7, 0.3);
  arm_.SetPosture(q.data());
  with.SetPosture(q.data());
  // A point mass at Ho adds m J_v' J_v.
  const MatrixXd J_v = arm_.J().topRows<3>();
  EXPECT_LT((with.MassMatrix() - arm_.MassMatrix() - 0.5 * J_v.transpose() * J_v).norm(),
            kIdentity);
}

TEST(ArmModel, RefusesAClosedLoop) {
  ArmDescription arm;
  arm.tree = BuildKinematicTree(Example("four-bar"));
  EXPECT_THROW(ArmModel{std::make_shared<const ArmDescription>(arm)}, std::invalid_argument);
}

}  // namespace
}  // namespace vmech::arm_model_test
