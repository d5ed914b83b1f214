#include "vmech/dynamics/loads/pose/pose_loads.h"

#include <algorithm>
#include <cmath>

#include "vmech/base/dual.h"
#include "vmech/base/lanes4.h"
#include "vmech/base/screw_algebra.h"
#include "vmech/base/tape/taped4.h"
#include "vmech/dynamics/loads/pose/external_loads.h"
#include "vmech/dynamics/loads/pose/hand_wrench.h"
#include "vmech/dynamics/loads/pose/idle_freedoms.h"
#include "vmech/dynamics/loads/pose/paper_joint.h"
#include "vmech/dynamics/loads/pose/passive_loads.h"
#include "vmech/dynamics/loads/pose/power.h"
#include "vmech/dynamics/loads/pose/resting_friction.h"
#include "vmech/dynamics/rigid_body/newton_euler.h"
#include "vmech/kinematics/loops/cut_joint.h"
#include "vmech/kinematics/loops/loops.h"
#include "vmech/kinematics/tree/forward_kinematics.h"

namespace vmech {
namespace {

template <typename T>
constexpr bool kIsPlain = std::is_same_v<T, double>;  // one pose, without slopes
template <typename T>
constexpr bool kIsOnePose = kLanesOf<T> == 1;
template <typename T>
constexpr bool kHasSlopes = kIsDual<T> || kIsTaped<T>;

/// With the slopes of `of`.
template <typename N>
DualOf<N> WithValue(const N& value, const DualOf<N>& of) {
  return {value, of.slope};
}
template <typename N>
TapedOf<N> WithValue(const N& value, const TapedOf<N>& of) {
  return {value, of.tape, of.index};
}

/// Position, velocity or acceleration (0, 1, 2) that drive k prescribes at the poses `pose`, ...;
/// with its slopes.
template <typename T>
T Prescribed(const LoadModel& model, const Motion& motion, size_t pose, size_t k, size_t part,
             const LoadWorkspace<T>& ws) {
  constexpr double MotionSample::*kParts[] = {&MotionSample::position, &MotionSample::velocity,
                                              &MotionSample::acceleration};
  if constexpr (kIsTaped<T>) {
    return ws.on_tape->drives[k][part];
  } else {
    return FromLanes<T>([&](int lane) {
      const size_t at = (pose + lane) * model.drives.size() + k;
      const double value = motion.drives[at].*kParts[part];
      if constexpr (kIsDual<T>) {
        const bool slopes = ws.slopes != nullptr && !ws.slopes->drives.empty();
        return Dual(value, slopes ? ws.slopes->drives[at].*kParts[part] : 0.0);
      } else {
        return value;
      }
    });
  }
}

template <typename T>
void GatherCoordinates(const LoadModel& model, const Motion& motion, size_t pose,
                       LoadWorkspace<T>* ws) {
  for (Eigen::Index i = 0; i < ws->q.size(); ++i) {
    ws->q[i] = FromLanes<T>([&](int lane) { return motion.q(pose + lane)[i]; });
  }
  if constexpr (kHasSlopes<T>) {
    for (size_t k = 0; k < model.drives.size(); ++k) {
      const JointDrive& drive = model.drives[k];
      T& q = ws->q[CoordinateIndex(model.tree, drive.joint, drive.freedom)];
      q = WithValue(q.value, Prescribed(model, motion, pose, k, 0, *ws));
    }
  }
}

template <typename T>
void FactorPose(const LoadModel& model, LoadWorkspace<T>* ws) {
  EvaluatePose(model.tree, ws->q.data(), &ws->tree);
  ws->dependents.Factor(ws->tree);
}

/// How the closed pose goes along with the numbers of the design: one step of Newton's, which at a
/// closed pose moves slopes alone (implicit differentiation, C dq = e2).
template <typename T>
void CloseSlopes(const LoadModel& model, LoadWorkspace<T>* ws) {
  if constexpr (kIsDual<T>) ws->closing = LargestOpening(model.tree, ws->tree);
  ws->dependents.StepCoordinates(ws->tree, ws->q.data());
  FactorPose(model, ws);
  if constexpr (kIsDual<T>) ws->opening = LargestOpening(model.tree, ws->tree);
}

template <typename T>
void ClosePose(const LoadModel& model, LoadWorkspace<T>* ws) {
  if constexpr (kIsTaped<T>) {
    // Slopes of C and its factors would be those of a step that is nothing.
    EvaluatePose(model.tree, ws->q.data(), &ws->tree, false);
    ws->on_tape->tape->Pause(true);
    LoopJacobian(model.tree, &ws->tree);
    ws->dependents.Factor(ws->tree);
    ws->on_tape->tape->Pause(false);
  } else {
    FactorPose(model, ws);
  }
  if constexpr (kHasSlopes<T>) CloseSlopes(model, ws);
}

/// What the drives prescribe.
template <typename T>
void GatherDrives(const LoadModel& model, const Motion& motion, size_t pose, LoadWorkspace<T>* ws) {
  const CoordinatePartition& partition = model.partition;
  for (size_t k = 0; k < model.drives.size(); ++k) {
    ws->v[partition.driven[k]] = Prescribed(model, motion, pose, k, 1, *ws);
    ws->vdot[partition.driven[k]] = Prescribed(model, motion, pose, k, 2, *ws);
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
  if constexpr (kIsOnePose<T>) {
    if (model.idle > 0) RemoveIdleMomentum(model, ws);
  }
  ForwardVelocities(model.tree, ws->v.data(), &ws->tree);
}

template <typename T>
void CloseVelocities(const LoadModel& model, const Motion& motion, size_t pose,
                     LoadWorkspace<T>* ws) {
  if constexpr (kIsPlain<T>) {
    if (model.hand) HandVelocities(model, motion.hand[pose], ws);
  }
  if (!model.hand) CompleteVelocities(model, ws);
  MoveLinks(model, ws);
}

template <typename T>
void CloseAccelerations(const LoadModel& model, const Motion& motion, size_t pose,
                        LoadWorkspace<T>* ws) {
  const CoordinatePartition& partition = model.partition;
  VelocityProducts(model.tree, &ws->tree);
  LoopAccelerationBias(model.tree, &ws->tree);
  if (model.hand) {
    for (int v : partition.driven) ws->vdot[v] = T(0);
  }
  for (int v : partition.idle) ws->vdot[v] = T(0);
  ws->dependents.CompleteAccelerations(ws->tree, ws->vdot.data());
  ForwardAccelerations(model.tree, ws->vdot.data(), &ws->tree);
  if constexpr (kIsPlain<T>) {
    if (!model.hand) return;
    HandAccelerations(model, motion.hand[pose], ws);
    ForwardAccelerations(model.tree, ws->vdot.data(), &ws->tree);
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
    JointRates(model.tree, ws->tree, ws->v.data(), &ws->loads);
    ws->creep.col(static_cast<Eigen::Index>(k)) = ws->v;
    for (const JointLoad<double>& joint : ws->loads) ws->creep_rates.push_back(joint.rate);
  }
}

/// Coordinates of every joint; those of cut joints as the motion has unwrapped them.
template <typename T>
void PositionJoints(const LoadModel& model, const Motion& motion, size_t pose,
                    LoadWorkspace<T>* ws) {
  TreeJointPositions(model.tree, ws->q.data(), &ws->loads);
  const size_t loops = model.tree.loops.size();
  for (size_t l = 0; l < loops; ++l) {
    JointLoad<T>& joint = ws->loads[model.tree.loops[l].joint];
    for (int k = 0; k < 3; ++k) {
      joint.position[k] = FromLanes<T>(
          [&](int lane) { return motion.cut_positions[(pose + lane) * loops + l][k]; });
    }
    if constexpr (kHasSlopes<T>) {
      const Vector3<T> here = CutJointCoordinates(model.tree.loops[l], ws->tree.loops[l]);
      for (int k = 0; k < 3; ++k) {
        joint.position[k] = WithValue(joint.position[k].value, here[k]);
      }
    }
  }
}

/// Multipliers from what the dependent freedoms leave open, and everything they load.
template <typename T>
void SolveReactions(const LoadModel& model, LoadWorkspace<T>* ws) {
  ws->open = ws->tau - ws->passive;
  TreeJointWrenches(model.tree, ws->tree, &ws->joints);
  std::vector<LoopState<T>>& loops = ws->tree.loops;
  const auto passive = [&](size_t l) { return WrenchFrom(loops[l].F, ws->cut_passive[l]); };
  for (size_t l = 0; l < loops.size(); ++l) {
    ws->joints[model.tree.loops[l].joint].W = passive(l);
  }
  ws->reactions.Solve(ws->joints, ws->open.data(), ws->mu.data());
  ApplyMultipliers(model.tree, ws->mu.data(), &ws->tree, &ws->joints);
  for (size_t l = 0; model.has_passive && l < loops.size(); ++l) {
    ws->joints[model.tree.loops[l].joint].W += passive(l);
  }
}

/// What the links' motion and everything but multipliers and drives ask along each freedom.
template <typename T>
void LoadTree(const LoadModel& model, LoadWorkspace<T>* ws) {
  GatherApplied(model, ws);
  NewtonEuler(model.tree, ws->inertias, ws->applied.data(), &ws->tree, ws->tau.data());
}

template <typename T>
void FindEquilibrium(const LoadModel& model, LoadWorkspace<T>* ws) {
  for (JointLoad<T>& load : ws->loads) load.W_F = Wrench<T>{};
  EquilibriumPass(model, ws);
  if constexpr (kIsOnePose<T>) {
    if (!model.has_load_friction) return;
    const bool settled =
        ws->friction.Run(model.tree.length, &ws->loads, [&] { EquilibriumPass(model, ws); });
    if constexpr (kIsPlain<T>) ws->locking_joint = LockingJoint(model, *ws, settled);
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

template <typename T>
void GatherApplied(const LoadModel& model, LoadWorkspace<T>* ws) {
  for (ScrewT<T>& w : ws->applied) w = {};
  const auto apply = [&](int node, const ScrewT<T>& W) {
    if (node >= 0) ws->applied[node] += W;
  };
  for (size_t i = 0; i < model.external.size(); ++i) {
    apply(model.tree.NodeOfLink(model.external[i].link), ws->external[i]);
  }
  if (!model.has_passive) return;
  for (size_t l = 0; l < model.tree.loops.size(); ++l) {
    const JointPlacement& place = model.tree.placements[model.tree.loops[l].joint];
    const ScrewT<T> W = WrenchFrom(ws->tree.loops[l].F, ws->cut_passive[l]);
    apply(place.second_node, W);
    apply(place.first_node, -1.0 * W);
  }
}

template <typename T>
void EquilibriumPass(const LoadModel& model, LoadWorkspace<T>* ws) {
  if (model.has_passive) PassiveForces(model, ws);
  LoadTree(model, ws);
  if constexpr (kIsPlain<T>) {
    if (!ws->resting.empty()) {
      HoldByFriction(model, ws);
      SpreadPassive(model, ws);
      LoadTree(model, ws);
    }
  }
  if constexpr (kIsOnePose<T>) {
    if (model.idle > 0) SettleIdleFreedoms(model, ws);
  }
  if constexpr (kIsPlain<T>) {
    if (model.hand && model.rule != ReactionRule::kPaperJoint) ApplyHandWrench(model, ws);
    if (model.rule == ReactionRule::kPaperJoint) SolvePaperJoint(model, ws);
  }
  if (model.rule != ReactionRule::kPaperJoint) SolveReactions(model, ws);
  for (size_t j = 0; j < ws->joints.size(); ++j) {
    ws->loads[j].W_F = WrenchIn(ws->joints[j].F, ws->joints[j].W);
  }
}

bool RunsInLanes(const LoadModel& model) {
  return !model.hand && model.idle == 0 && !model.has_load_friction &&
         model.rule != ReactionRule::kPaperJoint;
}

template <typename T>
bool EvaluatePoseLoads(const LoadModel& model, const Motion& motion, size_t pose,
                       LoadWorkspace<T>* ws) {
  if (!kIsPlain<T> && model.has_dry_friction && AnyStands(model, motion, pose, kLanesOf<T>)) {
    return false;
  }
  GatherCoordinates(model, motion, pose, ws);
  ClosePose(model, ws);
  if (!AllLanes(ws->dependents.smallest_pivot() > T(0))) return false;
  if constexpr (!kIsTaped<T>) ws->closure = LargestLoopError(model.tree, ws->tree);
  if constexpr (kIsOnePose<T>) {
    if (ws->motions.size() > 0) FindMotions(model, ws);
  }
  if constexpr (kIsPlain<T>) {
    if (model.has_dry_friction) FindCreep(model, motion, pose, ws);
  }
  GatherDrives(model, motion, pose, ws);
  CloseVelocities(model, motion, pose, ws);
  JointRates(model.tree, ws->tree, ws->v.data(), &ws->loads);
  PositionJoints(model, motion, pose, ws);
  if (model.has_dry_friction) FindContacts(model, motion, ws);
  CloseAccelerations(model, motion, pose, ws);
  EvaluateExternalLoads(model, motion, pose, ws);
  BodyInertias(model.tree, ws->tree, &ws->inertias);
  GyroscopicWrenches(model.tree, ws->inertias, &ws->tree);
  JointFrames(model.tree, ws->tree, &ws->joints);
  ws->reactions.Factor(ws->tree, ws->joints);
  FindEquilibrium(model, ws);
  DriveForces(model, ws);
  if constexpr (!kIsTaped<T>) {
    JointAccelerations(model.tree, ws->tree, ws->vdot.data(), &ws->loads);
    EvaluatePower(model, ws);
  }
  return true;
}

// NOLINTBEGIN(bugprone-macro-parentheses): T is a type
#define VMECH_INSTANTIATE(T)                                             \
  template void GatherApplied<T>(const LoadModel&, LoadWorkspace<T>*);   \
  template void EquilibriumPass<T>(const LoadModel&, LoadWorkspace<T>*); \
  template bool EvaluatePoseLoads<T>(const LoadModel&, const Motion&, size_t, LoadWorkspace<T>*);
VMECH_INSTANTIATE(double)
VMECH_INSTANTIATE(Dual)
VMECH_INSTANTIATE(Taped4)
VMECH_INSTANTIATE(Lanes4)
#undef VMECH_INSTANTIATE
// NOLINTEND(bugprone-macro-parentheses)

}  // namespace vmech
