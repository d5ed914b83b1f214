#include "vmech/dynamics/rigid_body/screw_dynamics.h"

#include <algorithm>

#include "vmech/base/screw_algebra.h"

namespace vmech {
namespace {

ScrewInertia InertiaInWorld(const ScrewInertias::Body& body, const Axes& X) {
  const Four c = PointInWorld(X, body.p_BoBcm), mc = body.mass * c;
  // R I R', and the parallel axes: I + m (c'c - c c').
  const Axes RI{Turned(X, body.Ix), Turned(X, body.Iy), Turned(X, body.Iz), c};
  const double square = Dot(c, mc);
  const auto column = [&](int k) { return Turned(RI, X.x[k], X.y[k], X.z[k]) - c[k] * mc; };
  return {body.mass, mc, column(0) + Four{square, 0, 0, 0}, column(1) + Four{0, square, 0, 0},
          column(2) + Four{0, 0, square, 0}};
}

Screw MomentumOf(const ScrewInertias::Body& body, const Axes& X, const Screw& V) {
  const Four c = PointInWorld(X, body.p_BoBcm), w_B = InverseRotate(X, V.angular);
  const Four spin_B = w_B[0] * body.Ix + w_B[1] * body.Iy + w_B[2] * body.Iz;
  return WrenchAt(c, body.mass * VelocityAt(c, V), Turned(X, spin_B));
}

/// Every node carries its children. Writes the generalised forces, unless null.
void PropagateWrenches(const KinematicTree& tree, ScrewWorkspace* ws, double* tau) {
  ws->nodes[0].F = {};
  Screw sum;  // what this node gets from the next, in registers: a chain need not wait for memory
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
void AccumulateInertias(const KinematicTree& tree, ScrewInertias* inertias) {
  ScrewInertia sum;  // in registers, as in PropagateWrenches
  for (int i = static_cast<int>(tree.nodes.size()); i-- > 0;) {
    sum += inertias->bodies[i + 1];
    if (inertias->carries[i + 1]) sum += inertias->carried[i + 1];
    inertias->carries[i + 1] = false;
    inertias->composites[i + 1] = sum;
    const int parent = tree.nodes[i].parent;
    if (parent == i - 1) continue;
    ScrewInertia& carried = inertias->carried[parent + 1];
    if (!inertias->carries[parent + 1]) carried = {};
    inertias->carries[parent + 1] = true;
    carried += sum;
    sum = {};
  }
}

}  // namespace

ScrewInertias::ScrewInertias(const KinematicTree& tree)
    : in_node(tree.nodes.size() + 1),
      bodies(in_node.size()),
      composites(bodies),
      carried(bodies),
      carries(bodies.size()) {
  const int n = tree.nv;
  for (int i = 0; i < static_cast<int>(tree.nodes.size()); ++i) {
    const TreeNode& node = tree.nodes[i];
    const Matrix3d& I = node.I_Bcm;
    in_node[i + 1] = {node.mass, FourOf(node.p_BoBcm), FourOf(I.col(0)), FourOf(I.col(1)),
                      FourOf(I.col(2))};
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

void SetGravity(const Vector3d& gravity_W, ScrewWorkspace* ws) noexcept {
  ws->nodes[0].A.linear = -FourOf(gravity_W);
}

void BodyInertias(const KinematicTree& tree, const ScrewWorkspace& ws,
                  ScrewInertias* inertias) noexcept {
  for (size_t i = 0; i < tree.nodes.size(); ++i) {
    if (tree.nodes[i].link < 0) continue;
    inertias->bodies[i + 1] = InertiaInWorld(inertias->in_node[i + 1], ws.nodes[i + 1].X);
  }
}

void CompositeMassMatrix(const KinematicTree& tree, const ScrewWorkspace& ws,
                         ScrewInertias* inertias, MatrixXd* M) noexcept {
  AccumulateInertias(tree, inertias);
  double* const m = M->data();
  Screw momentum;
  for (const auto& [node, v, u, above, below] : inertias->entries) {
    if (u == v) momentum = inertias->composites[node] * ws.S[v];  // the first of v's
    m[above] = m[below] = Power(momentum, ws.S[u]);
  }
}

void GyroscopicWrenches(const KinematicTree& tree, const ScrewInertias& inertias,
                        ScrewWorkspace* ws) noexcept {
  for (size_t i = 0; i < tree.nodes.size(); ++i) {
    if (tree.nodes[i].link < 0) continue;
    ScrewWorkspace::Node& s = ws->nodes[i + 1];
    s.p = CarriedWrench(s.V, inertias.bodies[i + 1] * s.V);
  }
}

void NewtonEuler(const KinematicTree& tree, const ScrewInertias& inertias, ScrewWorkspace* ws,
                 double* tau) noexcept {
  for (size_t i = 0; i < tree.nodes.size(); ++i) {
    ScrewWorkspace::Node& s = ws->nodes[i + 1];
    s.F = tree.nodes[i].link < 0 ? Screw{} : inertias.bodies[i + 1] * s.A + s.p;
  }
  PropagateWrenches(tree, ws, tau);
}

void Momenta(const KinematicTree& tree, const ScrewInertias& inertias, const double* v,
             ScrewWorkspace* ws, double* momenta) noexcept {
  ForwardVelocities(tree, v, ws);
  for (size_t i = 1; i < ws->nodes.size(); ++i) {
    ScrewWorkspace::Node& s = ws->nodes[i];
    s.F = MomentumOf(inertias.in_node[i], s.X, s.V);
  }
  PropagateWrenches(tree, ws, momenta);
}

double KineticEnergy(const KinematicTree& tree, const ScrewInertias& inertias,
                     const ScrewWorkspace& ws) noexcept {
  double energy = 0;
  for (size_t i = 1; i <= tree.nodes.size(); ++i) {
    energy += 0.5 * Power(inertias.bodies[i] * ws.nodes[i].V, ws.nodes[i].V);
  }
  return energy;
}

double WeightEnergy(const KinematicTree& tree, const ScrewInertias& inertias) noexcept {
  Four moment{};
  for (const ScrewInertia& body : inertias.bodies) moment += body.moment;
  return -Dot(FourOf(tree.mechanism.gravity_W), moment);
}

}  // namespace vmech
