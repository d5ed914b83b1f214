#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "simbody_model.h"
#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/load_study.h"
#include "vmech/dynamics/loads/run_load_study.h"
#include "vmech/dynamics/simulation/simulate.h"
#include "vmech/dynamics/simulation/simulation.h"
#include "vmech/mechanisms/files/reader.h"

namespace vmech {
namespace {

// Both sides work in doubles; what is left is rounding, multiplied by the condition of the loops.
constexpr double kAgreement = 1e-9;

struct DriveMotion {
  const char* joint;
  double speed;         // [m/s] or [rad/s]
  double acceleration;  // [m/s^2] or [rad/s^2]
};

struct PeerCase {
  const char* name;
  const char* example;
  std::vector<DriveMotion> drives;
  const char* loaded_link;
  double duration;  // of the motion, in 60 poses [s]
  int certain;      // wrench components that statics determines, counted over all joints
  // Puts the origins of all anchors into those of their links, along their axes.
  bool anchors_at_link_origins = false;
};

void PrintTo(const PeerCase& peer_case, std::ostream* os) {
  *os << peer_case.name;
}

// In the plane, 3 components of each of 4 joints; without redundant equations, all. Of the
// spherical four-bar any force through its centre may go round, so that its moments about the
// centre are all that statics determines; of Bennett's linkage, those about the axes.
const PeerCase kCases[] = {
    {"SliderCrank", "slider-crank", {{"main", 157, 40}}, "slider", 0.08, 12},
    {"FourBar", "four-bar", {{"main", 5, 2}}, "coupler", 1.0, 12},
    {"Rssr", "rssr", {{"input", 6, -1}}, "rocker", 1.0, 24},
    {"Rsup", "rsup", {{"main", 20, 5}}, "slider", 0.3, 24},
    {"SphericalFourBar", "spherical-four-bar", {{"input", 8, 3}}, "coupler", 0.7, 12, true},
    {"StewartGough",
     "stewart-gough",
     {{"leg1", 0.05, 0.3},
      {"leg2", -0.04, 0.2},
      {"leg3", 0.03, -0.2},
      {"leg4", 0.02, 0.1},
      {"leg5", -0.03, 0.3},
      {"leg6", 0.04, -0.1}},
     "platform",
     0.5,
     108},
    {"Bennett", "bennett", {{"input", 3, 1}}, "coupler", 1.0, 4},
};

LoadStudy StudyOf(const PeerCase& peer_case) {
  constexpr int kPoses = 60;
  LoadStudy study;
  study.mechanism = ReadMechanism(std::string(VMECH_EXAMPLES) + "/" + peer_case.example + ".yaml");
  if (peer_case.anchors_at_link_origins) {
    for (Link& link : study.mechanism.links) {
      for (Anchor& anchor : link.anchors) anchor.X_LA.p.setZero();
    }
  }
  for (const DriveMotion& drive : peer_case.drives) {
    const int j = FindJoint(study.mechanism, drive.joint);
    const double start = study.mechanism.joints.at(j).start[0];
    study.drives.push_back({j, 0, MotionLaw::Uniform(start, drive.speed, drive.acceleration)});
  }
  for (int i = 0; i < kPoses; ++i) study.times.push_back(peer_case.duration * i / kPoses);
  ExternalLoad load;
  load.link = FindLink(study.mechanism, peer_case.loaded_link);
  load.p_L = {0.02, -0.01, 0.03};
  load.at = {0};
  load.wrenches = {{{-20, 12, 7}, {0.3, -0.5, 0.8}}};
  study.external = {load};
  study.rule = ReactionRule::kMinimumNorm;
  return study;
}

peers::SimbodyModel PeerOf(const LoadStudy& study) {
  std::vector<peers::JointFreedom> drives;
  for (const JointDrive& drive : study.drives) drives.push_back({drive.joint, drive.freedom});
  return {study.mechanism, drives, peers::DriveMode::kAcceleration};
}

peers::SimbodyQuery QueryOf(const LoadStudy& study, const PoseLoads& pose) {
  peers::SimbodyQuery query;
  for (const LinkMotion& link : pose.links) query.links.push_back({link.X_WL, link.v, link.w});
  for (const MotionSample& drive : pose.drives) query.drives.push_back(drive.acceleration);
  query.external_W.resize(pose.links.size());
  for (const ExternalLoad& load : study.external) {
    const Vector3d p_LoP_W = pose.links[load.link].X_WL.R * load.p_L;
    query.external_W[load.link] += load.wrenches[0].ShiftedBy(p_LoP_W);
  }
  return query;
}

// What the two sides may differ by: forces are measured by the largest force of the pose, moments
// by the largest moment and that force on the mechanism's length.
struct Scale {
  double force = 0, moment = 0;
  double of(int component) const { return component < 3 ? force : moment; }
};

Scale ScaleOf(const PoseLoads& pose, double length) {
  Scale scale;
  for (const Wrenchd& w : pose.joints) scale.force = std::max(scale.force, w.force.norm());
  scale.moment = scale.force * length;
  for (const Wrenchd& w : pose.joints) scale.moment = std::max(scale.moment, w.moment.norm());
  return scale;
}

class SimbodyAgreement : public testing::TestWithParam<PeerCase> {};

TEST_P(SimbodyAgreement, EveryCertainReaction) {
  const LoadStudy study = StudyOf(GetParam());
  const LoadStudyResult result = RunLoadStudy(study);
  peers::SimbodyModel peer = PeerOf(study);
  const double length = CharacteristicLength(study.mechanism);
  int certain = 0;
  for (const JointCertainty& joint : result.certainty) {
    certain += static_cast<int>(std::count(joint.begin(), joint.end(), Certainty::kCertain));
  }
  EXPECT_EQ(certain, GetParam().certain);
  for (const PoseLoads& pose : result.poses) {
    SCOPED_TRACE("t = " + std::to_string(pose.time));
    const peers::SimbodyAnswer answer = peer.Evaluate(QueryOf(study, pose));
    const Scale scale = ScaleOf(pose, length);
    for (size_t j = 0; j < pose.joints.size(); ++j) {
      const Vector6d error = pose.joints[j].Stacked() - answer.joints[j].Stacked();
      for (int i = 0; i < 6; ++i) {
        if (result.certainty[j][i] != Certainty::kCertain) continue;
        ASSERT_LT(std::abs(error[i]), kAgreement * scale.of(i))
            << study.mechanism.joints[j].name << ", component " << i;
      }
    }
  }
}

TEST_P(SimbodyAgreement, MotionAndDriveForces) {
  const LoadStudy study = StudyOf(GetParam());
  const LoadStudyResult result = RunLoadStudy(study);
  peers::SimbodyModel peer = PeerOf(study);
  for (const PoseLoads& pose : result.poses) {
    SCOPED_TRACE("t = " + std::to_string(pose.time));
    const peers::SimbodyAnswer answer = peer.Evaluate(QueryOf(study, pose));
    EXPECT_LT(answer.pose_error, kAgreement);
    double fastest = 0, greatest = 0, largest = 0;
    for (const LinkMotion& link : pose.links) {
      fastest = std::max({fastest, link.v.norm(), link.w.norm()});
      greatest = std::max({greatest, link.a.norm(), link.alpha.norm()});
    }
    for (const DriveSample& drive : pose.drives) largest = std::max(largest, std::abs(drive.force));
    EXPECT_LT(answer.velocity_error, kAgreement * fastest);
    for (size_t i = 0; i < pose.links.size(); ++i) {
      const peers::LinkAcceleration& a = answer.accelerations[i];
      EXPECT_LT((pose.links[i].a - a.a_WLo).norm(), kAgreement * greatest);
      EXPECT_LT((pose.links[i].alpha - a.alpha_WL).norm(), kAgreement * greatest);
    }
    for (size_t i = 0; i < pose.drives.size(); ++i) {
      EXPECT_NEAR(pose.drives[i].force, answer.drive_forces[i], kAgreement * largest);
    }
  }
}

// What statics leaves open may differ, but only by wrenches that hold each other in equilibrium on
// every link.
TEST_P(SimbodyAgreement, DifferencesAreSelfStress) {
  const LoadStudy study = StudyOf(GetParam());
  const LoadStudyResult result = RunLoadStudy(study);
  peers::SimbodyModel peer = PeerOf(study);
  const double length = CharacteristicLength(study.mechanism);
  for (const PoseLoads& pose : result.poses) {
    SCOPED_TRACE("t = " + std::to_string(pose.time));
    const peers::SimbodyAnswer answer = peer.Evaluate(QueryOf(study, pose));
    const Scale scale = ScaleOf(pose, length);
    std::vector<Wrenchd> open_W(pose.links.size());  // on each link, about the world's origin
    for (size_t j = 0; j < pose.joints.size(); ++j) {
      const Joint& joint = study.mechanism.joints[j];
      const auto pose_of = [&](AnchorId id) {
        return pose.links[id.link].X_WL * study.mechanism.anchor(id).X_LA;
      };
      const Wrenchd difference = (pose.joints[j] - answer.joints[j])
                                     .In(pose_of(joint.first).R.transpose())
                                     .ShiftedBy(pose_of(joint.second).p);
      open_W[joint.second.link] += difference;
      open_W[joint.first.link] -= difference;
    }
    for (size_t i = 0; i < open_W.size(); ++i) {
      if (static_cast<int>(i) == study.mechanism.ground) continue;
      EXPECT_LT(open_W[i].force.norm(), kAgreement * scale.force);
      EXPECT_LT(open_W[i].moment.norm(), kAgreement * scale.moment);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Examples, SimbodyAgreement, testing::ValuesIn(kCases),
                         [](const testing::TestParamInfo<PeerCase>& info) {
                           return std::string(info.param.name);
                         });

// Simbody's library holds functions of an old SUNDIALS under the names of those that simulate.
TEST(Simbody, LeavesSimulationsAlone) {
  Simulation simulation;
  simulation.mechanism = ReadMechanism(std::string(VMECH_EXAMPLES) + "/four-bar.yaml");
  simulation.times = {0, 0.1};
  SimulationOptions options;
  options.loads = false;
  for (const SimulationMethod method :
       {SimulationMethod::kAdams, SimulationMethod::kBdf, SimulationMethod::kIdas}) {
    options.method = method;
    const SimulationResult result = Simulate(simulation, options);
    EXPECT_EQ(result.status, SimulationStatus::kFinished) << result.message;
    EXPECT_GT(result.V(1).norm(), 0.1);
  }
}

}  // namespace
}  // namespace vmech
