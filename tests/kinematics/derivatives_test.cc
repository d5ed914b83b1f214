// Jacobians, velocities and accelerations of every example against central differences of poses.

#include <gtest/gtest.h>

#include "support/examples.h"
#include "vmech/kinematics/loops/closure.h"
#include "vmech/kinematics/loops/loops.h"
#include "vmech/kinematics/tree/forward_kinematics.h"

namespace vmech {
namespace {

constexpr double kStep = 1e-5;
constexpr double kDifference = 2e-8;  // of a central difference with this step, motions of order 1

class EveryExample : public testing::TestWithParam<std::string> {
 protected:
  EveryExample() : tree_(BuildKinematicTree(Example(GetParam()))), ws_(tree_) {}

  VectorXd Moved(const VectorXd& q, const VectorXd& v, double t) const {
    VectorXd moved = q;
    MoveCoordinates(tree_, t * v, &moved);
    return moved;
  }

  KinematicTree tree_;
  TreeWorkspace<double> ws_;
  Random random_{7};
};

TEST_P(EveryExample, JacobianIsTheDerivativeOfThePose) {
  const VectorXd q = RandomCoordinates(tree_, &random_);
  const int node = static_cast<int>(tree_.nodes.size()) - 1;
  const Posed X_BQ{Matrix3d::Identity(), Vector3d(0.1, -0.2, 0.3)};
  const VectorXd v = random_.Vector(tree_.nv);
  EvaluatePose(tree_, q, &ws_);
  const Posed X_WQ = PoseInWorld(ws_, node, X_BQ);
  Matrix6Xd J(6, tree_.nv);
  GraspJacobian(tree_, ws_, node, X_BQ, &J);
  auto pose = [&](double t) {
    EvaluatePose(tree_, Moved(q, v, t), &ws_);
    return PoseInWorld(ws_, node, X_BQ);
  };
  const Posed ahead = pose(kStep), behind = pose(-kStep);
  const Vector3d linear = (ahead.p - behind.p) / (2 * kStep);
  const Matrix3d W = (ahead.R - behind.R) / (2 * kStep) * X_WQ.R.transpose();
  const Vector6d V = J * v;
  EXPECT_LT((linear - V.head<3>()).norm(), kDifference * (1 + linear.norm()));
  EXPECT_LT((W - CrossMatrix<double>(V.tail<3>())).norm(), kDifference * (1 + V.norm()));
}

TEST_P(EveryExample, LoopJacobianIsTheDerivativeOfTheLoopErrorsWhenClosed) {
  VectorXd q = StartCoordinates(tree_);
  ASSERT_TRUE(Assemble(tree_, {}, &q).closed);
  EvaluatePose(tree_, q, &ws_);
  const MatrixXd C = DenseLoopJacobian(tree_, ws_);
  for (int k = 0; k < tree_.nv; ++k) {
    const VectorXd v = VectorXd::Unit(tree_.nv, k);
    EvaluatePose(tree_, Moved(q, v, kStep), &ws_);
    const VectorXd ahead = StackedLoopErrors(tree_, ws_);
    EvaluatePose(tree_, Moved(q, v, -kStep), &ws_);
    const VectorXd slope = (ahead - StackedLoopErrors(tree_, ws_)) / (2 * kStep);
    EXPECT_LT((slope + C.col(k)).norm(), kDifference * (1 + slope.norm()))
        << NameOfVelocity(tree_, k);
  }
}

TEST_P(EveryExample, AccelerationIsTheDerivativeOfTheTwist) {
  const VectorXd q = RandomCoordinates(tree_, &random_);
  const VectorXd v = random_.Vector(tree_.nv), vdot = random_.Vector(tree_.nv);
  const int node = static_cast<int>(tree_.nodes.size()) - 1;
  auto twist = [&](double t) -> Vector6d {
    // Along q(t) = q (+) (v t + vdot t^2/2), whose velocity at small t is v + vdot t.
    VectorXd moved = q;
    MoveCoordinates(tree_, v * t + vdot * (t * t / 2), &moved);
    EvaluatePose(tree_, moved, &ws_, false);
    const VectorXd rate = v + vdot * t;
    ForwardVelocities(tree_, rate.data(), &ws_);
    return GraspTwist(ws_, node, {});
  };
  const Vector6d slope = (twist(kStep) - twist(-kStep)) / (2 * kStep);
  twist(0);
  VelocityProducts(tree_, &ws_);
  ForwardAccelerations(tree_, vdot.data(), &ws_);
  const Vector6d A = GraspAcceleration(ws_, node, {});
  EXPECT_LT((slope - A).norm(), kDifference * (1 + A.norm()));
}

TEST_P(EveryExample, LoopBiasIsTheDerivativeOfTheLoopVelocity) {
  VectorXd q = StartCoordinates(tree_);
  ASSERT_TRUE(Assemble(tree_, {}, &q).closed);
  if (tree_.loops.empty()) return;
  // Along a motion that keeps the loops closed, C v = 0 at all times: bias = -C v'.
  EvaluatePose(tree_, q, &ws_);
  const MatrixXd C = DenseLoopJacobian(tree_, ws_);
  // A free motion: what random velocities leave after their loop-opening part is taken off.
  const VectorXd w = random_.Vector(tree_.nv);
  const VectorXd v = w - C.completeOrthogonalDecomposition().solve(C * w);
  ForwardVelocities(tree_, v.data(), &ws_);
  VelocityProducts(tree_, &ws_);
  LoopAccelerationBias(tree_, &ws_);
  VectorXd bias(tree_.rows);
  for (size_t l = 0; l < tree_.loops.size(); ++l) {
    bias.segment(tree_.loops[l].row, tree_.loops[l].rows) =
        ws_.loops[l].bias.head(tree_.loops[l].rows);
  }
  // e2 along q (+) v t is -(bias) t^2/2 to second order, because C v = 0.
  constexpr double kLong = 1e-4;
  auto errors = [&](double t) {
    EvaluatePose(tree_, Moved(q, v, t), &ws_);
    return StackedLoopErrors(tree_, ws_);
  };
  const VectorXd second = (errors(kLong) + errors(-kLong) - 2 * errors(0)) / (kLong * kLong);
  constexpr double kSecondDifference = 1e-6;  // roundoff 1e-16 / step^2, and step^2
  EXPECT_LT((second + bias).norm(), kSecondDifference * (1 + bias.norm()));
}

INSTANTIATE_TEST_SUITE_P(Examples, EveryExample, testing::ValuesIn(ExampleNames()),
                         [](const auto& info) { return TestName(info.param); });

/// Every type of joint where the loop is cut, which the examples do not have all.
class EveryCutJoint : public testing::TestWithParam<int> {};

TEST_P(EveryCutJoint, HasTheEquationsShareOfTheAnchorsRelativeTwist) {
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
  TreeWorkspace<double> ws(tree);
  EvaluatePose(tree, q, &ws);
  const JointPlacement& place = tree.placements[last];
  const Posed X_WF = PoseInWorld(ws, place.first_node, place.X_AF);
  const Posed X_WM = PoseInWorld(ws, place.second_node, place.X_BM);
  // The point of the first link that is at M now.
  const Posed X_AM = PoseInWorld(ws, place.first_node, {}).inverse() * X_WM;
  Matrix6Xd J_A(6, tree.nv), J_B(6, tree.nv);
  GraspJacobian(tree, ws, place.first_node, X_AM, &J_A);
  GraspJacobian(tree, ws, place.second_node, place.X_BM, &J_B);
  const MatrixXd C = DenseLoopJacobian(tree, ws);
  for (int v = 0; v < tree.nv; ++v) {
    const Vector6d V = J_B.col(v) - J_A.col(v);
    const Vector6d expected =
        ProjectOnRows<double>(tree.loops[0], ws.loops[0], X_WF.R.transpose() * V.head<3>(),
                              X_WF.R.transpose() * V.tail<3>());
    EXPECT_LE((C.col(v) - expected.head(tree.rows)).norm(), 1e-12 * (1 + expected.norm()));
  }
}

INSTANTIATE_TEST_SUITE_P(Types, EveryCutJoint,
                         testing::Range(0, static_cast<int>(JointType::kWeld) + 1));

}  // namespace
}  // namespace vmech
