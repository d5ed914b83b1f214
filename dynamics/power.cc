#include "vmech/dynamics/power.h"

#include <cmath>

#include "vmech/dynamics/hand_wrench.h"
#include "vmech/kinematics/jacobian.h"

namespace vmech {
namespace {

double PowerOf(const Wrenchd& W, const Vector6d& V) {
  return W.force.dot(V.head<3>()) + W.moment.dot(V.tail<3>());
}

/// A sum and the sum of the magnitudes of its terms.
struct Balance {
  double sum = 0;
  double size = 0;
  void Add(double term) {
    sum += term;
    size += std::abs(term);
  }
};

void SubtractEnergyRates(const LoadModel& model, const LoadWorkspace& ws, Balance* balance) {
  for (size_t i = 0; i < model.tree.nodes.size(); ++i) {
    const TreeNode& node = model.tree.nodes[i];
    if (node.link < 0) continue;
    const NodeState<double>& s = ws.tree.nodes[i];
    const Vector3d c = s.X_WB.R * node.p_BoBcm;
    const Vector3d v_cm = s.v + s.w.cross(c);
    const Vector3d a_cm = s.a + s.alpha.cross(c) + s.w.cross(s.w.cross(c));
    const Vector3d w_B = s.X_WB.R.transpose() * s.w;
    const Vector3d alpha_B = s.X_WB.R.transpose() * s.alpha;
    balance->Add(-node.mass * v_cm.dot(a_cm));
    balance->Add(node.mass * v_cm.dot(model.tree.mechanism.gravity_W));
    balance->Add(-w_B.dot(node.I_Bcm * alpha_B));
  }
}

void AddExternalPower(const LoadModel& model, const LoadWorkspace& ws, Balance* balance) {
  for (size_t i = 0; i < model.external.size(); ++i) {
    const int node = model.tree.NodeOfLink(model.external[i].link);
    if (node < 0) continue;
    const Vector3d p_W =
        ws.tree.nodes[node].X_WB * (model.tree.nodes[node].X_BL * model.external[i].p_L);
    balance->Add(PowerOf(ws.external_W[i], PointTwist(ws.tree, node, p_W)));
  }
}

void AddPassivePower(const LoadModel& model, const LoadWorkspace& ws, Balance* balance) {
  for (Eigen::Index v = 0; v < ws.passive.size(); ++v) balance->Add(ws.passive[v] * ws.v[v]);
  for (size_t l = 0; l < model.tree.loops.size(); ++l) {
    const LoopState<double>& s = ws.tree.loops[l];
    const JointPlacement& place = model.tree.placements[model.tree.loops[l].joint];
    const Wrenchd W{s.R_WF * ws.cut_passive[l].force, s.R_WF * ws.cut_passive[l].moment};
    balance->Add(PowerOf(W, PointTwist(ws.tree, place.second_node, s.p_WM) -
                                PointTwist(ws.tree, place.first_node, s.p_WM)));
  }
}

}  // namespace

void EvaluatePower(const LoadModel& model, const LoadWorkspace& ws, PoseLoads* out) {
  Balance balance;
  for (size_t k = 0; k < model.drives.size(); ++k) {
    balance.Add(out->drive_forces[k] * ws.v[model.partition.driven[k]]);
  }
  if (model.hand) {
    const Posed X_WG = GraspPose(model, ws.tree);
    balance.Add(PowerOf(out->hand, PointTwist(ws.tree, GraspNode(model), X_WG.p)));
  }
  out->power = balance.sum;
  AddExternalPower(model, ws, &balance);
  if (model.has_passive) AddPassivePower(model, ws, &balance);
  SubtractEnergyRates(model, ws, &balance);
  out->power_error = balance.size > 0 ? std::abs(balance.sum) / balance.size : 0;
}

}  // namespace vmech
