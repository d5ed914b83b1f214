#include "vmech/dynamics/load_model.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

#include "vmech/dynamics/hand_wrench.h"
#include "vmech/dynamics/idle_freedoms.h"
#include "vmech/dynamics/passive.h"
#include "vmech/kinematics/assembly.h"
#include "vmech/kinematics/jacobian.h"

namespace vmech {
namespace {

void RequireDrive(const LoadStudy& study) {
  if (!study.drives.empty() && study.hand) {
    throw std::invalid_argument(
        "a study has joint drives or a hand, not both; give `motion` joints or a grasp");
  }
  if (study.times.empty()) throw std::invalid_argument("the study has no poses; give `steps`");
  for (const JointDrive& drive : study.drives) {
    const Joint& joint = study.mechanism.joints.at(drive.joint);
    if (joint.type == JointType::kSpherical || joint.type == JointType::kWeld) {
      throw std::invalid_argument(fmt::format(
          "joint '{}' is {}; drive a joint with single freedoms, or move the mechanism by a grasp",
          joint.name, NameOf(joint.type)));
    }
    if (drive.freedom < 0 || drive.freedom >= FreedomsOf(joint.type)) {
      throw std::invalid_argument(fmt::format("joint '{}' has freedoms 1..{}, not {}", joint.name,
                                              FreedomsOf(joint.type), drive.freedom + 1));
    }
  }
  for (const ExternalLoad& load : study.external) {
    if (load.over == ExternalLoad::Over::kDriveCoordinate && study.drives.empty()) {
      throw std::invalid_argument(
          "an external load is a table over the drive coordinate, but the hand drives; give it "
          "over "
          "time `t`");
    }
  }
}

std::vector<int> DrivenVelocities(const LoadStudy& study, const KinematicTree& tree) {
  std::vector<int> driven;
  for (const JointDrive& drive : study.drives) {
    driven.push_back(VelocityIndex(tree, drive.joint, drive.freedom));
  }
  return driven;
}

Vector6d HandWeights(const LoadStudy& study, double length) {
  Vector6d K = study.hand->stiffness;
  if (K.isZero()) {
    K.head<3>().setOnes();
    K.tail<3>().setConstant(length * length);
  }
  if (study.mechanism.grasps[study.hand->grasp].kind == GraspKind::kPoint) K.tail<3>().setZero();
  return K;
}

/// The idle freedoms must not matter to the loads; the hand must reach every freedom.
void RequirePrescribed(const LoadStudy& study, PreparedStudy* prepared) {
  const LoadModel& model = prepared->model;
  LoadWorkspace<double> ws(model);
  if (ws.motions.size() == 0) return;
  EvaluatePose(model.tree, prepared->mobility.q_general, &ws.tree);
  ws.dependents.Factor(ws.tree);
  FreeMotions(ws.tree, &ws.dependents, &ws.motions);
  constexpr double kNoAuthority = 1e-6;
  if (model.hand && HandAuthority(model, ws.tree, ws.motions) < kNoAuthority) {
    throw std::invalid_argument(fmt::format(
        "the mechanism has mobility {} and the grasp '{}' does not prescribe all of it: some links "
        "can flop about. Hold it at another link, rigidly rather than at a point, or drive joints",
        prepared->mobility.mobility, study.mechanism.grasps[study.hand->grasp].name));
  }
  constexpr double kShifts = 1e-6;
  for (size_t k = 0; k < model.partition.idle.size(); ++k) {
    const std::string name = NameOfVelocity(model.tree, model.partition.idle[k]);
    prepared->idle.push_back(name);
    if (IdleShift(model, ws, static_cast<int>(k)) < kShifts) continue;
    throw std::invalid_argument(
        fmt::format("the mechanism has mobility {} and {} drive(s): nothing prescribes the freedom "
                    "'{}', and it "
                    "moves links whose weight and inertia count. Add a drive there",
                    prepared->mobility.mobility, study.drives.size(), name));
  }
}

}  // namespace

PreparedStudy PrepareStudy(const LoadStudy& study) {
  RequireDrive(study);
  SpanningTreeOptions cuts;
  for (const JointDrive& drive : study.drives) cuts.keep.push_back(drive.joint);

  PreparedStudy prepared;
  LoadModel& model = prepared.model;
  model.tree = BuildKinematicTree(study.mechanism, cuts);
  prepared.q_start = StartCoordinates(model.tree);
  const AssemblySummary assembly = Assemble(model.tree, {}, &prepared.q_start);
  if (!assembly.closed) throw std::runtime_error(assembly.message);
  prepared.mobility = AnalyseMobility(model.tree, prepared.q_start);
  model.partition = study.hand ? PartitionAtPose(model.tree, prepared.mobility.q_general)
                               : PartitionForDrives(model.tree, prepared.mobility.q_general,
                                                    DrivenVelocities(study, model.tree));
  const double length = study.norm_length > 0 ? study.norm_length : model.tree.length;
  model.compliances = CompliancesForRule(model.tree, study.rule, length);
  model.external = study.external;
  model.drives = study.drives;
  model.hand = study.hand;
  if (study.hand) model.hand_stiffness = HandWeights(study, model.tree.length);
  model.rule = study.rule;
  model.has_passive = HasPassive(study.mechanism);
  model.has_dry_friction = HasDryFriction(study.mechanism);
  model.has_load_friction = HasLoadFriction(study.mechanism);
  RequirePrescribed(study, &prepared);
  for (int cut : study.mechanism.preferred_cuts) {
    if (std::find(cuts.keep.begin(), cuts.keep.end(), cut) == cuts.keep.end()) continue;
    prepared.warnings.push_back(fmt::format(
        "joint '{}' is driven and stays whole; the loop is cut elsewhere than the file asks",
        study.mechanism.joints[cut].name));
  }
  return prepared;
}

}  // namespace vmech
