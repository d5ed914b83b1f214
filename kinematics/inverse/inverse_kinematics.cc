#include "vmech/kinematics/inverse/inverse_kinematics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "vmech/base/screw_algebra.h"
#include "vmech/kinematics/loops/dimensionless_loops.h"
#include "vmech/kinematics/loops/loop_derivatives.h"
#include "vmech/kinematics/loops/loops.h"
#include "vmech/kinematics/tree/forward_kinematics.h"
#include "vmech/kinematics/tree/grasp_rows.h"
#include "vmech/kinematics/tree/validity.h"
#include "vmech/mechanisms/validity.h"

namespace vmech {
namespace {

ProblemSizes SizesOf(const KinematicTree& tree, const GraspFrame& grasp) {
  return {tree.nq, tree.nv, grasp.kind == GraspKind::kPoint ? 3 : 6, tree.rows};
}

std::vector<Bound> BoundsOf(const KinematicTree& tree, const InverseKinematicsOptions& options) {
  std::vector<Bound> bounds;
  if (!options.joint_limits) return bounds;
  for (const TreeNode& node : tree.nodes) {
    if (node.v < 0 || node.motion == NodeMotion::kSpherical) continue;
    const Joint& joint = tree.mechanism.joints[node.joint];
    const double lower = joint.lower[node.freedom], upper = joint.upper[node.freedom];
    if (std::isfinite(lower) || std::isfinite(upper)) {
      bounds.push_back({node.q, node.v, lower, upper});
    }
  }
  return bounds;
}

Vector6d EffectiveStiffness(const Vector6d& given, GraspKind kind, double length) {
  Vector6d K = given;
  if (K.isZero(0)) {
    K.head<3>().setOnes();
    K.tail<3>().setConstant(length * length);
  }
  return RowsThatCount(K, kind);
}

double MeanOfPositive(const Vector3d& values) {
  const double count = static_cast<double>((values.array() > 0).count());
  return count > 0 ? values.sum() / count : 0;
}

double EnergyScale(const Vector6d& K, double length) {
  const double translational = MeanOfPositive(K.head<3>());
  if (translational > 0) return translational * length * length;
  return MeanOfPositive(K.tail<3>());
}

/// The rows of a column that there are: all six, or three of a point grasp.
void StoreRows(const Screw& a, int rows, double* column) {
  std::memcpy(column, &a.linear, 3 * sizeof(double));
  if (rows == 6) std::memcpy(column + 3, &a.angular, 3 * sizeof(double));
}

int VelocitiesOf(const TreeNode& node) {
  return node.v < 0 ? 0 : node.motion == NodeMotion::kSpherical ? 3 : 1;
}

}  // namespace

void InverseKinematicsOptions::Validate() const {
  for (int i = 0; i < 6; ++i) {
    if (stiffness[i] >= 0 && std::isfinite(stiffness[i])) continue;
    throw std::invalid_argument(
        fmt::format("InverseKinematicsOptions: stiffness[{}] is {}; it must be finite and >= 0", i,
                    stiffness[i]));
  }
}

InverseKinematics::InverseKinematics(const KinematicTree& tree, const GraspFrame& grasp,
                                     const InverseKinematicsOptions& options)
    : ConstrainedLeastSquares(SizesOf(tree, grasp), BoundsOf(tree, options)),
      tree_(tree),
      grasp_(grasp),
      rotation_error_(options.rotation_error),
      row_scale_(BindingRowScale(tree)),
      angular_(tree.nv),
      linear_(tree.nv),
      q_(VectorXd::Constant(tree.nq, std::numeric_limits<double>::quiet_NaN())),
      ws_(tree) {
  options.Validate();
  RequireNode("InverseKinematics: grasp.node", tree, grasp.node);
  K_ = EffectiveStiffness(options.stiffness, grasp.kind, tree.length);
  energy_ = EnergyScale(K_, tree.length);
  if (!(energy_ > 0)) {
    throw std::invalid_argument(
        "InverseKinematicsOptions: the stiffness leaves no row of the hand's error; a point grasp "
        "needs stiffness along x, y or z");
  }
  root_ = (K_ / energy_).cwiseSqrt();
  for (int n = grasp.node; n >= 0; n = tree.nodes[n].parent) {
    const TreeNode& node = tree.nodes[n];
    for (int k = 0; k < VelocitiesOf(node); ++k) grasp_chain_.push_back({n, node.v + k, k, 1});
  }
  std::reverse(grasp_chain_.begin(), grasp_chain_.end());
  for (const Loop& loop : tree.loops) {
    // From F down its branch, then up that of M: columns are in the order of nodes.
    Chain chain, up;
    for (const LoopColumn& c : loop.columns) {
      (c.sign > 0 ? up : chain).push_back({c.node, c.v, c.axis, c.sign});
    }
    std::reverse(chain.begin(), chain.end());
    chain.insert(chain.end(), up.begin(), up.end());
    loop_chains_.push_back(std::move(chain));
  }
}

void InverseKinematics::Evaluate(const VectorXd& q, VectorXd* r, MatrixXd* J, VectorXd* c,
                                 MatrixXd* C) {
  MoveTo(q);
  if (r || J) EvaluateGrasp(r, J);
  if (c || C) EvaluateLoops(c, C);
}

// Solvers ask for values and derivatives at one point in two calls, and start where they ended.
void InverseKinematics::MoveTo(const VectorXd& q) {
  if (std::equal(q.data(), q.data() + tree_.nq, q_.data())) return;
  q_ = q;
  ForwardKinematics(tree_, q.data(), &ws_);
  LoopErrors(tree_, &ws_);
}

// Columns are written as they are in memory: Eigen's expressions of unknown size cost more than
// what they compute.
void InverseKinematics::EvaluateGrasp(VectorXd* r, MatrixXd* J) {
  const Frame G = GraspInTree(), H = TargetInTree();
  const Screw root = ScrewOf(root_), e1 = vmech::HandError(rotation_error_, G, H);
  const int rows = sizes().residuals;
  if (r) StoreRows(Scaled(root, e1), rows, r->data());
  if (!J) return;
  const Matrix3d A = RotationErrorJacobian(rotation_error_, G, H, Vector3Of(e1.angular));
  const Frame columns = FrameOf(Posed{A, Vector3d::Zero()});
  std::fill_n(J->data(), J->size(), 0.0);
  for (const ChainVelocity& c : grasp_chain_) {
    const Screw& S = ws_.S[c.v];
    const Screw fall = {-VelocityAt(G.p, S), Rotate(columns, S.angular)};
    StoreRows(Scaled(root, fall), rows, J->data() + c.v * rows);
  }
}

void InverseKinematics::EvaluateLoops(VectorXd* c, MatrixXd* C) {
  if (C) std::fill_n(C->data(), C->size(), 0.0);
  for (size_t l = 0; l < tree_.loops.size(); ++l) {
    const Loop& loop = tree_.loops[l];
    LoopState<double>& s = ws_.loops[l];
    const double* scale = row_scale_.data() + loop.row;
    for (int k = 0; c && k < loop.rows; ++k) (*c)[loop.row + k] = scale[k] * s.e2[k];
    if (!C) continue;
    FindLoopWrenches(loop, Rotate(s.F, Matrix3d(LoopRotationJacobian(loop, s).transpose()), s.F.p),
                     &s);
    for (int k = 0; k < loop.rows; ++k) s.wrench[k] = scale[k] * s.wrench[k];
    for (const LoopColumn& column : loop.columns) {
      const Screw S = -column.sign * ws_.S[column.v];
      double* C_v = C->data() + column.v * tree_.rows + loop.row;
      for (int k = 0; k < loop.rows; ++k) C_v[k] = Power(s.wrench[k], S);
    }
  }
}

/// About the tree's reference point, like all that follow.
Frame InverseKinematics::GraspInTree() const {
  return ws_.at(grasp_.node).X * grasp_.X_BG;
}

Frame InverseKinematics::TargetInTree() const {
  return FrameOf(Posed{X_WH_.R, X_WH_.p - ws_.reference});
}

void InverseKinematics::Plus(const VectorXd& q, const VectorXd& dq, VectorXd* q_plus) const {
  if (q_plus != &q) *q_plus = q;
  MoveCoordinates(tree_, dq, q_plus);
}

void InverseKinematics::Curvature(const VectorXd& q, const VectorXd& mu, MatrixXd* S) {
  MoveTo(q);
  S->setZero();
  AddGraspCurvature(S);
  for (size_t l = 0; l < tree_.loops.size(); ++l) AddLoopCurvature(static_cast<int>(l), mu, S);
}

void InverseKinematics::AddGraspCurvature(MatrixXd* S) {
  const Frame G = GraspInTree(), H = TargetInTree();
  // r_i d2r_i = (K/E e1)_i d2e1_i, and e1 falls as G moves.
  CurvatureWeights weights;
  weights.f = -(K_ / energy_).head<3>().cwiseProduct(Vector3Of(Double4(H.p - G.p)));
  weights.g.setZero();
  weights.G.setZero();
  if (grasp_.kind == GraspKind::kRigid) {
    const Matrix3d R_E = X_WH_.R * RotationOf(G).transpose();
    const Vector3d e = RotationErrorOf(rotation_error_, R_E);
    const Vector3d pull = (K_ / energy_).tail<3>().cwiseProduct(e);
    weights.g = RotationErrorJacobian(rotation_error_, R_E, e).transpose() * pull;
    weights.G = RotationErrorCurvature(rotation_error_, R_E, e, pull);
  }
  UnitTwists(grasp_chain_, {.p = G.p});
  AddChainCurvature(grasp_chain_, weights, S);
}

void InverseKinematics::AddLoopCurvature(int l, const VectorXd& mu, MatrixXd* S) {
  const Loop& loop = tree_.loops[l];
  const LoopState<double>& s = ws_.loops[l];
  // c falls as M moves on in F: e2 = -(displacement).
  Vector6d w = Vector6d::Zero();
  w.head(loop.rows) =
      -mu.segment(loop.row, loop.rows).cwiseProduct(row_scale_.segment(loop.row, loop.rows));
  const Wrenchd wrench = WrenchOfMultipliers(loop, s, w.data());
  UnitTwists(loop_chains_[l], s.F);
  AddChainCurvature(loop_chains_[l],
                    {wrench.force, LoopRotationJacobian(loop, s).transpose() * wrench.moment,
                     LoopRotationCurvature(loop, s, w.data())},
                    S);
}

/// About the origin and in the axes of X.
void InverseKinematics::UnitTwists(const Chain& chain, const Frame& X) {
  for (size_t i = 0; i < chain.size(); ++i) {
    const Screw S = chain[i].sign * ws_.S[chain[i].v];
    angular_[i] = Vector3Of(InverseRotate(X, S.angular));
    linear_[i] = Vector3Of(InverseRotate(X, VelocityAt(X.p, S)));
  }
}

// With i nearer to the fixed end than j (exp of the product: Baker-Campbell-Hausdorff to order 2):
//   d2p/dq_i dq_j = w_i x v_j,   d2eta/dq_i dq_j = 1/2 w_i x w_j;
// the freedoms of one spherical joint move together, exp(sum), which makes both symmetric.
void InverseKinematics::AddChainCurvature(const Chain& chain, const CurvatureWeights& weights,
                                          MatrixXd* S) const {
  for (size_t i = 0; i < chain.size(); ++i) {
    const Vector3d f_x_w = weights.f.cross(angular_[i]);  // f . (w x v) = (f x w) . v
    const Vector3d g_x_w = 0.5 * weights.g.cross(angular_[i]);
    const Vector3d G_w = weights.G * angular_[i];
    for (size_t j = i; j < chain.size(); ++j) {
      double value = G_w.dot(angular_[j]);
      if (chain[i].node == chain[j].node) {
        value += 0.5 * (f_x_w.dot(linear_[j]) + weights.f.cross(angular_[j]).dot(linear_[i]));
      } else {
        value += f_x_w.dot(linear_[j]) + g_x_w.dot(angular_[j]);
      }
      (*S)(chain[i].v, chain[j].v) += value;
      if (i != j) (*S)(chain[j].v, chain[i].v) += value;
    }
  }
}

Posed InverseKinematics::GraspPose(const VectorXd& q) {
  MoveTo(q);
  return PoseInWorld(ws_, grasp_.node, grasp_.X_BG);
}

Vector6d InverseKinematics::HandError(const VectorXd& q) {
  const Posed X_WG = GraspPose(q);
  Vector6d e1;
  e1 << X_WH_.p - X_WG.p, RotationErrorOf(rotation_error_, X_WH_.R * X_WG.R.transpose());
  return e1;
}

Vector6d InverseKinematics::HandWrench(const VectorXd& q) {
  return K_.cwiseProduct(HandError(q));
}

VectorXd InverseKinematics::LoopError(const VectorXd& q) {
  MoveTo(q);
  return StackedLoopErrors(tree_, ws_);
}

VectorXd InverseKinematics::LoopMultipliers(const VectorXd& mu) const {
  return energy_ * row_scale_.cwiseProduct(mu);
}

}  // namespace vmech
