#include "vmech/dynamics/loads/prepare_study.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

#include "vmech/base/linear_algebra/linear_algebra.h"
#include "vmech/dynamics/loads/pose/hand_wrench.h"
#include "vmech/dynamics/loads/pose/idle_freedoms.h"
#include "vmech/dynamics/loads/study_validity.h"
#include "vmech/dynamics/rigid_body/passive.h"
#include "vmech/kinematics/loops/assembled_mechanism.h"
#include "vmech/mechanisms/freedoms.h"

namespace vmech {
namespace {

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

/// Moments of inertia that are rounding beside those of the mechanism [kg m^2].
double NoInertia(const KinematicTree& tree) {
  constexpr double kRounding = 1e-12;
  double mass = 0;
  for (const TreeNode& node : tree.nodes) mass += node.mass;
  return kRounding * mass * tree.length * tree.length;
}

/// How many of the free motions at a pose the hand does not see.
int CountUnseen(const LoadModel& model, const LoadWorkspace<double>& ws) {
  constexpr double kUnseen = 1e-6;
  const VectorXd sigma =
      FindLeftSingularVectors(WeightedGraspMotions(model, ws.tree, ws.motions).transpose()).values;
  const auto seen = (sigma.array() > kUnseen * sigma.maxCoeff()).count();
  return static_cast<int>(ws.motions.cols() - seen);
}

/// The velocity that has most to do with an idle motion.
std::string NameOfIdle(const LoadModel& model, const LoadWorkspace<double>& ws, int k) {
  Eigen::Index most = 0;
  ws.idle_motions.col(k).cwiseAbs().maxCoeff(&most);
  return NameOfVelocity(model.tree, model.hand ? static_cast<int>(most) : model.partition.idle[k]);
}

std::string NotPrescribed(const LoadStudy& study, const PreparedStudy& prepared,
                          const std::string& freedom) {
  if (study.hand) {
    return fmt::format(
        "the mechanism has mobility {} and the grasp '{}' does not prescribe all of it: some links "
        "can flop about, '{}' among them. Hold it at another link, rigidly rather than at a point, "
        "or drive joints",
        prepared.mobility.mobility, study.mechanism.grasps[study.hand->grasp].name, freedom);
  }
  return fmt::format(
      "the mechanism has mobility {} and {} drive(s): nothing prescribes the freedom '{}', and it "
      "moves links whose weight and inertia count. Add a drive there",
      prepared.mobility.mobility, study.drives.size(), freedom);
}

/// The idle freedoms must not matter to the loads. Those that hardly do, for the rounding of a
/// centre of gravity that belongs on an axis, are held.
void RequirePrescribed(const LoadStudy& study, PreparedStudy* prepared) {
  constexpr double kShifts = 1e-6;
  LoadModel& model = prepared->model;
  model.idle = static_cast<int>(model.partition.idle.size());
  model.no_inertia = NoInertia(model.tree);
  LoadWorkspace<double> ws(model);
  if (ws.motions.size() == 0) return;
  EvaluatePose(model.tree, prepared->mobility.q_general, &ws.tree);
  ws.dependents.Factor(ws.tree);
  FreeMotions(ws.tree, &ws.dependents, &ws.motions);
  if (model.hand) model.idle = CountUnseen(model, ws);
  FindMotions(model, &ws);
  for (int k = 0; k < model.idle; ++k) {
    const std::string name = NameOfIdle(model, ws, k);
    prepared->idle.push_back(name);
    const double shift = ShiftOfCentres(model.tree, ws.idle_motions.col(k), &ws.tree);
    if (shift < kShifts) continue;
    if (shift > model.tree.mechanism.tolerance) {
      throw std::invalid_argument(NotPrescribed(study, *prepared, name));
    }
    model.idle_is_held = true;
    prepared->notes.push_back(fmt::format(
        "nothing prescribes the freedom '{}'; centres of gravity are off its axis by {:.2g} of the "
        "mechanism's length, which is taken for rounding: it is held",
        name, shift));
  }
}

}  // namespace

std::string DrivesAt(const LoadStudy& study, const std::vector<double>& positions) {
  std::string text;
  for (size_t k = 0; k < study.drives.size(); ++k) {
    const JointDrive& drive = study.drives[k];
    const Joint& joint = study.mechanism.joints[drive.joint];
    text +=
        fmt::format("{}'{}' at {}", k == 0 ? "with " : ", ", NameOfFreedom(joint, drive.freedom),
                    FormatCoordinate(study.units, joint, drive.freedom, positions[k]));
  }
  return text.empty() ? "under the hand" : text;
}

PreparedStudy PrepareStudy(const LoadStudy& study) {
  RequireValid(study);
  SpanningTreeOptions cuts;
  for (const JointDrive& drive : study.drives) cuts.keep.push_back(drive.joint);

  PreparedStudy prepared;
  LoadModel& model = prepared.model;
  const AssembledMechanism assembled = RequireAssembled(study.mechanism);
  prepared.notes = assembled.Notes();
  prepared.closure_tolerance = assembled.closure_tolerance;
  model.rounding = assembled.correction;
  model.tree = BuildKinematicTree(assembled.mechanism, cuts);
  prepared.q_start = StartCoordinates(model.tree);
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
  model.has_passive = HasPassiveJoints(study.mechanism);
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
