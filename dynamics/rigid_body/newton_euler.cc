#include "vmech/dynamics/rigid_body/newton_euler.h"

#include "vmech/base/dual.h"
#include "vmech/base/lanes4.h"
#include "vmech/base/screw_algebra.h"
#include "vmech/base/tape/taped4.h"

namespace vmech {
namespace {

template <typename T>
ScrewInertiaT<T> InertiaInWorld(const typename TreeInertias<T>::Body& body, const FrameT<T>& X) {
  const Triple<T> c = PointInWorld(X, body.p_BoBcm), mc = body.mass * c;
  // R I R', and the parallel axes: I + m (c'c - c c').
  const FrameT<T> RI{Rotate(X, body.Ix), Rotate(X, body.Iy), Rotate(X, body.Iz), c};
  const T square = Dot(c, mc), zero(0);
  const auto column = [&](int k, const Triple<T>& diagonal) -> Triple<T> {
    return (Rotate<T>(RI, X.x[k], X.y[k], X.z[k]) - c[k] * mc) + diagonal;
  };
  return {body.mass, mc, column(0, TripleOf<T>(square, zero, zero)),
          column(1, TripleOf<T>(zero, square, zero)), column(2, TripleOf<T>(zero, zero, square))};
}

template <typename T>
ScrewT<T> MomentumOf(const typename TreeInertias<T>::Body& body, const FrameT<T>& X,
                     const ScrewT<T>& V) {
  const Triple<T> c = PointInWorld(X, body.p_BoBcm), w_B = InverseRotate(X, V.angular);
  const Triple<T> spin_B = w_B[0] * body.Ix + w_B[1] * body.Iy + w_B[2] * body.Iz;
  return WrenchAt(c, body.mass * VelocityAt(c, V), Rotate(X, spin_B));
}

/// Adds to every F those of the node's children. Writes the generalised forces, unless null.
template <typename T>
void PropagateWrenches(const KinematicTree& tree, TreeWorkspace<T>* ws, T* tau) {
  ws->nodes[0].F = {};
  ScrewT<T>
      sum;  // what this node gets from the next, in registers: a chain need not wait for memory
  for (int i = static_cast<int>(tree.nodes.size()); i-- > 0;) {
    const TreeNode& node = tree.nodes[i];
    sum += ws->at(i).F;
    ws->at(i).F = sum;
    for (int v = node.v; tau && v < node.v + VelocitiesOf(node.motion); ++v) {
      tau[v] = Power(sum, ws->S[v]);
    }
    if (node.parent == i - 1) continue;
    ws->at(node.parent).F += sum;
    sum = {};
  }
  ws->nodes[0].F += sum;
}

/// Writes the composites.
void AccumulateInertias(const KinematicTree& tree, TreeInertias<double>* inertias) {
  ScrewInertia sum;  // in registers, as above
  for (int i = static_cast<int>(tree.nodes.size()); i-- > 0;) {
    sum += inertias->bodies[i + 1];
    if (inertias->has_received[i + 1]) sum += inertias->received[i + 1];
    inertias->has_received[i + 1] = false;
    inertias->composites[i + 1] = sum;
    const int parent = tree.nodes[i].parent;
    if (parent == i - 1) continue;
    ScrewInertia& received = inertias->received[parent + 1];
    if (!inertias->has_received[parent + 1]) received = {};
    inertias->has_received[parent + 1] = true;
    received += sum;
    sum = {};
  }
}

}  // namespace

template <typename T>
TreeInertias<T>::TreeInertias(const KinematicTree& tree)
    : TreeInertias(tree, DesignOfTree<T>(tree)) {}

template <typename T>
TreeInertias<T>::TreeInertias(const KinematicTree& tree, const TreeDesign<T>& design)
    : in_node(tree.nodes.size() + 1),
      bodies(in_node.size()),
      composites(bodies),
      received(bodies),
      has_received(bodies.size()) {
  Take(design);
  const int n = tree.nv;
  for (int i = 0; i < static_cast<int>(tree.nodes.size()); ++i) {
    const TreeNode& node = tree.nodes[i];
    for (int v = node.v; v < node.v + VelocitiesOf(node.motion); ++v) {
      const auto add = [&](int u) { entries.push_back({i + 1, v, u, v * n + u, u * n + v}); };
      add(v);
      for (int j = i; j >= 0; j = tree.nodes[j].parent) {
        const TreeNode& below = tree.nodes[j];
        for (int u = below.v; u < below.v + VelocitiesOf(below.motion); ++u) {
          if (u < v) add(u);
        }
      }
    }
  }
}

template <typename T>
void TreeInertias<T>::Take(const TreeDesign<T>& design) noexcept {
  for (size_t i = 0; i < design.nodes.size(); ++i) {
    const auto& [X_PF, X_BL, pitch, mass, p_BoBcm, I] = design.nodes[i];
    in_node[i + 1] = {mass, TripleOf<T>(p_BoBcm), TripleOf<T>(I.col(0)), TripleOf<T>(I.col(1)),
                      TripleOf<T>(I.col(2))};
  }
}

template <typename T>
void SetGravity(const std::type_identity_t<Vector3<T>>& gravity_W, TreeWorkspace<T>* ws) noexcept {
  ws->at(-1).A.linear = TripleOf<T>(Vector3<T>(-gravity_W));
}

template <typename T>
void BodyInertias(const KinematicTree& tree, const TreeWorkspace<T>& ws,
                  TreeInertias<T>* inertias) noexcept {
  for (size_t i = 0; i < tree.nodes.size(); ++i) {
    if (tree.nodes[i].link < 0) continue;
    inertias->bodies[i + 1] = InertiaInWorld<T>(inertias->in_node[i + 1], ws.nodes[i + 1].X);
  }
}

void CompositeMassMatrix(const KinematicTree& tree, const TreeWorkspace<double>& ws,
                         TreeInertias<double>* inertias, MatrixXd* M) noexcept {
  AccumulateInertias(tree, inertias);
  double* const m = M->data();
  Screw momentum;
  for (const auto& [node, v, u, above, below] : inertias->entries) {
    if (u == v) momentum = inertias->composites[node] * ws.S[v];  // the first of v's
    m[above] = m[below] = Power(momentum, ws.S[u]);
  }
}

template <typename T>
void GyroscopicWrenches(const KinematicTree& tree, const TreeInertias<T>& inertias,
                        TreeWorkspace<T>* ws) noexcept {
  for (size_t i = 0; i < tree.nodes.size(); ++i) {
    if (tree.nodes[i].link < 0) continue;
    auto& s = ws->nodes[i + 1];
    s.p = CarriedWrench(s.V, inertias.bodies[i + 1] * s.V);
  }
}

template <typename T>
void NewtonEuler(const KinematicTree& tree, const TreeInertias<T>& inertias,
                 const ScrewT<T>* applied, TreeWorkspace<T>* ws, T* tau) noexcept {
  for (size_t i = 0; i < tree.nodes.size(); ++i) {
    auto& s = ws->nodes[i + 1];
    s.F = tree.nodes[i].link < 0 ? ScrewT<T>{} : inertias.bodies[i + 1] * s.A + s.p;
    if (applied) s.F -= applied[i];
  }
  PropagateWrenches(tree, ws, tau);
}

template <typename T>
void GeneralisedForces(const KinematicTree& tree, const TreeWorkspace<T>& ws, T* tau) noexcept {
  for (size_t i = 0; i < tree.nodes.size(); ++i) {
    const TreeNode& node = tree.nodes[i];
    for (int v = node.v; v >= 0 && v < node.v + VelocitiesOf(node.motion); ++v) {
      tau[v] = Power(ws.nodes[i + 1].F, ws.S[v]);
    }
  }
}

template <typename T>
void Momenta(const KinematicTree& tree, const TreeInertias<T>& inertias, const T* v,
             TreeWorkspace<T>* ws, T* momenta) noexcept {
  ForwardVelocities(tree, v, ws);
  for (size_t i = 1; i < ws->nodes.size(); ++i) {
    typename TreeWorkspace<T>::Node& s = ws->nodes[i];
    s.F = MomentumOf<T>(inertias.in_node[i], s.X, s.V);
  }
  PropagateWrenches(tree, ws, momenta);
}

double KineticEnergy(const KinematicTree& tree, const TreeInertias<double>& inertias,
                     const TreeWorkspace<double>& ws) noexcept {
  double energy = 0;
  for (size_t i = 1; i <= tree.nodes.size(); ++i) {
    energy += 0.5 * Power(inertias.bodies[i] * ws.nodes[i].V, ws.nodes[i].V);
  }
  return energy;
}

double WeightEnergy(const Vector3d& gravity_W, const TreeInertias<double>& inertias) noexcept {
  Double4 moment{};
  for (const ScrewInertia& body : inertias.bodies) moment += body.moment;
  return -Dot(Double4Of(gravity_W), moment);
}

MatrixXd MassMatrix(const KinematicTree& tree, const VectorXd& q) {
  TreeWorkspace<double> ws(tree);
  TreeInertias<double> inertias(tree);
  MatrixXd M = MatrixXd::Zero(tree.nv, tree.nv);
  ForwardKinematics(tree, q.data(), &ws);
  BodyInertias(tree, ws, &inertias);
  CompositeMassMatrix(tree, ws, &inertias, &M);
  return M;
}

VectorXd BiasForces(const KinematicTree& tree, const VectorXd& q, const VectorXd& v) {
  TreeWorkspace<double> ws(tree);
  TreeInertias<double> inertias(tree);
  VectorXd h = VectorXd::Zero(tree.nv);
  SetGravity(tree.mechanism.gravity_W, &ws);
  ForwardKinematics(tree, q.data(), &ws);
  ForwardVelocities(tree, v.data(), &ws);
  VelocityProducts(tree, &ws);
  BodyInertias(tree, ws, &inertias);
  GyroscopicWrenches(tree, inertias, &ws);
  NewtonEuler<double>(tree, inertias, nullptr, &ws, h.data());
  return h;
}

// NOLINTBEGIN(bugprone-macro-parentheses): T is a type
#define VMECH_INSTANTIATE(T)                                                                      \
  template struct TreeInertias<T>;                                                                \
  template void SetGravity<T>(const std::type_identity_t<Vector3<T>>&,                            \
                              TreeWorkspace<T>*) noexcept;                                        \
  template void BodyInertias<T>(const KinematicTree&, const TreeWorkspace<T>&,                    \
                                TreeInertias<T>*) noexcept;                                       \
  template void GyroscopicWrenches<T>(const KinematicTree&, const TreeInertias<T>&,               \
                                      TreeWorkspace<T>*) noexcept;                                \
  template void NewtonEuler<T>(const KinematicTree&, const TreeInertias<T>&, const ScrewT<T>*,    \
                               TreeWorkspace<T>*, T*) noexcept;                                   \
  template void GeneralisedForces<T>(const KinematicTree&, const TreeWorkspace<T>&, T*) noexcept; \
  template void Momenta<T>(const KinematicTree&, const TreeInertias<T>&, const T*,                \
                           TreeWorkspace<T>*, T*) noexcept;
VMECH_INSTANTIATE(double)
VMECH_INSTANTIATE(Dual)
VMECH_INSTANTIATE(Taped4)
VMECH_INSTANTIATE(Lanes4)
#undef VMECH_INSTANTIATE
// NOLINTEND(bugprone-macro-parentheses)

}  // namespace vmech
