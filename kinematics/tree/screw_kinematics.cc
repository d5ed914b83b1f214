#include "vmech/kinematics/tree/screw_kinematics.h"

#include <algorithm>

#include "vmech/base/screw_algebra.h"
#include "vmech/kinematics/loops/loops.h"
#include "vmech/kinematics/tree/forward_kinematics.h"

namespace vmech {
namespace {

/// X Rz.
Axes TurnedAboutZ(const Axes& X, double sine, double cosine) {
  return {cosine * X.x + sine * X.y, cosine * X.y - sine * X.x, X.z, X.p};
}

/// A turn of 1 rad/s.
Screw AxisThrough(const Four& p_WQ, const Four& axis) {
  return {Cross(p_WQ, axis), axis};
}

/// Of a node in its parent, at the joints' rates v.
Screw JointTwist(const TreeNode& node, const double* v, const ScrewWorkspace& ws) {
  if (node.v < 0) return {};
  Screw V = v[node.v] * ws.S[node.v];
  for (int k = 1; k < VelocitiesOf(node.motion); ++k) V += v[node.v + k] * ws.S[node.v + k];
  return V;
}

Screw ForceAlong(const Four& axis, const Four& p_WM) {
  return {axis, Cross(p_WM, axis)};
}

Screw MomentAbout(const Four& axis) {
  return {Four{}, axis};
}

/// Equations as ProjectOnRows lists them.
void FindRows(const Loop& loop, LoopScrews* s) {
  const Axes& F = s->F;
  Screw* row = s->rows;
  switch (loop.type) {
    case JointType::kRevolute:
    case JointType::kUniversal:
    case JointType::kSpherical:
    case JointType::kWeld:
      for (const Four* axis : {&F.x, &F.y, &F.z}) *row++ = ForceAlong(*axis, F.p);
      break;
    case JointType::kPrismatic:
    case JointType::kCylindrical:
    case JointType::kScrew:
      for (const Four* axis : {&F.x, &F.y}) *row++ = ForceAlong(*axis, F.p);
      break;
    case JointType::kPlanar:
      *row++ = ForceAlong(F.z, F.p);
      break;
  }
  switch (loop.type) {
    case JointType::kRevolute:
    case JointType::kCylindrical:
    case JointType::kPlanar:
    case JointType::kScrew:
      for (const Four* axis : {&F.x, &F.y}) *row++ = MomentAbout(*axis);
      break;
    case JointType::kPrismatic:
    case JointType::kWeld:
      for (const Four* axis : {&F.x, &F.y, &F.z}) *row++ = MomentAbout(*axis);
      break;
    case JointType::kUniversal:
      *row++ = MomentAbout(Turned(F, s->state.n_F));
      break;
    case JointType::kSpherical:
      break;
  }
  if (loop.type == JointType::kScrew) {
    *row = ForceAlong(F.z, F.p) - loop.pitch * MomentAbout(F.z);
  }
}

}  // namespace

ScrewWorkspace::ScrewWorkspace(const KinematicTree& tree)
    : nodes(tree.nodes.size() + 1),
      S(tree.nv),
      loops(tree.loops.size()),
      sine(PaddedSize(static_cast<int>(tree.turning.size()))),
      cosine(sine) {
  for (size_t i = 0; i < tree.nodes.size(); ++i) nodes[i + 1].X_PF = AxesOf(tree.nodes[i].X_PF);
}

void ForwardKinematics(const KinematicTree& tree, const double* q, ScrewWorkspace* ws) noexcept {
  Sines(tree, q, ws->sine.data(), ws->cosine.data());
  const double *sine = ws->sine.data(), *cosine = ws->cosine.data();
  Axes X;
  for (int i = 0; i < static_cast<int>(tree.nodes.size()); ++i) {
    const TreeNode& node = tree.nodes[i];
    if (node.parent != i - 1) X = ws->at(node.parent).X;  // else in registers
    const Axes& X_PF = ws->at(i).X_PF;
    Screw* S = ws->S.data() + node.v;
    // What does not depend on the parent first: a chain waits for each of its nodes.
    switch (node.motion) {
      case NodeMotion::kFixed:
        X = X * X_PF;
        break;
      case NodeMotion::kRevolute:
        X = X * TurnedAboutZ(X_PF, *sine++, *cosine++);
        *S = AxisThrough(X.p, X.z);
        break;
      case NodeMotion::kPrismatic:
        X = X * X_PF;
        X.p += q[node.q] * X.z;
        *S = {X.z, Four{}};
        break;
      case NodeMotion::kScrew:
        X = X * TurnedAboutZ(X_PF, *sine++, *cosine++);
        X.p += (node.pitch * q[node.q]) * X.z;
        *S = AxisThrough(X.p, X.z);
        S->linear += node.pitch * X.z;
        break;
      case NodeMotion::kSpherical: {
        const Matrix3d R_FM = RotationOf(q + node.q);
        const Axes F = X * X_PF;
        X = Turned(F, node.reversed ? Matrix3d(R_FM.transpose()) : R_FM, F.p);
        // Reversed, v is the rate of the parent in axes that are fixed there.
        const Axes M = node.reversed ? Axes{-F.x, -F.y, -F.z, F.p} : X;
        for (const Four* axis : {&M.x, &M.y, &M.z}) *S++ = AxisThrough(X.p, *axis);
        break;
      }
    }
    ws->at(i).X = X;
  }
}

void ForwardVelocities(const KinematicTree& tree, const double* v, ScrewWorkspace* ws) noexcept {
  Screw V;
  for (int i = 0; i < static_cast<int>(tree.nodes.size()); ++i) {
    const TreeNode& node = tree.nodes[i];
    if (node.parent != i - 1) V = ws->at(node.parent).V;
    V += JointTwist(node, v, *ws);
    ws->at(i).V = V;
  }
}

void VelocityProducts(const KinematicTree& tree, ScrewWorkspace* ws) noexcept {
  Screw A = ws->at(-1).A;
  for (int i = 0; i < static_cast<int>(tree.nodes.size()); ++i) {
    const ScrewWorkspace::Node& parent = ws->at(tree.nodes[i].parent);
    ScrewWorkspace::Node& s = ws->at(i);
    if (tree.nodes[i].parent != i - 1) A = parent.A;
    // Joint axes go with the parent, or with the node, which is the same: V_P x (V - V_P).
    s.c = CarriedTwist(parent.V, s.V);
    A += s.c;
    s.A = A;
  }
}

void ForwardAccelerations(const KinematicTree& tree, const double* vdot,
                          ScrewWorkspace* ws) noexcept {
  Screw A = ws->at(-1).A;
  for (int i = 0; i < static_cast<int>(tree.nodes.size()); ++i) {
    const TreeNode& node = tree.nodes[i];
    if (node.parent != i - 1) A = ws->at(node.parent).A;
    A += ws->at(i).c;
    A += JointTwist(node, vdot, *ws);
    ws->at(i).A = A;
  }
}

void PointJacobian(const KinematicTree& tree, const ScrewWorkspace& ws, int node, const Four& p_WQ,
                   std::vector<Screw>* J) noexcept {
  std::fill(J->begin(), J->end(), Screw{});
  for (int n = node; n >= 0; n = tree.nodes[n].parent) {
    const TreeNode& carrier = tree.nodes[n];
    for (int v = carrier.v; v < carrier.v + VelocitiesOf(carrier.motion); ++v) {
      const Screw& S = ws.S[v];
      (*J)[v] = {VelocityAt(p_WQ, S), S.angular};
    }
  }
}

void FillMatrix(const std::vector<Screw>& columns, Matrix6Xd* J) noexcept {
  for (size_t v = 0; v < columns.size(); ++v) J->col(v) = Vector6Of(columns[v]);
}

void LoopErrors(const KinematicTree& tree, ScrewWorkspace* ws) noexcept {
  for (size_t l = 0; l < tree.loops.size(); ++l) {
    const Loop& loop = tree.loops[l];
    const JointPlacement& place = tree.placements[loop.joint];
    LoopScrews& s = ws->loops[l];
    s.F = ws->at(place.first_node).X * place.X_AF;
    const Axes M = ws->at(place.second_node).X * place.X_BM;
    const Four p_FM = InverseRotate(s.F, M.p - s.F.p);
    const Axes R_FM{InverseRotate(s.F, M.x), InverseRotate(s.F, M.y), InverseRotate(s.F, M.z)};
    LoopError<double>(loop, RotationOf(R_FM), Vector3Of(p_FM), &s.state);
    s.F.p = M.p;
  }
}

void LoopWrenches(const KinematicTree& tree, const double* row_scale, ScrewWorkspace* ws) noexcept {
  for (size_t l = 0; l < tree.loops.size(); ++l) {
    const Loop& loop = tree.loops[l];
    LoopScrews& s = ws->loops[l];
    FindRows(loop, &s);
    for (int k = 0; k < loop.rows; ++k) s.rows[k] = row_scale[loop.row + k] * s.rows[k];
  }
}

void LoopBias(const KinematicTree& tree, const ScrewWorkspace& ws, int loop_index, double s,
              double* bias) noexcept {
  const Loop& loop = tree.loops[loop_index];
  const LoopScrews& screws = ws.loops[loop_index];
  const JointPlacement& place = tree.placements[loop.joint];
  const ScrewWorkspace::Node &A = ws.at(place.first_node), &B = ws.at(place.second_node);
  // The rate of M's twist in F as an observer on F sees it.
  const Screw V_rel = B.V - A.V;
  const Screw rate = s * (B.A - A.A - CarriedTwist(A.V, V_rel));
  for (int k = 0; k < loop.rows; ++k) bias[k] = Power(screws.rows[k], rate);
  if (loop.type == JointType::kUniversal) {
    // n = y_M x x_F turns in F.
    const Four y_M = Turned(screws.F, screws.state.R_FM.col(1));
    bias[3] += s * Dot(Cross(Cross(V_rel.angular, y_M), screws.F.x), V_rel.angular);
  }
}

}  // namespace vmech
