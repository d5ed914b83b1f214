#include "vmech/dynamics/pose_loads.h"

#include <algorithm>
#include <cmath>

#include "vmech/dynamics/external_loads.h"
#include "vmech/dynamics/hand_wrench.h"
#include "vmech/dynamics/idle_freedoms.h"
#include "vmech/dynamics/newton_euler.h"
#include "vmech/dynamics/paper_joint.h"
#include "vmech/dynamics/passive.h"
#include "vmech/dynamics/power.h"
#include "vmech/kinematics/forward_kinematics.h"
#include "vmech/kinematics/jacobian.h"
#include "vmech/kinematics/loops.h"

namespace vmech {
namespace {

constexpr int kMaxFrictionIterations = 200;
/// Small enough to stay with the equilibrium that grows out of the one without friction: beyond the
/// cone of friction there is a second, in which the loads have turned round.
constexpr double kFirstRelaxation = 0.25;
constexpr double kFrictionTolerance = 1e-13;  // change of the largest joint force, relative

void CloseVelocities(const LoadModel& model, const PoseInput& input, LoadWorkspace* ws) {
  const CoordinatePartition& partition = model.partition;
  if (ws->motions.size() > 0) FreeMotions(ws->tree, &ws->dependents, &ws->motions);
  if (model.hand) {
    HandVelocities(model, input.hand, ws);
  } else {
    for (size_t k = 0; k < partition.driven.size(); ++k) {
      ws->v[partition.driven[k]] = input.drives[k].velocity;
    }
    for (int v : partition.idle) ws->v[v] = 0;
    ws->dependents.CompleteVelocities(ws->tree, ws->v.data());
    if (!partition.idle.empty()) RemoveIdleMomentum(model, ws);
  }
  ForwardVelocities(model.tree, ws->v.data(), &ws->tree);
}

void CloseAccelerations(const LoadModel& model, const PoseInput& input, LoadWorkspace* ws) {
  const CoordinatePartition& partition = model.partition;
  ForwardAccelerations<double>(model.tree, ws->v.data(), nullptr, &ws->tree);
  LoopAccelerationBias(model.tree, &ws->tree);
  for (size_t k = 0; k < partition.driven.size(); ++k) {
    ws->vdot[partition.driven[k]] = model.hand ? 0 : input.drives[k].acceleration;
  }
  for (int v : partition.idle) ws->vdot[v] = 0;
  ws->dependents.CompleteAccelerations(ws->tree, ws->vdot.data());
  ForwardAccelerations<double>(model.tree, ws->v.data(), ws->vdot.data(), &ws->tree);
  if (!model.hand) return;
  HandAccelerations(model, input.hand, ws);
  ForwardAccelerations<double>(model.tree, ws->v.data(), ws->vdot.data(), &ws->tree);
}

/// Coordinates and rates of every joint, cut ones included.
void JointMotions(const LoadModel& model, const PoseInput& input, const LoadWorkspace& ws,
                  PoseLoads* out) {
  for (const TreeNode& node : model.tree.nodes) {
    if (node.v < 0) continue;
    Vector3d& position = out->joint_positions[node.joint];
    Vector3d& rate = out->joint_rates[node.joint];
    if (node.motion == NodeMotion::kSpherical) {
      const double* c = input.q.data() + node.q;
      const Eigen::AngleAxisd turn(Eigen::Quaterniond(c[0], c[1], c[2], c[3]));
      position = turn.angle() * turn.axis();
      rate = ws.v.segment<3>(node.v);
    } else {
      position[node.freedom] = input.q[node.q];
      rate[node.freedom] = ws.v[node.v];
    }
  }
  for (size_t l = 0; l < model.tree.loops.size(); ++l) {
    const int joint = model.tree.loops[l].joint;
    out->joint_positions[joint] = input.cut_positions[l];
    out->joint_rates[joint] = CutJointRates(model.tree, ws.tree, static_cast<int>(l));
  }
}

/// Springs and friction along every freedom, under the joint wrenches of `out`.
void PassiveForces(const LoadModel& model, const PoseLoads& out, LoadWorkspace* ws) {
  auto force = [&](int joint_index, int freedom) {
    const Joint& joint = model.tree.mechanism.joints[joint_index];
    const double dry = DryFriction(joint, freedom, out.joints[joint_index]);
    return PassiveForce(joint.passive[freedom], dry, out.joint_positions[joint_index][freedom],
                        out.joint_rates[joint_index][freedom]);
  };
  for (const TreeNode& node : model.tree.nodes) {
    if (node.v < 0) continue;
    const int count = node.motion == NodeMotion::kSpherical ? 3 : 1;
    for (int k = 0; k < count; ++k) ws->passive[node.v + k] = force(node.joint, node.freedom + k);
  }
  for (size_t l = 0; l < model.tree.loops.size(); ++l) {
    const CutJointFreedoms freedoms = FreedomsOfCutJoint(model.tree.loops[l], ws->tree.loops[l]);
    Vector6d W_F = Vector6d::Zero();
    for (int k = 0; k < freedoms.count; ++k) {
      // A twist of unit rate against which the force does work; exact for the screw as well.
      const Vector6d& S = freedoms.twist_F[k];
      W_F += S / S.squaredNorm() * force(model.tree.loops[l].joint, k);
    }
    ws->cut_passive[l] = {W_F.head<3>(), W_F.tail<3>()};
  }
}

void ApplyAt(int node, const Wrenchd& W, const Vector3d& p_W, LoadWorkspace* ws) {
  if (node >= 0) ws->applied[node] += W.ShiftedBy(p_W - ws->tree.nodes[node].X_WB.p);
}

void GatherApplied(const LoadModel& model, LoadWorkspace* ws) {
  for (Wrenchd& w : ws->applied) w = {};
  for (size_t i = 0; i < model.external.size(); ++i) {
    const ExternalLoad& load = model.external[i];
    const int node = model.tree.NodeOfLink(load.link);
    if (node < 0) continue;
    const Vector3d p_W = ws->tree.nodes[node].X_WB * (model.tree.nodes[node].X_BL * load.p_L);
    ApplyAt(node, ws->external_W[i], p_W, ws);
  }
  if (!model.has_passive) return;
  for (size_t l = 0; l < model.tree.loops.size(); ++l) {
    const LoopState<double>& s = ws->tree.loops[l];
    const JointPlacement& place = model.tree.placements[model.tree.loops[l].joint];
    const Wrenchd W{s.R_WF * ws->cut_passive[l].force, s.R_WF * ws->cut_passive[l].moment};
    ApplyAt(place.second_node, W, s.p_WM, ws);
    ApplyAt(place.first_node, -W, s.p_WM, ws);
  }
}

/// Multipliers from what the dependent freedoms leave open, and everything they load.
void SolveReactions(const LoadModel& model, LoadWorkspace* ws) {
  ws->open = ws->tau - ws->passive;
  TreeJointWrenches(model.tree, ws->tree, &ws->joints);
  for (size_t l = 0; l < model.tree.loops.size(); ++l) {
    const LoopState<double>& s = ws->tree.loops[l];
    ws->joints[model.tree.loops[l].joint].W_M = {s.R_WF * ws->cut_passive[l].force,
                                                 s.R_WF * ws->cut_passive[l].moment};
  }
  ws->reactions.Solve(ws->tree, ws->joints, ws->open.data(), ws->mu.data());
  AddMultiplierWrenches(model.tree, ws->mu.data(), &ws->tree);
  TreeJointWrenches(model.tree, ws->tree, &ws->joints);
  for (size_t l = 0; l < model.tree.loops.size(); ++l) {
    const Loop& loop = model.tree.loops[l];
    const LoopState<double>& s = ws->tree.loops[l];
    const Wrenchd W_F = WrenchOfMultipliers(loop, s, ws->mu.data() + loop.row);
    ws->joints[loop.joint].W_M += {s.R_WF * W_F.force, s.R_WF * W_F.moment};
  }
}

/// One pass from the friction under the joint wrenches of `out` to new joint wrenches there.
void EquilibriumPass(const LoadModel& model, LoadWorkspace* ws, PoseLoads* out) {
  if (model.has_passive) PassiveForces(model, *out, ws);
  GatherApplied(model, ws);
  RecursiveNewtonEuler<double>(model.tree, model.tree.mechanism.gravity_W, ws->applied.data(),
                               &ws->tree);
  GeneralisedForces(model.tree, ws->tree, ws->tau.data());
  if (!model.partition.idle.empty()) SettleIdleFreedoms(model, ws);
  if (model.rule == ReactionRule::kPaperJoint) {
    SolvePaperJoint(model, ws, out);
  } else {
    if (model.hand) ApplyHandWrench(model, ws, out);
    SolveReactions(model, ws);
  }
  for (size_t j = 0; j < ws->joints.size(); ++j) {
    out->joints[j] = ws->joints[j].W_M.In(ws->joints[j].R_WF);
  }
}

/// Reactions and the friction that depends on them: x = G(x) for the joint forces x, by fixed-point
/// iteration with Aitken's relaxation, x += beta r, r = G(x) - x, which converges where the plain
/// iteration swings or creeps. Without a solution the mechanism locks itself.
void FindEquilibrium(const LoadModel& model, LoadWorkspace* ws, PoseLoads* out) {
  for (Wrenchd& w : out->joints) w = {};
  out->jammed = false;
  EquilibriumPass(model, ws, out);
  if (!model.has_load_friction) return;
  double beta = kFirstRelaxation;
  for (size_t j = 0; j < out->joints.size(); ++j) ws->friction_load[j] = out->joints[j].force;
  for (int i = 0; i < kMaxFrictionIterations; ++i) {
    EquilibriumPass(model, ws, out);
    double change = 0, largest = 0, along = 0, across = 0;
    for (size_t j = 0; j < out->joints.size(); ++j) {
      const Vector3d r = out->joints[j].force - ws->friction_load[j];
      const Vector3d dr = r - ws->friction_residual[j];
      change = std::max(change, r.cwiseAbs().maxCoeff());
      largest = std::max(largest, out->joints[j].force.cwiseAbs().maxCoeff());
      along += ws->friction_residual[j].dot(dr);
      across += dr.squaredNorm();
      ws->friction_residual[j] = r;
    }
    if (change <= kFrictionTolerance * largest) return;
    if (i > 0 && across > 0) beta *= -along / across;
    for (size_t j = 0; j < out->joints.size(); ++j) {
      ws->friction_load[j] += beta * ws->friction_residual[j];
      out->joints[j].force = ws->friction_load[j];
    }
  }
  out->jammed = true;
}

void DriveForces(const LoadModel& model, LoadWorkspace* ws, PoseLoads* out) {
  GeneralisedForces(model.tree, ws->tree, ws->tau.data());
  for (size_t k = 0; k < model.drives.size(); ++k) {
    const int v = model.partition.driven[k];
    out->drive_forces[k] = ws->tau[v] - ws->passive[v];
  }
}

}  // namespace

LoadWorkspace::LoadWorkspace(const LoadModel& model)
    : tree(model.tree),
      dependents(model.tree, model.partition),
      reactions(model.tree, model.partition, model.compliances),
      joints(model.tree.mechanism.joints.size()),
      applied(model.tree.nodes.size()),
      cut_passive(model.tree.loops.size()),
      v(VectorXd::Zero(model.tree.nv)),
      vdot(VectorXd::Zero(model.tree.nv)),
      tau(VectorXd::Zero(model.tree.nv)),
      passive(VectorXd::Zero(model.tree.nv)),
      open(VectorXd::Zero(model.tree.nv)),
      mu(VectorXd::Zero(model.tree.rows)),
      friction_load(joints.size(), Vector3d::Zero()),
      friction_residual(joints.size(), Vector3d::Zero()),
      external_W(model.external.size()) {
  const CoordinatePartition& p = model.partition;
  if (model.hand || !p.idle.empty()) {
    motions = MatrixXd::Zero(model.tree.nv, static_cast<int>(p.driven.size() + p.idle.size()));
  }
}

void SizePoseLoads(const LoadModel& model, PoseLoads* out) {
  const Mechanism& mechanism = model.tree.mechanism;
  out->drives.resize(model.drives.size());
  out->drive_forces.resize(model.drives.size());
  out->joints.resize(mechanism.joints.size());
  out->joint_positions.assign(mechanism.joints.size(), Vector3d::Zero());
  out->joint_rates.assign(mechanism.joints.size(), Vector3d::Zero());
  out->links.resize(mechanism.links.size());
}

bool EvaluatePoseLoads(const LoadModel& model, const PoseInput& input, LoadWorkspace* ws,
                       PoseLoads* out) {
  EvaluatePose(model.tree, input.q, &ws->tree);
  ws->dependents.Factor(ws->tree);
  if (ws->dependents.undetermined() > 0) return false;
  out->time = input.time;
  out->drives = input.drives;
  out->closure = LargestLoopError(model.tree, ws->tree);
  out->smallest_pivot = ws->dependents.smallest_pivot();
  if (model.hand) {
    out->hand_error = (input.hand.X_WH.p - GraspPose(model, ws->tree).p).norm();
  }

  CloseVelocities(model, input, ws);
  CloseAccelerations(model, input, ws);
  JointMotions(model, input, *ws, out);
  EvaluateExternalLoads(model, input, *ws, &ws->external_W);
  JointFrames(model.tree, ws->tree, &ws->joints);
  ws->reactions.Factor(ws->tree, ws->joints);
  FindEquilibrium(model, ws, out);
  DriveForces(model, ws, out);
  EvaluatePower(model, *ws, out);
  return true;
}

void EvaluateLinkMotions(const LoadModel& model, const LoadWorkspace& ws, PoseLoads* out) {
  for (size_t i = 0; i < out->links.size(); ++i) {
    LinkMotion& motion = out->links[i];
    motion = LinkMotion{};
    const int index = model.tree.NodeOfLink(static_cast<int>(i));
    if (index < 0) continue;
    const NodeState<double>& s = ws.tree.nodes[index];
    const Vector3d r = s.X_WB.R * model.tree.nodes[index].X_BL.p;
    motion.X_WL = s.X_WB * model.tree.nodes[index].X_BL;
    motion.w = s.w;
    motion.v = s.v + s.w.cross(r);
    motion.alpha = s.alpha;
    motion.a = s.a + s.alpha.cross(r) + s.w.cross(s.w.cross(r));
  }
}

}  // namespace vmech
