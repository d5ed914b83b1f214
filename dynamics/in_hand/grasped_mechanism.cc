#include "vmech/dynamics/in_hand/grasped_mechanism.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "vmech/base/linear_algebra/small_ldlt.h"
#include "vmech/base/screw_algebra.h"
#include "vmech/kinematics/loops/dimensionless_loops.h"
#include "vmech/kinematics/loops/loops.h"
#include "vmech/kinematics/tree/validity.h"

namespace vmech {
namespace {

bool IsSame(const GraspFrame& a, const GraspFrame& b) noexcept {
  return a.node == b.node && a.X_BG.R == b.X_BG.R && a.X_BG.p == b.X_BG.p;
}

}  // namespace

GraspedMechanism::GraspedMechanism(const KinematicTree& tree, std::span<const GraspFrame> grasps)
    : tree_(tree),
      gravity_W_(tree.mechanism.gravity_W),
      row_scale_(BindingRowScale(tree)),
      ws_(tree),
      inertias_(tree),
      joints_(tree.mechanism.joints.size()),
      C_(MatrixXd::Zero(PaddedSize(tree.rows), tree.nv)),
      e2_(VectorXd::Zero(C_.rows())) {
  for (const GraspFrame& grasp : grasps) {
    RequireNode("grasp.node", tree, grasp.node);
    grasps_.push_back({grasp, {}, std::vector<Screw>(static_cast<size_t>(tree.nv))});
  }
  SetGravity(gravity_W_, &ws_);
}

void GraspedMechanism::ChangeDesign(const HeldDesign& from, const HeldDesign& to) noexcept {
  for (size_t i = 0; i < grasps_.size(); ++i) {
    GraspFrame& frame = grasps_[i].frame;
    const auto node = static_cast<size_t>(frame.node);
    if (i < from.grasps.size() && IsSame(frame, from.grasps[i])) {
      frame = to.grasps[i];
    } else if (frame.node >= 0) {
      const Posed &before = from.tree.nodes[node].X_BL, &after = to.tree.nodes[node].X_BL;
      frame.X_BG = after * before.inverse() * frame.X_BG;
    }
  }
  ws_.Take(tree_, to.tree);
  inertias_.Take(to.tree);
  gravity_W_ = to.gravity_W;
  SetGravity(gravity_W_, &ws_);
}

void GraspedMechanism::Set(const VectorXd& q) noexcept {
  SetLoops(q);
  SetJacobians();
}

void GraspedMechanism::Set(const TreeWorkspace<double>& at_q) noexcept {
  for (size_t i = 0; i < ws_.nodes.size(); ++i) ws_.nodes[i].X = at_q.nodes[i].X;
  std::copy(at_q.S.begin(), at_q.S.end(), ws_.S.begin());
  std::copy(at_q.loops.begin(), at_q.loops.end(), ws_.loops.begin());
  ScaleLoopErrors();
  SetJacobians();
}

void GraspedMechanism::SetLoops(const VectorXd& q) noexcept {
  ForwardKinematics(tree_, q.data(), &ws_);
  LoopErrors(tree_, &ws_);
  ScaleLoopErrors();
}

void GraspedMechanism::ScaleLoopErrors() noexcept {
  for (size_t l = 0; l < tree_.loops.size(); ++l) {
    const Loop& loop = tree_.loops[l];
    const Vector6d& e2 = ws_.loops[l].e2;
    for (int k = 0; k < loop.rows; ++k) e2_[loop.row + k] = row_scale_[loop.row + k] * e2[k];
  }
}

void GraspedMechanism::SetJacobians() noexcept {
  BodyInertias(tree_, ws_, &inertias_);
  for (Grasped& grasp : grasps_) {
    grasp.G = ws_.at(grasp.frame.node).X * grasp.frame.X_BG;
    GraspJacobian(tree_, ws_, grasp.frame.node, grasp.G, &grasp.J);
  }
  LoopWrenches(tree_, row_scale_.data(), &ws_);
  for (size_t l = 0; l < tree_.loops.size(); ++l) {
    const Loop& loop = tree_.loops[l];
    for (const LoopColumn& c : loop.columns) {
      const Screw S = c.sign * ws_.S[c.v];
      double* column = &C_(loop.row, c.v);
      for (int k = 0; k < loop.rows; ++k) column[k] = Power(ws_.loops[l].wrench[k], S);
    }
  }
}

Frame GraspedMechanism::InWorld(const Frame& G) const noexcept {
  return {G.x, G.y, G.z, G.p + Double4Of(ws_.reference)};
}

Frame GraspedMechanism::grasp_frame(int hand) const noexcept {
  return InWorld(grasps_[hand].G);
}

Frame GraspedMechanism::FindGraspFrame(int hand) const noexcept {
  const GraspFrame& frame = grasps_[hand].frame;
  return InWorld(ws_.at(frame.node).X * frame.X_BG);
}

Posed GraspedMechanism::X_WG(int hand) const noexcept {
  return PoseOf(grasp_frame(hand));
}

Matrix6Xd GraspedMechanism::J() const {
  Matrix6Xd J(6, tree_.nv);
  for (int v = 0; v < tree_.nv; ++v) J.col(v) = Vector6Of(grasps_[0].J[v]);
  return J;
}

void GraspedMechanism::ComputeWeightedJacobian(const Screw& root, MatrixXd* B,
                                               int hand) const noexcept {
  const std::vector<Screw>& J = grasps_[hand].J;
  for (int i = 0; i < tree_.nv; ++i) {
    const Screw column = Scaled(root, J[i]);
    StoreDouble4(column.linear, &(*B)(0, i));
    StoreDouble4(column.angular, &(*B)(4, i));
  }
}

Posed GraspedMechanism::X_WB(int node) const noexcept {
  return PoseInWorld(ws_, node, {});
}

Screw GraspedMechanism::Twist(const VectorXd& v, int hand) const noexcept {
  const std::vector<Screw>& J = grasps_[hand].J;
  Screw V;
  for (int i = 0; i < tree_.nv; ++i) V += v[i] * J[i];
  return V;
}

void GraspedMechanism::AddForces(const Screw& w, VectorXd* tau, int hand) const noexcept {
  const std::vector<Screw>& J = grasps_[hand].J;
  for (int i = 0; i < tree_.nv; ++i) (*tau)[i] += Power(w, J[i]);
}

void GraspedMechanism::ComputeMassMatrix(MatrixXd* M) noexcept {
  CompositeMassMatrix(tree_, ws_, &inertias_, M);
}

void GraspedMechanism::SetVelocities(const VectorXd& v) noexcept {
  ForwardVelocities(tree_, v.data(), &ws_);
}

void GraspedMechanism::ComputeVelocityProducts() noexcept {
  VelocityProducts(tree_, &ws_);
  has_forces_ = false;
}

void GraspedMechanism::ComputeMomenta(const VectorXd& v, VectorXd* momenta) noexcept {
  has_forces_ = false;
  Momenta(tree_, inertias_, v.data(), &ws_, momenta->data());
}

void GraspedMechanism::ComputeLoopBias(double s, VectorXd* d) noexcept {
  ComputeVelocityProducts();
  for (size_t l = 0; l < tree_.loops.size(); ++l) {
    LoopBias(tree_, ws_, static_cast<int>(l), s, d->data() + tree_.loops[l].row);
  }
}

Screw GraspedMechanism::GraspBias() const noexcept {
  const Grasped& grasp = grasps_[0];
  const TreeWorkspace<double>::Node& node = ws_.at(grasp.frame.node);
  const Screw A = node.A - ws_.at(-1).A;
  const Double4 a = VelocityAt(grasp.G.p, A) + Cross(node.V.angular, VelocityAt(grasp.G.p, node.V));
  return {a, A.angular};
}

void GraspedMechanism::SetAccelerations(const VectorXd& vdot) noexcept {
  ForwardAccelerations(tree_, vdot.data(), &ws_);
  has_forces_ = false;
}

void GraspedMechanism::ComputeForces(VectorXd* tau) noexcept {
  GyroscopicWrenches(tree_, inertias_, &ws_);
  NewtonEuler<double>(tree_, inertias_, nullptr, &ws_, tau->data());
  has_forces_ = true;
}

void GraspedMechanism::LoadJoints(std::span<const Screw> w, const VectorXd& mu,
                                  std::vector<Wrenchd>* joints) noexcept {
  StartLoads(w);
  for (size_t l = 0; l < tree_.loops.size(); ++l) {
    const Loop& loop = tree_.loops[l];
    Screw W;
    for (int k = 0; k < loop.rows; ++k) W -= mu[loop.row + k] * ws_.loops[l].wrench[k];
    LoadLoop(loop, W);
  }
  FinishLoads(joints);
}

void GraspedMechanism::LoadJoints(std::span<const Screw> w, const std::vector<Screw>& cut,
                                  std::vector<Wrenchd>* joints) noexcept {
  StartLoads(w);
  for (size_t l = 0; l < tree_.loops.size(); ++l) {
    LoadLoop(tree_.loops[l], WrenchAt(ws_.loops[l].F.p, cut[l].linear, cut[l].angular));
  }
  FinishLoads(joints);
}

void GraspedMechanism::StartLoads(std::span<const Screw> w) noexcept {
  if (!has_forces_) NewtonEuler<double>(tree_, inertias_, nullptr, &ws_, nullptr);
  has_forces_ = false;
  for (size_t i = 0; i < grasps_.size(); ++i) {
    const Grasped& grasp = grasps_[i];
    ApplyAlongBranch(tree_, grasp.frame.node, WrenchAt(grasp.G.p, w[i].linear, w[i].angular), &ws_);
  }
}

void GraspedMechanism::LoadLoop(const Loop& loop, const Screw& W) noexcept {
  ApplyAroundLoop(loop, W, &ws_);
  joints_[loop.joint].W = W;
}

void GraspedMechanism::FinishLoads(std::vector<Wrenchd>* joints) noexcept {
  TreeJointWrenches(tree_, ws_, &joints_);
  JointFrames(tree_, ws_, &joints_);
  for (size_t j = 0; j < joints->size(); ++j) {
    (*joints)[j] = WrenchIn(joints_[j].F, joints_[j].W);
  }
}

void GraspedMechanism::ComputeCutRows(int loop, MatrixXd* B) const noexcept {
  B->setZero();
  const Double4& p = ws_.loops[loop].F.p;
  for (const LoopColumn& c : tree_.loops[loop].columns) {
    const Screw S = c.sign * ws_.S[c.v];
    StoreDouble4(VelocityAt(p, S), &(*B)(0, c.v));
    StoreDouble4(S.angular, &(*B)(4, c.v));
  }
}

Screw GraspedMechanism::CutTwist(int loop, const VectorXd& v) const noexcept {
  Screw V;
  for (const LoopColumn& c : tree_.loops[loop].columns) V += (c.sign * v[c.v]) * ws_.S[c.v];
  return {VelocityAt(ws_.loops[loop].F.p, V), V.angular};
}

double GraspedMechanism::KineticEnergy() const noexcept {
  return vmech::KineticEnergy(tree_, inertias_, ws_);
}

}  // namespace vmech
