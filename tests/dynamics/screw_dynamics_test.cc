#include "vmech/dynamics/rigid_body/screw_dynamics.h"

#include <gtest/gtest.h>

#include "support/examples.h"
#include "vmech/base/linear_algebra/linear_algebra.h"
#include "vmech/base/screw_algebra.h"
#include "vmech/dynamics/in_hand/grasped_mechanism.h"
#include "vmech/dynamics/rigid_body/newton_euler.h"
#include "vmech/kinematics/loops/assembly.h"
#include "vmech/kinematics/loops/loops.h"
#include "vmech/kinematics/tree/forward_kinematics.h"

namespace vmech {
namespace {

constexpr double kIdentity = 1e-12;  // relative: sums of a few hundred terms

/// The same in screws and by the algorithms of the offline analyses.
class EveryTreeInScrews : public testing::TestWithParam<std::string> {
 protected:
  EveryTreeInScrews()
      : tree_(BuildKinematicTree(Example(GetParam()))),
        ws_(tree_),
        inertias_(tree_),
        reference_(tree_),
        q_(StartCoordinates(tree_)),
        v_(random_.Vector(tree_.nv)),
        vdot_(random_.Vector(tree_.nv)) {
    EXPECT_TRUE(Assemble(tree_, {}, &q_).closed);
    SetGravity(tree_.mechanism.gravity_W, &ws_);
  }

  void SetPose(const VectorXd& q) {
    ForwardKinematics(tree_, q.data(), &ws_);
    BodyInertias(tree_, ws_, &inertias_);
    LoopErrors(tree_, &ws_);
    ForwardKinematics(tree_, q.data(), &reference_);
    LoopErrors(tree_, &reference_);
    LoopJacobian(tree_, &reference_);
  }
  void SetMotion(const VectorXd& v, const double* vdot) {
    ForwardVelocities(tree_, v.data(), &ws_);
    VelocityProducts(tree_, &ws_);
    if (vdot != nullptr) ForwardAccelerations(tree_, vdot, &ws_);
    ForwardVelocities(tree_, v.data(), &reference_);
    ForwardAccelerations(tree_, v.data(), vdot, &reference_);
  }
  /// Far from closed.
  VectorXd SomePose() { return RandomCoordinates(tree_, &random_); }
  /// As the tick has them.
  MatrixXd LoopRows(const VectorXd& q) {
    GraspedMechanism pose(tree_, GraspFrame{});
    pose.Set(q);
    return pose.C().topRows(tree_.rows);
  }

