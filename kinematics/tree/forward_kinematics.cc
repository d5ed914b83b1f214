#include "vmech/kinematics/tree/forward_kinematics.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "vmech/base/dual.h"
#include "vmech/base/lanes4.h"
#include "vmech/base/poison.h"
#include "vmech/base/screw_algebra.h"
#include "vmech/base/tape/taped4.h"

namespace vmech {
namespace {

template <typename T>
void SinesAndCosines(const KinematicTree& tree, const T* q, TreeWorkspace<T>* ws) noexcept {
  for (size_t k = 0; k < tree.revolute_coordinates.size(); ++k) {
    SinCos(q[tree.revolute_coordinates[k]], &ws->sine[k], &ws->cosine[k]);
  }
}

/// Four at a time, filled up to whole registers.
void SinesAndCosines(const KinematicTree& tree, const double* q,
                     TreeWorkspace<double>* ws) noexcept {
  const int* angles = tree.revolute_coordinates.data();
  const int count = static_cast<int>(tree.revolute_coordinates.size());
  for (int k = 0; k < count; k += Lanes4::kLanes) {
    // Number by number: loading four at once would wait for the last of them to be written.
    const auto angle = [&](int lane) { return q[angles[std::min(k + lane, count - 1)]]; };
    Lanes4 s, c;
    SinCos(Lanes4::Of(angle), &s, &c);
    std::memcpy(ws->sine.data() + k, &s, sizeof(s));
    std::memcpy(ws->cosine.data() + k, &c, sizeof(c));
  }
}

template <typename T>
ScrewT<T> StaleScrew() {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Triple<T> stale = TripleOf<T>(T(nan), T(nan), T(nan));
  return {stale, stale};
}

/// What hangs on accelerations.
template <typename T>
void PoisonForces(TreeWorkspace<T>* ws) {
  if (!PoisonsStale()) return;
  for (size_t i = 1; i < ws->nodes.size(); ++i) ws->nodes[i].F = StaleScrew<T>();
}

/// What hangs on velocities.
template <typename T>
void PoisonAccelerations(TreeWorkspace<T>* ws) {
  if (!PoisonsStale()) return;
  PoisonForces(ws);
  for (size_t i = 1; i < ws->nodes.size(); ++i) {
    auto& node = ws->nodes[i];
    node.c = node.A = node.p = StaleScrew<T>();
  }
  for (LoopState<T>& loop : ws->loops) loop.bias = Vector6Of(StaleScrew<T>());
}

/// What hangs on the pose; but C, with which a chord step goes on from an earlier one.
template <typename T>
void PoisonMotion(TreeWorkspace<T>* ws) {
  if (!PoisonsStale()) return;
  PoisonAccelerations(ws);
  for (size_t i = 1; i < ws->nodes.size(); ++i) ws->nodes[i].V = StaleScrew<T>();
  for (LoopState<T>& loop : ws->loops) loop.e2 = Vector6Of(StaleScrew<T>());
}

/// X Rz.
template <typename T>
FrameT<T> RotateAboutZ(const FrameT<T>& X, const T& sine, const T& cosine) {
  return {cosine * X.x + sine * X.y, cosine * X.y - sine * X.x, X.z, X.p};
}

/// A turn of 1 rad/s about an axis through p.
template <typename T>
ScrewT<T> AxisThrough(const Triple<T>& p, const Triple<T>& axis) {
  return {Cross(p, axis), axis};
}

/// Of a node in its parent, at the joints' rates v.
template <typename T>
ScrewT<T> JointTwist(const TreeNode& node, const T* v, const TreeWorkspace<T>& ws) {
  if (node.v < 0) return {};
  ScrewT<T> V = v[node.v] * ws.S[node.v];
  for (int k = 1; k < VelocitiesOf(node.motion); ++k) V += v[node.v + k] * ws.S[node.v + k];
  return V;
}

}  // namespace

template <typename T>
void ForwardKinematics(const KinematicTree& tree, const T* q, TreeWorkspace<T>* ws) noexcept {
  PoisonMotion(ws);
  SinesAndCosines(tree, q, ws);
  const T *sine = ws->sine.data(), *cosine = ws->cosine.data();
  FrameT<T> X = ws->at(-1).X;
  for (int i = 0; i < static_cast<int>(tree.nodes.size()); ++i) {
    const TreeNode& node = tree.nodes[i];
    if (node.parent != i - 1) X = ws->at(node.parent).X;  // else in registers
    const FrameT<T>& X_PF = ws->at(i).X_PF;
    ScrewT<T>* S = ws->S.data() + node.v;
    // What does not depend on the parent first: a chain waits for each of its nodes.
    switch (node.motion) {
      case NodeMotion::kFixed:
        X = X * X_PF;
        break;
      case NodeMotion::kRevolute:
        X = X * RotateAboutZ(X_PF, *sine++, *cosine++);
        *S = AxisThrough<T>(X.p, X.z);
        break;
      case NodeMotion::kPrismatic:
        X = X * X_PF;
        X.p += q[node.q] * X.z;
        *S = {X.z, ZeroTriple<T>()};
        break;
      case NodeMotion::kScrew:
        X = X * RotateAboutZ(X_PF, *sine++, *cosine++);
        X.p += (ws->at(i).pitch * q[node.q]) * X.z;
        *S = AxisThrough<T>(X.p, X.z);
        S->linear += ws->at(i).pitch * X.z;
        break;
      case NodeMotion::kSpherical: {
        const Matrix3<T> R_FM = RotationOf(q + node.q);
        const FrameT<T> F = X * X_PF;
        X = Rotate(F, node.reversed ? Matrix3<T>(R_FM.transpose()) : R_FM, F.p);
        // Reversed, v is the rate of the parent in axes that are fixed there.
        const FrameT<T> M = node.reversed ? FrameT<T>{-F.x, -F.y, -F.z, F.p} : X;
        for (const Triple<T>* axis : {&M.x, &M.y, &M.z}) *S++ = AxisThrough<T>(X.p, *axis);
        break;
      }
    }
    ws->at(i).X = X;
  }
}

template <typename T>
void ForwardVelocities(const KinematicTree& tree, const T* v, TreeWorkspace<T>* ws) noexcept {
  PoisonAccelerations(ws);
  ScrewT<T> V;
  for (int i = 0; i < static_cast<int>(tree.nodes.size()); ++i) {
    const TreeNode& node = tree.nodes[i];
    if (node.parent != i - 1) V = ws->at(node.parent).V;
    V += JointTwist(node, v, *ws);
    ws->at(i).V = V;
  }
}

template <typename T>
void VelocityProducts(const KinematicTree& tree, TreeWorkspace<T>* ws) noexcept {
  PoisonForces(ws);
  ScrewT<T> A = ws->at(-1).A;
  for (int i = 0; i < static_cast<int>(tree.nodes.size()); ++i) {
    const typename TreeWorkspace<T>::Node& parent = ws->at(tree.nodes[i].parent);
    typename TreeWorkspace<T>::Node& s = ws->at(i);
    if (tree.nodes[i].parent != i - 1) A = parent.A;
    // Joint axes go with the parent, or with the node, which is the same: V_P x (V - V_P).
    s.c = CarriedTwist(parent.V, s.V);
    A += s.c;
    s.A = A;
  }
}

template <typename T>
void ForwardAccelerations(const KinematicTree& tree, const T* vdot, TreeWorkspace<T>* ws) noexcept {
  PoisonForces(ws);
  ScrewT<T> A = ws->at(-1).A;
  for (int i = 0; i < static_cast<int>(tree.nodes.size()); ++i) {
    const TreeNode& node = tree.nodes[i];
    if (node.parent != i - 1) A = ws->at(node.parent).A;
    A += ws->at(i).c;
    A += JointTwist(node, vdot, *ws);
    ws->at(i).A = A;
  }
}

template <typename T>
void MoveCoordinates(const KinematicTree& tree, const T* dv, T* q) {
  using std::abs;
  using std::sqrt;
  for (const TreeNode& node : tree.nodes) {
    if (node.motion == NodeMotion::kFixed) continue;
    if (node.motion != NodeMotion::kSpherical) {
      q[node.q] += dv[node.v];
      continue;
    }
    const Vector3<T> turn(dv[node.v], dv[node.v + 1], dv[node.v + 2]);
    const T angle2 = turn.squaredNorm();
    T per_angle, cosine;  // sin(angle/2)/angle and cos(angle/2)
    // Short cuts of a single pose: what decides for four lanes must not depend on all of them.
    constexpr bool kSingle = kLanesOf<T> == 1;
    if (kSingle && AllLanes(angle2 <= T(0.01))) {
      const T x = 0.25 * angle2;
      per_angle = 0.5 - x * (1.0 / 12 - x * (1.0 / 240 - x * (1.0 / 10080 - x * (1.0 / 725760))));
      cosine = 1.0 - x * (1.0 / 2 - x * (1.0 / 24 - x * (1.0 / 720 - x * (1.0 / 40320))));
    } else {
      const T angle = sqrt(angle2);
      T sine;
      SinCos(0.5 * angle, &sine, &cosine);
      per_angle = Select(angle > T(1e-8), sine / angle, T(0.5));
    }
    const Vector3<T> e = per_angle * turn;
    T* wxyz = q + node.q;
    const T w = wxyz[0];
    const Vector3<T> xyz(wxyz[1], wxyz[2], wxyz[3]);
    const T w_next = w * cosine - xyz.dot(e);
    const Vector3<T> xyz_next = w * e + cosine * xyz + xyz.cross(e);
    const T length2 = w_next * w_next + xyz_next.squaredNorm();
    const T excess = length2 - 1.0;
    const bool nearly = kSingle && AllLanes(abs(excess) <= T(1e-8));
    const T per_length = nearly ? 1.0 - 0.5 * excess : 1.0 / sqrt(length2);
    wxyz[0] = per_length * w_next;
    for (int k = 0; k < 3; ++k) wxyz[1 + k] = per_length * xyz_next[k];
  }
}

void MoveCoordinates(const KinematicTree& tree, const VectorXd& dv, VectorXd* q) {
  MoveCoordinates(tree, dv.data(), q->data());
}

Posed PoseInWorld(const TreeWorkspace<double>& ws, int node, const Posed& X_BQ) {
  Posed X_WQ = PoseOf(ws.at(node).X * X_BQ);
  X_WQ.p += ws.reference;
  return X_WQ;
}

void GraspJacobian(const KinematicTree& tree, const TreeWorkspace<double>& ws, int node,
                   const Frame& Q, std::vector<Screw>* J) noexcept {
  std::fill(J->begin(), J->end(), Screw{});
  for (int n = node; n >= 0; n = tree.nodes[n].parent) {
    const TreeNode& carrier = tree.nodes[n];
    for (int v = carrier.v; v < carrier.v + VelocitiesOf(carrier.motion); ++v) {
      const Screw& S = ws.S[v];
      (*J)[v] = {VelocityAt(Q.p, S), S.angular};
    }
  }
}

void GraspJacobian(const KinematicTree& tree, const TreeWorkspace<double>& ws, int node,
                   const Posed& X_BQ, Matrix6Xd* J) {
  std::vector<Screw> columns(tree.nv);
  GraspJacobian(tree, ws, node, ws.at(node).X * X_BQ, &columns);
  for (int v = 0; v < tree.nv; ++v) J->col(v) = Vector6Of(columns[v]);
}

Vector6d GraspTwist(const TreeWorkspace<double>& ws, int node, const Posed& X_BQ) {
  const Screw& V = ws.at(node).V;
  return Vector6Of(Screw{VelocityAt(PointInWorld(ws.at(node).X, X_BQ.p), V), V.angular});
}

Vector6d GraspAcceleration(const TreeWorkspace<double>& ws, int node, const Posed& X_BQ) {
  const Double4 p = PointInWorld(ws.at(node).X, X_BQ.p);
  const Screw &V = ws.at(node).V, A = ws.at(node).A - ws.at(-1).A;
  return Vector6Of(Screw{VelocityAt(p, A) + Cross(V.angular, VelocityAt(p, V)), A.angular});
}

// NOLINTBEGIN(bugprone-macro-parentheses): T is a type
#define VMECH_INSTANTIATE(T)                                                                      \
  template void ForwardKinematics<T>(const KinematicTree&, const T*, TreeWorkspace<T>*) noexcept; \
  template void ForwardVelocities<T>(const KinematicTree&, const T*, TreeWorkspace<T>*) noexcept; \
  template void VelocityProducts<T>(const KinematicTree&, TreeWorkspace<T>*) noexcept;            \
  template void ForwardAccelerations<T>(const KinematicTree&, const T*,                           \
                                        TreeWorkspace<T>*) noexcept;                              \
  template void MoveCoordinates<T>(const KinematicTree&, const T*, T*);
VMECH_INSTANTIATE(double)
VMECH_INSTANTIATE(Dual)
VMECH_INSTANTIATE(Taped4)
VMECH_INSTANTIATE(Lanes4)
#undef VMECH_INSTANTIATE
// NOLINTEND(bugprone-macro-parentheses)

}  // namespace vmech
