#include "reference_case.h"

#include <stdexcept>

#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/pose/pose_loads.h"
#include "vmech/dynamics/loads/pose/store_pose_loads.h"
#include "vmech/dynamics/loads/prepare_study.h"
#include "vmech/dynamics/loads/run_load_study.h"

namespace vmech::reference {
namespace {

int JointIndex(const Mechanism& mechanism, const std::string& name) {
  const int joint = FindJoint(mechanism, name);
  if (joint < 0) throw std::invalid_argument("no joint '" + name + "' in " + mechanism.name);
  return joint;
}

/// Pose, velocity and acceleration of a grasp that moves with its link.
HandSample GraspMotion(const Grasp& grasp, const PoseLoads& loads) {
  const LinkMotion& link = loads.links[grasp.link];
  const Vector3d p_LoGo_W = link.X_WL.R * grasp.X_LG.p;
  HandSample motion;
  motion.X_WH = link.X_WL * grasp.X_LG;
  motion.V_WH << link.v + link.w.cross(p_LoGo_W), link.w;
  motion.A_WH << link.a + link.alpha.cross(p_LoGo_W) + link.w.cross(link.w.cross(p_LoGo_W)),
      link.alpha;
  return motion;
}

}  // namespace

void SetStart(Mechanism* mechanism, const std::string& joint, std::vector<double> start) {
  mechanism->joints[JointIndex(*mechanism, joint)].start = std::move(start);
}

PoseLoads AfterLeading(const Mechanism& mechanism, const std::string& joint, double position) {
  constexpr int kSteps = 200;
  const int driven = JointIndex(mechanism, joint);
  const double start = mechanism.joints[driven].start[0];
  LoadStudy study;
  study.mechanism = mechanism;
  study.drives = {{driven, 0, MotionLaw::Uniform(start, position - start)}};
  for (int i = 0; i <= kSteps; ++i) study.times.push_back(static_cast<double>(i) / kSteps);
  return RunLoadStudy(study).poses.back();
}

Mechanism LedTo(Mechanism mechanism, const std::string& joint, double position) {
  const PoseLoads last = AfterLeading(mechanism, joint, position);
  for (size_t j = 0; j < mechanism.joints.size(); ++j) {
    std::vector<double>& coordinates = mechanism.joints[j].start;
    for (size_t k = 0; k < coordinates.size(); ++k) coordinates[k] = last.joints[j].position[k];
  }
  return mechanism;
}

LoadStudy StudyAt(const Mechanism& mechanism, const std::vector<Driven>& drives) {
  LoadStudy study;
  study.mechanism = mechanism;
  for (const auto& [joint, state] : drives) {
    const int index = JointIndex(mechanism, joint);
    study.mechanism.joints[index].start[0] = state.position;
    study.drives.push_back(
        {index, 0, MotionLaw::Uniform(state.position, state.velocity, state.acceleration)});
  }
  study.times = {0};
  study.rule = ReactionRule::kMinimumNorm;
  return study;
}

PoseLoads LoadsAt(const Mechanism& mechanism, const std::vector<Driven>& drives) {
  return RunLoadStudy(StudyAt(mechanism, drives)).poses.front();
}

HeldLoads LoadsInHand(const Mechanism& mechanism, const std::string& grasp,
                      const Vector6d& stiffness, const std::vector<Driven>& drives,
                      ReactionRule rule) {
  const LoadStudy driven = StudyAt(mechanism, drives);
  const int index = FindGrasp(mechanism, grasp);
  Motion motion;
  motion.times = {0};
  motion.hand = {GraspMotion(mechanism.grasps[index], RunLoadStudy(driven).poses.front())};

  LoadStudy held = driven;
  held.drives.clear();
  held.hand = HandDrive{index, HandLaw::Table({0}, {motion.hand[0].X_WH}), stiffness};
  held.rule = rule;
  const PreparedStudy prepared = PrepareStudy(held);
  motion.coordinates.assign(prepared.q_start.begin(), prepared.q_start.end());
  motion.cut_positions.assign(prepared.model.tree.loops.size(), Vector3d::Zero());

  const auto loads = std::make_shared<LoadArrays>(MakeLoadArrays(prepared.model, motion, true));
  LoadWorkspace<double> workspace(prepared.model);
  if (!EvaluatePoseLoads(prepared.model, motion, 0, &workspace)) {
    throw std::runtime_error("the hand does not determine the motion");
  }
  StorePoseLoads(prepared.model, motion, 0, workspace, loads.get());
  const PoseLoads pose(loads, 0);
  return {pose, pose.hand};
}

ExternalLoad Force(const Mechanism& mechanism, const std::string& link, const Vector3d& p_L,
                   const Vector3d& force_W, const Vector3d& moment_W) {
  ExternalLoad load;
  load.link = FindLink(mechanism, link);
  load.p_L = p_L;
  load.wrenches = {{force_W, moment_W}};
  return load;
}

Wrenchd OnSecond_W(const Mechanism& mechanism, const PoseLoads& loads, const std::string& joint) {
  const int index = JointIndex(mechanism, joint);
  const AnchorId first = mechanism.joints[index].first;
  const Matrix3d R_WF = loads.links[first.link].X_WL.R * mechanism.anchor(first).X_LA.R;
  return loads.joints[index].In(R_WF.transpose());
}

double Position(const Mechanism& mechanism, const PoseLoads& loads, const std::string& joint) {
  return loads.joints[JointIndex(mechanism, joint)].position[0];
}

double FreeAcceleration(const LoadStudy& study_of_one_pose, const std::string& joint,
                        double position, double velocity) {
  LoadStudy study = study_of_one_pose;
  const int index = JointIndex(study.mechanism, joint);
  study.mechanism.joints[index].start[0] = position;
  double force[2];
  for (const int acceleration : {0, 1}) {
    const MotionLaw law = MotionLaw::Uniform(position, velocity, acceleration);
    study.drives = {{index, 0, law}};
    force[acceleration] = RunLoadStudy(study).poses.front().drives[0].force;
  }
  return force[0] / (force[0] - force[1]);
}

}  // namespace vmech::reference
