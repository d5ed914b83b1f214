#include "vmech/dynamics/simulation/equations/acting_forces.h"

#include <algorithm>
#include <cmath>

#include "vmech/base/screw_algebra.h"
#include "vmech/dynamics/loads/pose/external_loads.h"
#include "vmech/dynamics/loads/pose/passive_loads.h"
#include "vmech/dynamics/loads/pose/pose_loads.h"
#include "vmech/dynamics/rigid_body/passive.h"
#include "vmech/kinematics/loops/cut_joint.h"
#include "vmech/kinematics/tree/forward_kinematics.h"
#include "vmech/kinematics/tree/grasp_frame.h"
#include "vmech/mechanisms/freedoms.h"

namespace vmech {
namespace {

HandSample HandAt(const GraspSpring& spring, double time) {
  return spring.hand ? spring.hand(time) : spring.law.At(time);
}

MovingFrame MovingFrameOf(const HandSample& hand) {
  return {FrameOf(hand.X_WH), ScrewOf(hand.V_WH)};
}

/// Does a freedom's coordinate or rate count for what acts on the mechanism?
bool Counts(const Simulation& simulation, const Joint& joint, FreedomId at) {
  const auto is_here = [at](const FreedomId& other) {
    return other.joint == at.joint && other.freedom == at.freedom;
  };
  const size_t k = static_cast<size_t>(at.freedom);
  const bool passive = k < joint.passive.size() && HasPassive(joint.passive[k]);
  const bool limited = std::isfinite(joint.lower[k]) || std::isfinite(joint.upper[k]);
  return passive || limited ||
         (simulation.table_coordinate && is_here(*simulation.table_coordinate)) ||
         std::any_of(simulation.motors.begin(), simulation.motors.end(),
                     [&](const JointMotor& motor) { return is_here(motor.at); });
}

}  // namespace

ActingForces::ActingForces(const Simulation& simulation, LoadModel* model)
    : simulation_(simulation),
      model_(*model),
      exerted_(model->tree.mechanism.joints.size(), Vector3d::Zero()),
      motor_forces_(simulation.motors.size(), 0.0),
      cut_positions_(StartCutPositions(model->tree)) {
  if (simulation.hand) {
    const Grasp& grasp = simulation.mechanism.grasps[simulation.hand->grasp];
    coupling_.emplace_back(simulation.hand->coupling, grasp.kind, 0.0);
  }
  ListJoints();
}

void ActingForces::ListJoints() {
  const KinematicTree& tree = model_.tree;
  const std::vector<Joint>& joints = tree.mechanism.joints;
  for (size_t j = 0; j < joints.size(); ++j) {
    const Joint& joint = joints[j];
    if (!joint.passive.empty()) passive_joints_.push_back(static_cast<int>(j));
    if (HasDryFriction(joint)) all_in_tree_ = false;
    for (int k = 0; k < FreedomsOf(joint.type); ++k) {
      const FreedomId at{static_cast<int>(j), k};
      if (!Counts(simulation_, joint, at)) continue;
      const int v = VelocityIndex(tree, at.joint, k);
      all_in_tree_ = all_in_tree_ && v >= 0 && joint.type != JointType::kSpherical;
      if (!all_in_tree_) continue;
      const Passive passive =
          joint.passive.empty() ? Passive{} : joint.passive[static_cast<size_t>(k)];
      tree_freedoms_.push_back({at, CoordinateIndex(tree, at.joint, k), v, passive});
    }
  }
}

void ActingForces::Remember(const ConstrainedMotion& motion) {
  ContinueCutPositions(model_.tree, motion.ws().tree, &cut_positions_);
}

void ActingForces::FindJoints(ConstrainedMotion* motion) {
  LoadWorkspace<double>& ws = motion->ws();
  TreeJointPositions(model_.tree, ws.q.data(), &ws.loads);
  JointRates(model_.tree, ws.tree, ws.v.data(), &ws.loads);
  here_ = cut_positions_;
  ContinueCutPositions(model_.tree, ws.tree, &here_);
  for (size_t l = 0; l < here_.size(); ++l) {
    ws.loads[model_.tree.loops[l].joint].position = here_[l];
  }
}

void ActingForces::FindJointsThatCount(ConstrainedMotion* motion) {
  if (!all_in_tree_) return FindJoints(motion);
  LoadWorkspace<double>& ws = motion->ws();
  for (const TreeFreedom& freedom : tree_freedoms_) {
    JointLoad<double>& joint = ws.loads[freedom.at.joint];
    joint.position[freedom.at.freedom] = ws.q[freedom.q];
    joint.rate[freedom.at.freedom] = ws.v[freedom.v];
  }
}

double ActingForces::TableArgument(const ExternalLoad& load, double time,
                                   const ConstrainedMotion& motion) const {
  if (load.over == ExternalLoad::Over::kTime) return time;
  if (load.over == ExternalLoad::Over::kConstant) return 0;
  const FreedomId& at = *simulation_.table_coordinate;
  return motion.ws().loads[at.joint].position[at.freedom];
}

void ActingForces::ApplyExternal(double time, ConstrainedMotion* motion) {
  for (size_t i = 0; i < simulation_.external.size(); ++i) {
    const ExternalLoad& load = simulation_.external[i];
    model_.external[i].wrenches[0] = WrenchAt(load, TableArgument(load, time, *motion));
  }
  if (simulation_.hand) ApplyHand(time, *motion);
  EvaluateExternalLoads(model_, none_, 0, &motion->ws());
}

void ActingForces::ApplyHand(double time, const ConstrainedMotion& motion) {
  const GraspFrame grasp = GraspFrameOf(model_.tree, simulation_.hand->grasp);
  const TreeWorkspace<double>& ws = motion.ws().tree;
  const Posed X_WG = PoseInWorld(ws, grasp.node, grasp.X_BG);
  coupling_[0].Stretch(FrameOf(X_WG), MovingFrameOf(HandAt(*simulation_.hand, time)));
  coupling_[0].Pull(ScrewOf(GraspTwist(ws, grasp.node, grasp.X_BG)));
  model_.external.back().wrenches[0] = hand();
}

void ActingForces::RunMotors(double time, const ConstrainedMotion& motion) {
  for (Vector3d& exerted : exerted_) exerted.setZero();
  for (size_t i = 0; i < motor_forces_.size(); ++i) {
    const JointMotor& motor = simulation_.motors[i];
    const JointLoad<double>& joint = motion.ws().loads[motor.at.joint];
    double force = 0;
    if (motor.law == JointMotor::Law::kForce) {
      force = motor.force.At(time);
    } else {
      const MotionSample wanted = motor.wanted.At(time);
      force = motor.stiffness * (wanted.position - joint.position[motor.at.freedom]) +
              motor.damping * (wanted.velocity - joint.rate[motor.at.freedom]);
    }
    motor_forces_[i] = std::clamp(force, -motor.max_force, motor.max_force);
    exerted_[motor.at.joint][motor.at.freedom] += motor_forces_[i];
  }
}

void ActingForces::Evaluate(double time, ConstrainedMotion* motion) {
  if (!model_.external.empty()) ApplyExternal(time, motion);
  RunMotors(time, *motion);
}

void ActingForces::Apply(ConstrainedMotion* motion) const {
  LoadWorkspace<double>& ws = motion->ws();
  if (all_in_tree_) {
    ActAlongTree(&ws);
  } else if (model_.has_passive) {
    ws.exerted = exerted_.data();
    PassiveForces(model_, &ws);
  }
  GatherApplied(model_, &ws);
}

void ActingForces::ActAlongTree(LoadWorkspace<double>* ws) const {
  for (const auto& [at, q, v, passive] : tree_freedoms_) {
    const double force = exerted_[at.joint][at.freedom] + SpringForce(passive, ws->q[q], ws->v[v]);
    ws->passive[v] = ws->along[at.joint][at.freedom] = force;
  }
}

std::vector<Vector3d> ActingForces::BesideSprings(const ConstrainedMotion& motion) const {
  std::vector<Vector3d> beside(exerted_.size(), Vector3d::Zero());
  for (size_t j = 0; model_.has_passive && j < beside.size(); ++j) {
    const std::vector<Passive>& passive = model_.tree.mechanism.joints[j].passive;
    const JointLoad<double>& load = motion.ws().loads[j];
    beside[j] = motion.ws().along[j];
    for (int k = 0; k < static_cast<int>(passive.size()); ++k) {
      beside[j][k] -= SpringForce(passive[k], load.position[k], load.rate[k]);
    }
  }
  return beside;
}

Wrenchd ActingForces::hand() const {
  if (coupling_.empty()) return {};
  return {Vector3Of(coupling_[0].w().linear), Vector3Of(coupling_[0].w().angular)};
}

double ActingForces::SuppliedPower(const ConstrainedMotion& motion) const {
  const LoadWorkspace<double>& ws = motion.ws();
  double power = 0;
  for (size_t i = 0; i < model_.external.size(); ++i) {
    const int node = model_.tree.NodeOfLink(model_.external[i].link);
    if (node >= 0) power += Power(ws.external[i], ws.tree.at(node).V);
  }
  for (size_t i = 0; i < motor_forces_.size(); ++i) {
    const FreedomId& at = simulation_.motors[i].at;
    power += motor_forces_[i] * ws.loads[at.joint].rate[at.freedom];
  }
  return power;
}

double ActingForces::LostPower(const ConstrainedMotion& motion) const {
  const LoadWorkspace<double>& ws = motion.ws();
  double power = 0;
  for (const int j : passive_joints_) {
    const Joint& joint = model_.tree.mechanism.joints[j];
    const JointLoad<double>& load = ws.loads[j];
    for (size_t k = 0; k < joint.passive.size(); ++k) {
      const int i = static_cast<int>(k);
      const Passive& passive = joint.passive[k];
      const double spring = -passive.stiffness * (load.position[i] - passive.rest);
      power -= (ws.along[j][i] - spring - exerted_[j][i]) * load.rate[i];
    }
  }
  return power;
}

double ActingForces::SpringEnergy(const ConstrainedMotion& motion) const {
  double energy = 0;
  for (const int j : passive_joints_) {
    const Joint& joint = model_.tree.mechanism.joints[j];
    for (size_t k = 0; k < joint.passive.size(); ++k) {
      const double length =
          motion.ws().loads[j].position[static_cast<int>(k)] - joint.passive[k].rest;
      energy += 0.5 * joint.passive[k].stiffness * length * length;
    }
  }
  return energy;
}

Motion ActingForces::PoseOf(double time, const ConstrainedMotion& motion) const {
  const LoadWorkspace<double>& ws = motion.ws();
  Motion pose;
  pose.times = {time};
  pose.coordinates.assign(ws.q.data(), ws.q.data() + ws.q.size());
  for (const int v : model_.partition.driven) pose.drives.push_back({0, ws.v[v], ws.vdot[v]});
  pose.cut_positions.assign(cut_positions_.begin(), cut_positions_.end());
  return pose;
}

}  // namespace vmech
