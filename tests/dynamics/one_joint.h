#pragma once

#include <string>
#include <vector>

#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/load_study.h"
#include "vmech/dynamics/loads/run_load_study.h"

namespace vmech {

/// A body of 10 kg on one joint at the origin, both anchors turned about z by the same angle,
/// pushed by a wrench at the origin in world axes.
struct OneJoint {
  Joint joint;
  double turn = 0;  ///< of the anchors about z [rad]
  Vector3d gravity_W = Vector3d::Zero();
  Wrenchd push_W;

  OneJoint(JointType type, LoadFriction friction)
      : joint(MakeJoint("joint", type, {0, 0}, {1, 0})) {
    joint.load_friction = friction;
  }

  Mechanism Made() const {
    const Posed X{Eigen::AngleAxisd(turn, Vector3d::UnitZ()).toRotationMatrix(), Vector3d::Zero()};
    Mechanism mechanism;
    mechanism.gravity_W = gravity_W;
    mechanism.links = {{"ground", {}, {{"a", X}}}, {"body", {}, {{"a", X}}}};
    mechanism.links[1].mass_properties = {10, Vector3d::Zero(), 0.1 * Matrix3d::Identity()};
    mechanism.joints = {joint};
    mechanism.grasps = {{"hold", 1, Posed(), GraspKind::kRigid}};
    return mechanism;
  }

  /// The study without its motion.
  LoadStudy Study() const {
    LoadStudy study;
    study.mechanism = Made();
    study.times = {0};
    ExternalLoad push;
    push.link = 1;
    push.at = {0};
    push.wrenches = {push_W};
    study.external = {push};
    return study;
  }

  /// At the start values, each freedom driven at the given rate.
  LoadStudyResult At(const std::vector<double>& rates) const {
    LoadStudy study = Study();
    for (size_t i = 0; i < rates.size(); ++i) {
      study.drives.push_back(
          {0, static_cast<int>(i), MotionLaw::Uniform(joint.start[i], rates[i])});
    }
    return RunLoadStudy(study);
  }
};

/// What the motors exert at the only pose.
inline std::vector<double> DriveForces(const LoadStudyResult& result) {
  std::vector<double> forces;
  for (const DriveSample& drive : result.poses[0].drives) forces.push_back(drive.force);
  return forces;
}

}  // namespace vmech
