#include "vmech/dynamics/loads/pose/power.h"

#include <cmath>

#include "vmech/base/packet.h"
#include "vmech/dynamics/loads/pose/hand_wrench.h"
#include "vmech/kinematics/tree/jacobian.h"

namespace vmech {
namespace {

template <typename T>
T PowerOf(const Wrench<T>& W, const Vector6<T>& V) {
  return W.force.dot(V.template head<3>()) + W.moment.dot(V.template tail<3>());
}

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

template <typename T>
void SubtractEnergyRates(const LoadModel& model, const LoadWorkspace<T>& ws, Balance<T>* balance) {
  const Vector3<T> gravity_W = model.tree.mechanism.gravity_W.cast<T>();
  for (size_t i = 0; i < model.tree.nodes.size(); ++i) {
    const TreeNode& node = model.tree.nodes[i];
    if (node.link < 0) continue;
    const NodeState<T>& s = ws.tree.nodes[i];
    const Matrix3<T> I = node.I_Bcm.cast<T>();
    const Vector3<T> c = s.X_WB.R * node.p_BoBcm.cast<T>();
    const Vector3<T> v_cm = s.v + s.w.cross(c);
    const Vector3<T> a_cm = s.a + s.alpha.cross(c) + s.w.cross(s.w.cross(c));
    const Vector3<T> w_B = s.X_WB.R.transpose() * s.w;
    const Vector3<T> alpha_B = s.X_WB.R.transpose() * s.alpha;
    balance->Add(-node.mass * v_cm.dot(a_cm));
    balance->Add(node.mass * v_cm.dot(gravity_W));
    balance->Add(-w_B.dot(I * alpha_B));
  }
}

template <typename T>
void AddExternalPower(const LoadModel& model, const LoadWorkspace<T>& ws, Balance<T>* balance) {
  for (size_t i = 0; i < model.external.size(); ++i) {
    const int node = model.tree.NodeOfLink(model.external[i].link);
    if (node < 0) continue;
    const Vector3d p_B = model.tree.nodes[node].X_BL * model.external[i].p_L;
    const Vector3<T> p_W = ws.tree.nodes[node].X_WB * p_B.cast<T>();
    balance->Add(PowerOf(ws.external_W[i], PointTwist(ws.tree, node, p_W)));
  }
}

template <typename T>
void AddPassivePower(const LoadModel& model, const LoadWorkspace<T>& ws, Balance<T>* balance) {
  for (Eigen::Index v = 0; v < ws.passive.size(); ++v) balance->Add(ws.passive[v] * ws.v[v]);
  for (size_t l = 0; l < model.tree.loops.size(); ++l) {
    const LoopState<T>& s = ws.tree.loops[l];
    const JointPlacement& place = model.tree.placements[model.tree.loops[l].joint];
    const Wrench<T> W{s.R_WF * ws.cut_passive[l].force, s.R_WF * ws.cut_passive[l].moment};
    balance->Add(PowerOf<T>(W, PointTwist(ws.tree, place.second_node, s.p_WM) -
                                   PointTwist(ws.tree, place.first_node, s.p_WM)));
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
  if constexpr (kLanesOf<T> == 1) {
    if (model.hand) {
      const Posed X_WG = GraspPose(model, ws->tree);
      balance.Add(PowerOf(ws->hand, PointTwist(ws->tree, GraspNode(model), X_WG.p)));
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
template void EvaluatePower<Packet>(const LoadModel&, LoadWorkspace<Packet>*);

}  // namespace vmech