  Random random_{7};
  KinematicTree tree_;
  ScrewWorkspace ws_;
  ScrewInertias inertias_;
  TreeWorkspace<double> reference_;
  VectorXd q_, v_, vdot_;
};

TEST_P(EveryTreeInScrews, HasTheSamePosesAndLoopErrors) {
  SetPose(SomePose());
  for (size_t i = 0; i < tree_.nodes.size(); ++i) {
    const Posed X_WB = PoseOf(ws_.at(static_cast<int>(i)).X);
    EXPECT_LT((X_WB.R - reference_.nodes[i].X_WB.R).norm(), kIdentity);
    EXPECT_LT((X_WB.p - reference_.nodes[i].X_WB.p).norm(), kIdentity);
  }
  for (size_t l = 0; l < tree_.loops.size(); ++l) {
    EXPECT_LT((ws_.loops[l].state.e2 - reference_.loops[l].e2).norm(), kIdentity);
  }
}

TEST_P(EveryTreeInScrews, HasTheSameJacobians) {
  const VectorXd q = SomePose();
  SetPose(q);
  const MatrixXd C = LoopRowScale(tree_).asDiagonal() * DenseLoopJacobian(tree_, reference_);
  EXPECT_LE((LoopRows(q) - C).norm(), kIdentity * C.norm());
  const Vector3d p_WQ(0.1, -0.2, 0.3);
  for (size_t i = 0; i < tree_.nodes.size(); ++i) {
    const int node = static_cast<int>(i);
    std::vector<Screw> columns(tree_.nv);
    Matrix6Xd J(6, tree_.nv), expected(6, tree_.nv);
    PointJacobian(tree_, ws_, node, FourOf(p_WQ), &columns);
    FillMatrix(columns, &J);
    PointJacobian(tree_, reference_, node, p_WQ, &expected);
    EXPECT_LE((J - expected).norm(), kIdentity * expected.norm());
  }
}

TEST_P(EveryTreeInScrews, HasTheSameLoopBias) {
  SetPose(q_);
  const MatrixXd C = LoopRows(q_);
  const VectorXd v = tree_.rows > 0 ? VectorXd(FindNullSpace(C, 1e-9).basis.rowwise().sum()) : v_;
  SetMotion(v, nullptr);
  LoopAccelerationBias(tree_, &reference_);
  const VectorXd scale = LoopRowScale(tree_);
  LoopWrenches(tree_, scale.data(), &ws_);
  for (size_t l = 0; l < tree_.loops.size(); ++l) {
    const Loop& loop = tree_.loops[l];
    VectorXd bias(loop.rows);
    constexpr double s = -0.5;
    LoopBias(tree_, ws_, static_cast<int>(l), s, bias.data());
    for (int k = 0; k < loop.rows; ++k) {
      EXPECT_NEAR(bias[k], s * scale[loop.row + k] * reference_.loops[l].bias[k], 1e-10);
    }
  }
}

TEST_P(EveryTreeInScrews, HasTheSameForces) {
  SetPose(SomePose());
  SetMotion(v_, vdot_.data());
  GyroscopicWrenches(tree_, inertias_, &ws_);
  VectorXd tau(tree_.nv), expected(tree_.nv);
  NewtonEuler(tree_, inertias_, &ws_, tau.data());
  const std::vector<Wrenchd> none(tree_.nodes.size());
  RecursiveNewtonEuler<double>(tree_, tree_.mechanism.gravity_W, none.data(), &reference_);
  GeneralisedForces(tree_, reference_, expected.data());
  EXPECT_LE((tau - expected).norm(), kIdentity * expected.norm());
  for (size_t i = 0; i < tree_.nodes.size(); ++i) {
    const ScrewWorkspace::Node& node = ws_.at(static_cast<int>(i));
    const Wrenchd& F_Bo = reference_.nodes[i].F_Bo;
    const Vector3d moment = Vector3Of(node.F.angular - Cross(node.X.p, node.F.linear));
    EXPECT_LE((Vector3Of(node.F.linear) - F_Bo.force).norm(), 1e-10);
    EXPECT_LE((moment - F_Bo.moment).norm(), 1e-10);
  }
}

TEST_P(EveryTreeInScrews, HasTheSameMassMatrixAndMomenta) {
  const VectorXd q = SomePose();
  SetPose(q);
  MatrixXd M = MatrixXd::Zero(tree_.nv, tree_.nv);
  CompositeMassMatrix(tree_, ws_, &inertias_, &M);
  const MatrixXd expected = MassMatrix(tree_, q);
  EXPECT_LE((M - expected).norm(), kIdentity * expected.norm());
  VectorXd momenta(tree_.nv);
  Momenta(tree_, inertias_, v_.data(), &ws_, momenta.data());
  EXPECT_LE((momenta - expected * v_).norm(), kIdentity * momenta.norm());
  const double energy = 0.5 * v_.dot(expected * v_);
  EXPECT_NEAR(KineticEnergy(tree_, inertias_, ws_), energy, kIdentity * energy);
}

INSTANTIATE_TEST_SUITE_P(Examples, EveryTreeInScrews, testing::ValuesIn(ExampleNames()),
                         [](const auto& info) { return TestName(info.param); });

/// Every type of joint where the loop is cut, which the examples do not have all.
class EveryCutJoint : public testing::TestWithParam<int> {};

TEST_P(EveryCutJoint, HasTheSameRows) {
  Mechanism linkage = Example("rssr");
  const int last = static_cast<int>(linkage.joints.size()) - 1;
  Joint& cut = linkage.joints[last];
  cut = MakeJoint(cut.name, static_cast<JointType>(GetParam()), cut.first, cut.second);
  cut.pitch = cut.type == JointType::kScrew ? 0.3 : 0;
  SpanningTreeOptions options;
  options.cut = {last};
  const KinematicTree tree = BuildKinematicTree(linkage, options);
  ASSERT_EQ(tree.loops.at(0).type, cut.type);
  Random random(5);
  const VectorXd q = RandomCoordinates(tree, &random);
  TreeWorkspace<double> reference(tree);
  ForwardKinematics(tree, q.data(), &reference);
  LoopErrors(tree, &reference);
  LoopJacobian(tree, &reference);
  GraspedMechanism pose(tree, GraspFrame{});
  pose.Set(q);
  const VectorXd scale = LoopRowScale(tree);
  const MatrixXd C = scale.asDiagonal() * DenseLoopJacobian(tree, reference);
  const VectorXd e2 = scale.cwiseProduct(StackedLoopErrors(tree, reference));
  EXPECT_LE((pose.C().topRows(tree.rows) - C).norm(), kIdentity * C.norm());
  EXPECT_LE((pose.e2().head(tree.rows) - e2).norm(), kIdentity * e2.norm());
}

INSTANTIATE_TEST_SUITE_P(Types, EveryCutJoint,
                         testing::Range(0, static_cast<int>(JointType::kWeld) + 1));

}  // namespace
}  // namespace vmech
