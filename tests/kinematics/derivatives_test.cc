// Jacobians, velocities and accelerations of every example against central differences of poses.

#include <gtest/gtest.h>

#include "support/examples.h"
#include "vmech/kinematics/loops/closure.h"
#include "vmech/kinematics/loops/loops.h"
#include "vmech/kinematics/tree/forward_kinematics.h"
#include "vmech/kinematics/tree/jacobian.h"

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
  PointJacobian(tree_, ws_, node, X_WQ.p, &J);
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
    return PointTwist(ws_, node, ws_.nodes[node].X_WB.p);
  };
  const Vector6d slope = (twist(kStep) - twist(-kStep)) / (2 * kStep);
  twist(0);
  ForwardAccelerations(tree_, v.data(), vdot.data(), &ws_);
  const Vector6d A = PointAcceleration(ws_, node, ws_.nodes[node].X_WB.p);
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
  ForwardAccelerations<double>(tree_, v.data(), nullptr, &ws_);
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

}  // namespace
}  // namespace vmech
