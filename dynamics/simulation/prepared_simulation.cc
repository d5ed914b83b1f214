#include "vmech/dynamics/simulation/prepared_simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "vmech/base/linear_algebra/linear_algebra.h"
#include "vmech/dynamics/rigid_body/passive.h"
#include "vmech/kinematics/loops/assembled_mechanism.h"
#include "vmech/kinematics/loops/dimensionless_loops.h"

namespace vmech {
namespace {

bool IsLimited(const Joint& joint) {
  const auto finite = [](double limit) { return std::isfinite(limit); };
  return std::any_of(joint.lower.begin(), joint.lower.end(), finite) ||
         std::any_of(joint.upper.begin(), joint.upper.end(), finite);
}

bool IsPassive(const Joint& joint) {
  return HasDryFriction(joint) ||
         std::any_of(joint.passive.begin(), joint.passive.end(), [](const Passive& passive) {
           return passive.stiffness != 0 || passive.viscous != 0;
         });
}

SpanningTreeOptions Cuts(const Simulation& simulation) {
  SpanningTreeOptions cuts;
  for (const JointDrive& drive : simulation.drives) cuts.keep.push_back(drive.joint);
  for (const JointMotor& motor : simulation.motors) cuts.prefer.push_back(motor.at.joint);
  for (const CoordinateWatch& watch : simulation.watches) cuts.prefer.push_back(watch.at.joint);
  const std::vector<Joint>& joints = simulation.mechanism.joints;
  for (size_t j = 0; j < joints.size(); ++j) {
    if (IsLimited(joints[j]) || IsPassive(joints[j])) cuts.prefer.push_back(static_cast<int>(j));
  }
  return cuts;
}

/// Moments of inertia that are rounding beside those of the mechanism [kg m^2].
double NoInertia(const KinematicTree& tree) {
  constexpr double kRounding = 1e-12;
  double mass = 0;
  for (const TreeNode& node : tree.nodes) mass += node.mass;
  return kRounding * mass * tree.length * tree.length;
}

/// Constant loads, whose wrenches are filled in as time goes.
std::vector<ExternalLoad> LoadsToFillIn(const Simulation& simulation) {
  std::vector<ExternalLoad> loads = simulation.external;
  if (simulation.hand) {
    const Grasp& grasp = simulation.mechanism.grasps[simulation.hand->grasp];
    ExternalLoad hand;
    hand.link = grasp.link;
    hand.p_L = grasp.X_LG.p;
    loads.push_back(hand);
  }
  for (ExternalLoad& load : loads) {
    load.over = ExternalLoad::Over::kConstant;
    load.at.clear();
    load.wrenches.assign(1, {});
  }
  return loads;
}

void FindTableCoordinate(Simulation* simulation) {
  const bool asked = std::any_of(
      simulation->external.begin(), simulation->external.end(),
      [](const ExternalLoad& load) { return load.over == ExternalLoad::Over::kDriveCoordinate; });
  if (!asked) {
    simulation->table_coordinate.reset();
  } else if (!simulation->table_coordinate && !simulation->drives.empty()) {
    simulation->table_coordinate = {simulation->drives[0].joint, simulation->drives[0].freedom};
  } else if (!simulation->table_coordinate && !simulation->motors.empty()) {
    simulation->table_coordinate = simulation->motors[0].at;
  }
}

void FillModel(PreparedSimulation* prepared) {
  const Simulation& simulation = prepared->simulation;
  LoadModel& model = prepared->model;
  const double length = simulation.norm_length > 0 ? simulation.norm_length : model.tree.length;
  model.compliances = CompliancesForRule(model.tree, simulation.rule, length);
  model.external = LoadsToFillIn(simulation);
  model.rule = simulation.rule;
  model.no_inertia = NoInertia(model.tree);
  const std::vector<Joint>& joints = simulation.mechanism.joints;
  model.has_passive = HasPassiveJoints(simulation.mechanism) || !simulation.motors.empty() ||
                      std::any_of(joints.begin(), joints.end(), IsLimited);
  for (const int v : model.partition.driven) {
    JointDrive drive;
    for (const TreeNode& node : model.tree.nodes) {
      if (node.v < 0 || v < node.v || v >= node.v + VelocitiesOf(node.motion)) continue;
      drive.joint = node.joint;
      drive.freedom = node.freedom + v - node.v;
    }
    model.drives.push_back(drive);
  }
}

/// The drives stand where their laws begin.
void SetDriveStarts(Simulation* simulation) {
  for (const JointDrive& drive : simulation->drives) {
    Joint& joint = simulation->mechanism.joints[drive.joint];
    joint.start[drive.freedom] = drive.law.At(simulation->times.front()).position;
    joint.start_given = true;
  }
}

std::vector<int> DrivenJoints(const Simulation& simulation) {
  std::vector<int> joints;
  for (const JointDrive& drive : simulation.drives) joints.push_back(drive.joint);
  return joints;
}

}  // namespace

std::vector<int> DrivenVelocities(const Simulation& simulation, const KinematicTree& tree) {
  std::vector<int> driven;
  for (const JointDrive& drive : simulation.drives) {
    driven.push_back(VelocityIndex(tree, drive.joint, drive.freedom));
  }
  return driven;
}

CoordinatePartition ChooseFreedoms(const KinematicTree& tree, const VectorXd& q,
                                   const std::vector<int>& driven, double tolerance) {
  MatrixXd free = FindNullSpace(DimensionlessLoopJacobian(tree, q), tolerance).basis;
  std::vector<int> chosen = driven;
  const auto drives = static_cast<Eigen::Index>(driven.size());
  if (drives > 0) {
    MatrixXd rows(drives, free.cols());
    for (Eigen::Index k = 0; k < drives; ++k)
      rows.row(k) = free.row(driven[static_cast<size_t>(k)]);
    const NullSpace left = FindNullSpace(rows, kRankTolerance);
    if (left.rank < drives) PartitionForDrives(tree, q, driven);  // says what is wrong
    free *= left.basis;
  }
  if (free.cols() > 0) {
    for (const int v : MostIndependentRows(free, static_cast<int>(free.cols())))
      chosen.push_back(v);
  }
  return MakePartition(tree, chosen, {});
}

PreparedSimulation PrepareSimulation(const Simulation& simulation) {
  RequireValid(simulation);
  PreparedSimulation prepared;
  prepared.simulation = simulation;
  FindTableCoordinate(&prepared.simulation);
  SetDriveStarts(&prepared.simulation);
  AssembleOptions assembling;
  assembling.fixed_joints = DrivenJoints(simulation);
  const AssembledMechanism assembled = RequireAssembled(prepared.simulation.mechanism, assembling);
  prepared.notes = assembled.Notes();
  prepared.closure_tolerance = assembled.closure_tolerance;
  LoadModel& model = prepared.model;
  model.rounding = assembled.correction;
  model.tree = BuildKinematicTree(assembled.mechanism, Cuts(simulation));
  prepared.q = StartCoordinates(model.tree);
  prepared.mobility = AnalyseMobility(model.tree, prepared.q);
  model.partition = ChooseFreedoms(model.tree, prepared.mobility.q_general,
                                   DrivenVelocities(simulation, model.tree), kRankTolerance);
  FillModel(&prepared);
  return prepared;
}

}  // namespace vmech
