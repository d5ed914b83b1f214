#include "vmech/dynamics/loads/pose/pose_loads.h"

#include <algorithm>
#include <cmath>

#include "vmech/base/packet.h"
#include "vmech/dynamics/loads/pose/external_loads.h"
#include "vmech/dynamics/loads/pose/hand_wrench.h"
#include "vmech/dynamics/loads/pose/idle_freedoms.h"
#include "vmech/dynamics/loads/pose/paper_joint.h"
#include "vmech/dynamics/loads/pose/passive_loads.h"
#include "vmech/dynamics/loads/pose/power.h"
#include "vmech/dynamics/loads/pose/resting_friction.h"
#include "vmech/dynamics/rigid_body/newton_euler.h"
#include "vmech/kinematics/loops/loops.h"
#include "vmech/kinematics/tree/forward_kinematics.h"
#include "vmech/kinematics/tree/jacobian.h"

namespace vmech {
namespace {

/// The rotation vector of a unit quaternion (w, x, y, z).
template <typename T>
Vector3<T> RotationVector(const T* wxyz) {
  Vector3<T> turn;
  Vector3d lanes[kLanesOf<T>];
  for (int lane = 0; lane < kLanesOf<T>; ++lane) {
    const Eigen::AngleAxisd rotation(Eigen::Quaterniond(Lane(wxyz[0], lane), Lane(wxyz[1], lane),
                                                        Lane(wxyz[2], lane), Lane(wxyz[3], lane)));
    lanes[lane] = rotation.angle() * rotation.axis();
  }
  for (int k = 0; k < 3; ++k) turn[k] = FromLanes<T>([&](int lane) { return lanes[lane][k]; });
  return turn;
}

template <typename T>
constexpr bool kSinglePose = kLanesOf<T> == 1;

const MotionSample& DriveAt(const LoadModel& model, const Motion& motion, size_t pose, size_t k) {
  return motion.drives[pose * model.drives.size() + k];
}

template <typename T>
void GatherCoordinates(const Motion& motion, size_t pose, LoadWorkspace<T>* ws) {
  for (Eigen::Index i = 0; i < ws->q.size(); ++i) {
    ws->q[i] = FromLanes<T>([&](int lane) { return motion.q(pose + lane)[i]; });
  }
}

/// What the drives prescribe.
template <typename T>
void GatherDrives(const LoadModel& model, const Motion& motion, size_t pose, LoadWorkspace<T>* ws) {
  const CoordinatePartition& partition = model.partition;
  for (size_t k = 0; k < model.drives.size(); ++k) {
    const auto sample = [&](int lane) { return DriveAt(model, motion, pose + lane, k); };
    ws->v[partition.driven[k]] = FromLanes<T>([&](int lane) { return sample(lane).velocity; });
    ws->vdot[partition.driven[k]] =
        FromLanes<T>([&](int lane) { return sample(lane).acceleration; });
  }
}

/// All velocities from those of the drives.
template <typename T>
void CompleteVelocities(const LoadModel& model, LoadWorkspace<T>* ws) {
  for (int v : model.partition.idle) ws->v[v] = T(0);
  ws->dependents.CompleteVelocities(ws->tree, ws->v.data());
}

/// From the velocities of the freedoms to those of the links.
template <typename T>
void MoveLinks(const LoadModel& model, LoadWorkspace<T>* ws) {
  if constexpr (kSinglePose<T>) {
    if (model.idle > 0) RemoveIdleMomentum(model, ws);
  }
  ForwardVelocities(model.tree, ws->v.data(), &ws->tree);
}

template <typename T>
void CloseVelocities(const LoadModel& model, const Motion& motion, size_t pose,
                     LoadWorkspace<T>* ws) {
  if constexpr (kSinglePose<T>) {
    if (model.hand) HandVelocities(model, motion.hand[pose], ws);
  }
  if (!model.hand) CompleteVelocities(model, ws);
  MoveLinks(model, ws);
}

template <typename T>
void CloseAccelerations(const LoadModel& model, const Motion& motion, size_t pose,
                        LoadWorkspace<T>* ws) {
  const CoordinatePartition& partition = model.partition;
  ForwardAccelerations<T>(model.tree, ws->v.data(), nullptr, &ws->tree);
  LoopAccelerationBias(model.tree, &ws->tree);
  if (model.hand) {
    for (int v : partition.driven) ws->vdot[v] = T(0);
  }
  for (int v : partition.idle) ws->vdot[v] = T(0);
  ws->dependents.CompleteAccelerations(ws->tree, ws->vdot.data());
  ForwardAccelerations<T>(model.tree, ws->v.data(), ws->vdot.data(), &ws->tree);
  if constexpr (kSinglePose<T>) {
    if (!model.hand) return;
    HandAccelerations(model, motion.hand[pose], ws);
    ForwardAccelerations<T>(model.tree, ws->v.data(), ws->vdot.data(), &ws->tree);
  }
}

/// Rates of every joint, cut ones included.
template <typename T>
void JointRates(const LoadModel& model, LoadWorkspace<T>* ws) {
  for (const TreeNode& node : model.tree.nodes) {
    Vector3<T>* rate = node.v < 0 ? nullptr : &ws->loads[node.joint].rate;
    for (int k = 0; k < VelocitiesOf(node.motion); ++k) {
      (*rate)[node.freedom + k] = ws->v[node.v + k];
    }
  }
  for (size_t l = 0; l < model.tree.loops.size(); ++l) {
    ws->loads[model.tree.loops[l].joint].rate =
        CutJointRates(model.tree, ws->tree, static_cast<int>(l));
  }
}

/// How the mechanism would move if the drives that stand still began to move one by one: the
/// motions that friction at rest can hold. Uses the velocities as scratch.
void FindCreep(const LoadModel& model, const Motion& motion, size_t pose,
               LoadWorkspace<double>* ws) {
  const std::vector<int> standing = StandingDrives(model, motion, pose);
  ws->creep.resize(model.tree.nv, static_cast<Eigen::Index>(standing.size()));
  ws->creep_rates.clear();
  for (size_t k = 0; k < standing.size(); ++k) {
    ws->v.setZero();
    ws->v[standing[k]] = CreepSpeed(model, standing[k]);
    CompleteVelocities(model, ws);
    MoveLinks(model, ws);
    JointRates(model, ws);
    ws->creep.col(static_cast<Eigen::Index>(k)) = ws->v;
    for (const JointLoad<double>& joint : ws->loads) ws->creep_rates.push_back(joint.rate);
  }
}

/// Coordinates of every joint, cut ones included.
template <typename T>
void JointPositions(const LoadModel& model, const Motion& motion, size_t pose,
                    LoadWorkspace<T>* ws) {
  for (const TreeNode& node : model.tree.nodes) {
    if (node.v < 0) continue;
    JointLoad<T>& joint = ws->loads[node.joint];
    if (node.motion == NodeMotion::kSpherical) {
      joint.position = RotationVector<T>(ws->q.data() + node.q);
    } else {
      joint.position[node.freedom] = ws->q[node.q];
    }
  }
  const size_t loops = model.tree.loops.size();
  for (size_t l = 0; l < loops; ++l) {
    JointLoad<T>& joint = ws->loads[model.tree.loops[l].joint];
    for (int k = 0; k < 3; ++k) {
      joint.position[k] = FromLanes<T>(
          [&](int lane) { return motion.cut_positions[(pose + lane) * loops + l][k]; });
    }
  }
}

template <typename T>
void ApplyAt(int node, const Wrench<T>& W, const Vector3<T>& p_W, LoadWorkspace<T>* ws) {
  if (node >= 0) ws->applied[node] += W.ShiftedBy(p_W - ws->tree.nodes[node].X_WB.p);
}

template <typename T>
void GatherApplied(const LoadModel& model, LoadWorkspace<T>* ws) {
  for (Wrench<T>& w : ws->applied) w = Wrench<T>{};
  for (size_t i = 0; i < model.external.size(); ++i) {
    const ExternalLoad& load = model.external[i];
    const int node = model.tree.NodeOfLink(load.link);
    if (node < 0) continue;
    const Vector3d p_B = model.tree.nodes[node].X_BL * load.p_L;
    const Vector3<T> p_W = ws->tree.nodes[node].X_WB * p_B.cast<T>();
    ApplyAt(node, ws->external_W[i], p_W, ws);
  }
  if (!model.has_passive) return;
  for (size_t l = 0; l < model.tree.loops.size(); ++l) {
    const LoopState<T>& s = ws->tree.loops[l];
    const JointPlacement& place = model.tree.placements[model.tree.loops[l].joint];
    const Wrench<T> W{s.R_WF * ws->cut_passive[l].force, s.R_WF * ws->cut_passive[l].moment};
    ApplyAt(place.second_node, W, s.p_WM, ws);
    ApplyAt(place.first_node, -W, s.p_WM, ws);
  }
}

/// Multipliers from what the dependent freedoms leave open, and everything they load.
template <typename T>
void SolveReactions(const LoadModel& model, LoadWorkspace<T>* ws) {
  ws->open = ws->tau - ws->passive;
  TreeJointWrenches(model.tree, ws->tree, &ws->joints);
  for (size_t l = 0; l < model.tree.loops.size(); ++l) {
    const LoopState<T>& s = ws->tree.loops[l];
    ws->joints[model.tree.loops[l].joint].W_M = {s.R_WF * ws->cut_passive[l].force,
                                                 s.R_WF * ws->cut_passive[l].moment};
  }
  ws->reactions.Solve(ws->tree, ws->joints, ws->open.data(), ws->mu.data());
  AddMultiplierWrenches(model.tree, ws->mu.data(), &ws->tree);
  TreeJointWrenches(model.tree, ws->tree, &ws->joints);
  for (size_t l = 0; l < model.tree.loops.size(); ++l) {
    const Loop& loop = model.tree.loops[l];
    const LoopState<T>& s = ws->tree.loops[l];
    const Wrench<T> W_F = WrenchOfMultipliers(loop, s, ws->mu.data() + loop.row);
    ws->joints[loop.joint].W_M += {s.R_WF * W_F.force, s.R_WF * W_F.moment};
  }
}

/// What the links' motion and everything but multipliers and drives ask along each freedom.
template <typename T>
void LoadTree(const LoadModel& model, LoadWorkspace<T>* ws) {
  GatherApplied(model, ws);
  RecursiveNewtonEuler<T>(model.tree, model.tree.mechanism.gravity_W, ws->applied.data(),
                          &ws->tree);
  GeneralisedForces(model.tree, ws->tree, ws->tau.data());
}

/// One pass from the friction under the joint wrenches of ws->loads to new joint wrenches there.
template <typename T>
void EquilibriumPass(const LoadModel& model, LoadWorkspace<T>* ws) {
  if (model.has_passive) PassiveForces(model, ws);
  LoadTree(model, ws);
  if constexpr (kSinglePose<T>) {
    if (!ws->resting.empty()) {
      HoldByFriction(model, ws);
      SpreadPassive(model, ws);
      LoadTree(model, ws);
    }
    if (model.idle > 0) SettleIdleFreedoms(model, ws);
    if (model.hand && model.rule != ReactionRule::kPaperJoint) ApplyHandWrench(model, ws);
    if (model.rule == ReactionRule::kPaperJoint) SolvePaperJoint(model, ws);
  }
  if (model.rule != ReactionRule::kPaperJoint) SolveReactions(model, ws);
  for (size_t j = 0; j < ws->joints.size(); ++j) {
    ws->loads[j].W_F = ws->joints[j].W_M.In(ws->joints[j].R_WF);
  }
}

template <typename T>
void FindEquilibrium(const LoadModel& model, LoadWorkspace<T>* ws) {
  for (JointLoad<T>& load : ws->loads) load.W_F = Wrench<T>{};
  EquilibriumPass(model, ws);
  if constexpr (kSinglePose<T>) {
    if (!model.has_load_friction) return;
    const bool settled =
        ws->friction.Run(model.tree.length, &ws->loads, [&] { EquilibriumPass(model, ws); });
    ws->locking_joint = LockingJoint(model, *ws, settled);
    ws->jammed = !settled || ws->locking_joint >= 0;
  }
}

template <typename T>
void DriveForces(const LoadModel& model, LoadWorkspace<T>* ws) {
  GeneralisedForces(model.tree, ws->tree, ws->tau.data());
  for (size_t k = 0; k < model.drives.size(); ++k) {
    const int v = model.partition.driven[k];
    ws->drive_forces[k] = ws->tau[v] - ws->passive[v];
  }
}

}  // namespace

bool RunsInPackets(const LoadModel& model) {
  return !model.hand && model.idle == 0 && !model.has_load_friction &&
         model.rule != ReactionRule::kPaperJoint;
}

template <typename T>
bool EvaluatePoseLoads(const LoadModel& model, const Motion& motion, size_t pose,
                       LoadWorkspace<T>* ws) {
  if (!kSinglePose<T> && model.has_dry_friction && AnyStands(model, motion, pose, kLanesOf<T>)) {
    return false;
  }
  GatherCoordinates(motion, pose, ws);
  EvaluatePose(model.tree, ws->q.data(), &ws->tree);
  ws->dependents.Factor(ws->tree);
  if (!AllLanes(ws->dependents.smallest_pivot() > T(0))) return false;
  ws->closure = LargestLoopError(model.tree, ws->tree);
  if constexpr (kSinglePose<T>) {
    if (ws->motions.size() > 0) FindMotions(model, ws);
    if (model.has_dry_friction) FindCreep(model, motion, pose, ws);
  }
  GatherDrives(model, motion, pose, ws);
  CloseVelocities(model, motion, pose, ws);
  JointRates(model, ws);
  JointPositions(model, motion, pose, ws);
  if (model.has_dry_friction) FindContacts(model, motion, ws);
  CloseAccelerations(model, motion, pose, ws);
  EvaluateExternalLoads(model, motion, pose, ws);
  JointFrames(model.tree, ws->tree, &ws->joints);
  ws->reactions.Factor(ws->tree, ws->joints);
  FindEquilibrium(model, ws);
  DriveForces(model, ws);
  EvaluatePower(model, ws);
  return true;
}

// NOLINTBEGIN(bugprone-macro-parentheses): T is a type
#define VMECH_INSTANTIATE(T) \
  template bool EvaluatePoseLoads<T>(const LoadModel&, const Motion&, size_t, LoadWorkspace<T>*);
VMECH_INSTANTIATE(double)
VMECH_INSTANTIATE(Packet)
#undef VMECH_INSTANTIATE
// NOLINTEND(bugprone-macro-parentheses)

}  // namespace vmech
