#include "vmech/bindings/shared/posed_mechanism.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "vmech/kinematics/inverse/assembly_modes.h"
#include "vmech/kinematics/inverse/inverse_kinematics.h"
#include "vmech/kinematics/loops/assembled_mechanism.h"
#include "vmech/kinematics/tree/forward_kinematics.h"
#include "vmech/kinematics/tree/grasp_frame.h"
#include "vmech/mechanisms/validity.h"

namespace vmech {
namespace {

struct FreedomPlace {
  int joint, freedom;
};

std::vector<FreedomPlace> PlacesOfFreedoms(const Mechanism& mechanism) {
  std::vector<FreedomPlace> places;
  for (size_t j = 0; j < mechanism.joints.size(); ++j) {
    const int freedoms = FreedomsOf(mechanism.joints[j].type);
    for (int k = 0; k < freedoms; ++k) places.push_back({static_cast<int>(j), k});
  }
  return places;
}

void RequirePose(const Posed& X_WH) {
  if (!X_WH.p.allFinite() || !X_WH.R.allFinite()) {
    throw std::invalid_argument("the pose of the hand is not finite");
  }
  const double skew = (X_WH.R.transpose() * X_WH.R - Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(skew < 1e-6) || X_WH.R.determinant() < 0) {
    throw std::invalid_argument(
        "the rotation of the hand is not one: its columns must be right-handed unit vectors that "
        "are square to each other, to 1e-6");
  }
}

bool HasLimit(const Joint& joint) {
  const auto finite = [](double limit) { return std::isfinite(limit); };
  return std::any_of(joint.lower.begin(), joint.lower.end(), finite) ||
         std::any_of(joint.upper.begin(), joint.upper.end(), finite);
}

/// Joints with limits stay whole where the loops allow it: a limit is kept at a joint of the tree.
KinematicTree TreeOf(const Mechanism& mechanism, std::vector<int> keep) {
  SpanningTreeOptions cuts;
  cuts.keep = std::move(keep);
  for (size_t j = 0; j < mechanism.joints.size(); ++j) {
    if (HasLimit(mechanism.joints[j])) cuts.prefer.push_back(static_cast<int>(j));
  }
  return BuildKinematicTree(mechanism, cuts);
}

/// A mechanism's assembled tree, and what to say about it.
struct AssembledTree {
  KinematicTree tree;
  std::vector<std::string> notes;
};

AssembledTree Assembled(const Mechanism& mechanism, const std::vector<int>& keep) {
  RequireValid(mechanism);
  const AssembledMechanism assembled = RequireAssembled(mechanism);
  return {TreeOf(assembled.mechanism, keep), assembled.Notes()};
}

void AddPose(const KinematicTree& tree, const VectorXd& q, PoseList* list) {
  Mechanism mechanism = tree.mechanism;
  SetStarts(tree, q, &mechanism);
  const std::vector<double> positions = StartOfFreedoms(mechanism);
  const std::vector<Posed> links = PosesOfLinks(tree, q);
  list->positions.insert(list->positions.end(), positions.begin(), positions.end());
  list->links.insert(list->links.end(), links.begin(), links.end());
  list->link_count = links.size();
  ++list->poses;
}

void WarnOfOpenLimits(const KinematicTree& tree, Computed* computed) {
  for (size_t j = 0; j < tree.mechanism.joints.size(); ++j) {
    const Joint& joint = tree.mechanism.joints[j];
    if (!HasLimit(joint) || tree.placements[j].tree_node >= 0) continue;
    computed->Warn(fmt::format(
        "the limits of joint '{}' are not kept: its loop has to be cut there", joint.name));
  }
}

/// Velocity indices of the freedoms that are held.
std::vector<int> HeldVelocities(const KinematicTree& tree, const std::vector<FreedomPlace>& held) {
  std::vector<int> fixed;
  for (const FreedomPlace& place : held) {
    const Joint& joint = tree.mechanism.joints[place.joint];
    if (joint.type == JointType::kSpherical) {
      throw std::invalid_argument(fmt::format(
          "joint '{}' is spherical: its freedoms cannot be held one by one", joint.name));
    }
    fixed.push_back(VelocityIndex(tree, place.joint, place.freedom));
  }
  return fixed;
}

std::vector<FreedomPlace> HeldPlaces(const Mechanism& mechanism, const std::vector<int>& held) {
  const std::vector<FreedomPlace> places = PlacesOfFreedoms(mechanism);
  std::vector<FreedomPlace> chosen;
  for (const int freedom : held) {
    RequireIndex("held", freedom, places.size());
    chosen.push_back(places[freedom]);
  }
  return chosen;
}

}  // namespace

std::vector<Posed> PosesOfLinks(const KinematicTree& tree, const VectorXd& q) {
  TreeWorkspace<double> ws(tree);
  ForwardKinematics(tree, q.data(), &ws);
  std::vector<Posed> poses;
  for (size_t l = 0; l < tree.mechanism.links.size(); ++l) {
    const int link = static_cast<int>(l), node = tree.NodeOfLink(link);
    poses.push_back(node < 0 ? Posed() : PoseInWorld(ws, node, tree.X_node_link(link)));
  }
  return poses;
}

std::vector<std::string> NamesOfAllFreedoms(const Mechanism& mechanism) {
  std::vector<std::string> names;
  for (const FreedomPlace& place : PlacesOfFreedoms(mechanism)) {
    names.push_back(NameOfFreedom(mechanism.joints[place.joint], place.freedom));
  }
  return names;
}

Computed FindNearestPose(const Mechanism& mechanism, const HandQuestion& question) {
  RequireIndex("grasp", question.grasp, mechanism.grasps.size());
  RequirePose(question.X_WH);
  const AssembledTree assembled = Assembled(mechanism, {});
  const KinematicTree& tree = assembled.tree;
  InverseKinematicsOptions options;
  options.stiffness = question.stiffness;
  options.joint_limits = question.joint_limits;
  InverseKinematics problem(tree, GraspFrameOf(tree, question.grasp), options);
  problem.SetTarget(question.X_WH);
  const Summary summary = Solve(question.solver, problem, StoppingRule{}, StartCoordinates(tree));
  if (summary.status != SolveStatus::kConverged && summary.status != SolveStatus::kBiased) {
    throw std::runtime_error(fmt::format("no pose was found: {} {}; start nearer to the hand",
                                         NameOf(summary.status), summary.message));
  }
  PoseList list;
  AddPose(tree, summary.x, &list);
  list.errors.push_back(problem.HandError(summary.x));
  Computed computed(std::move(list));
  for (const std::string& note : assembled.notes) computed.Warn(note);
  if (question.joint_limits) WarnOfOpenLimits(tree, &computed);
  return computed;
}

Computed FindAllPoses(const Mechanism& mechanism, const ModesQuestion& question) {
  RequireValid(mechanism);
  const std::vector<FreedomPlace> held = HeldPlaces(mechanism, question.held);
  std::vector<int> keep;
  for (const FreedomPlace& place : held) keep.push_back(place.joint);
  const AssembledTree assembled = Assembled(mechanism, keep);
  const KinematicTree& tree = assembled.tree;
  AssemblyModesOptions options;
  options.fixed = HeldVelocities(tree, held);
  options.joint_limits = question.joint_limits;
  options.max_starts = question.max_starts;
  options.patience = question.patience;
  options.seed = question.seed;
  if (question.grasp >= 0) {
    RequireIndex("grasp", question.grasp, mechanism.grasps.size());
    RequirePose(question.X_WH);
    options.hand = HandPose{GraspFrameOf(tree, question.grasp), question.X_WH};
  }
  const AssemblyModes found = FindAssemblyModes(tree, options, StartCoordinates(tree));
  PoseList list;
  for (const AssemblyMode& mode : found.modes) AddPose(tree, mode.q, &list);
  Computed computed(std::move(list));
  for (const std::string& note : assembled.notes) computed.Warn(note);
  if (question.joint_limits) WarnOfOpenLimits(tree, &computed);
  if (!found.settled) computed.Warn("the search was not settled: raise max_starts for more modes");
  const auto moves = [](const AssemblyMode& mode) { return !mode.isolated; };
  if (std::any_of(found.modes.begin(), found.modes.end(), moves)) {
    computed.Warn("the links can move as they are held: hold more freedoms to count modes");
  }
  return computed;
}

}  // namespace vmech
