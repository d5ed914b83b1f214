#include "vmech/dynamics/loads/pose/power.h"

#include <cmath>

#include "vmech/base/dual.h"
#include "vmech/base/lanes4.h"
#include "vmech/base/screw_algebra.h"
#include "vmech/dynamics/loads/pose/hand_wrench.h"

namespace vmech {
namespace {

/// A sum and the sum of the magnitudes of its terms.
template <typename T>
struct Balance {
  T sum = T(0);
  T size = T(0);
  void Add(const T& term) {
    using std::abs;
    sum += term;
    size += abs(term);
  }
};

/// d/dt of kinetic energy and of height, body by body in its own figures: another sum than that of
/// the forces.
template <typename T>
void SubtractEnergyRates(const LoadModel& model, const LoadWorkspace<T>& ws, Balance<T>* balance) {
  const Triple<T> gravity_W = TripleOf<T>(ws.gravity_W);
  for (size_t i = 0; i < model.tree.nodes.size(); ++i) {
    if (model.tree.nodes[i].link < 0) continue;
    const typename TreeWorkspace<T>::Node& s = ws.tree.nodes[i + 1];
    const typename TreeInertias<T>::Body& body = ws.inertias.in_node[i + 1];
    const ScrewT<T> A = s.A - ws.tree.at(-1).A;
    const Triple<T> c = PointInWorld(s.X, body.p_BoBcm);
    const Triple<T> v_cm = VelocityAt(c, s.V);
    const Triple<T> a_cm = VelocityAt(c, A) + Cross(s.V.angular, v_cm);
    const Triple<T> w_B = InverseRotate(s.X, s.V.angular), alpha_B = InverseRotate(s.X, A.angular);
    const Triple<T> torque_B = alpha_B[0] * body.Ix + alpha_B[1] * body.Iy + alpha_B[2] * body.Iz;
    balance->Add(-body.mass * Dot(v_cm, a_cm));
    balance->Add(body.mass * Dot(v_cm, gravity_W));
    balance->Add(-Dot(w_B, torque_B));
  }
}

template <typename T>
void AddExternalPower(const LoadModel& model, const LoadWorkspace<T>& ws, Balance<T>* balance) {
  for (size_t i = 0; i < model.external.size(); ++i) {
    const int node = model.tree.NodeOfLink(model.external[i].link);
    if (node >= 0) balance->Add(Power(ws.external[i], ws.tree.at(node).V));
  }
}

template <typename T>
void AddPassivePower(const LoadModel& model, const LoadWorkspace<T>& ws, Balance<T>* balance) {
  for (Eigen::Index v = 0; v < ws.passive.size(); ++v) balance->Add(ws.passive[v] * ws.v[v]);
  for (size_t l = 0; l < model.tree.loops.size(); ++l) {
    const JointPlacement& place = model.tree.placements[model.tree.loops[l].joint];
    balance->Add(Power(WrenchFrom(ws.tree.loops[l].F, ws.cut_passive[l]),
                       ws.tree.at(place.second_node).V - ws.tree.at(place.first_node).V));
  }
}

}  // namespace

template <typename T>
void EvaluatePower(const LoadModel& model, LoadWorkspace<T>* ws) {
  using std::abs;
  Balance<T> balance;
  for (size_t k = 0; k < model.drives.size(); ++k) {
    balance.Add(ws->drive_forces[k] * ws->v[model.partition.driven[k]]);
  }
  if constexpr (std::is_same_v<T, double>) {
    if (model.hand) {
      const GraspFrame grasp = HandGrasp(model);
      balance.Add(ws->hand.Stacked().dot(GraspTwist(ws->tree, grasp.node, grasp.X_BG)));
    }
  }
  ws->power = balance.sum;
  AddExternalPower(model, *ws, &balance);
  if (model.has_passive) AddPassivePower(model, *ws, &balance);
  SubtractEnergyRates(model, *ws, &balance);
  ws->power_gap = abs(balance.sum);
  ws->power_size = balance.size;
}

template void EvaluatePower<double>(const LoadModel&, LoadWorkspace<double>*);
template void EvaluatePower<Dual>(const LoadModel&, LoadWorkspace<Dual>*);
template void EvaluatePower<Lanes4>(const LoadModel&, LoadWorkspace<Lanes4>*);

}  // namespace vmech
