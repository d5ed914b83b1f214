// What must hold at every pose of every example, whatever the mechanism is.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "driven_examples.h"
#include "free_bodies.h"
#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/run_load_study.h"
#include "vmech/dynamics/loads/study_plausibility.h"

namespace vmech {
namespace {

constexpr double kBalance = 1e-9;  // the promise of the project; rounding gives about 1e-13

class EveryDrivenExample : public testing::TestWithParam<DrivenExample> {
 protected:
  EveryDrivenExample()
      : study_(StudyOf(GetParam().name)),
        mechanism_(study_.mechanism),
        result_(RunLoadStudy(study_)) {}

  double PassiveForceOf(const PoseLoads& pose, size_t joint, int freedom) const {
    const Passive& p = mechanism_.joints[joint].passive[freedom];
    return -p.stiffness * (pose.joints[joint].position[freedom] - p.rest) -
           p.viscous * pose.joints[joint].rate[freedom];
  }

  double DriveForceOf(const PoseLoads& pose, size_t joint, int freedom) const {
    double force = 0;
    for (size_t k = 0; k < study_.drives.size(); ++k) {
      const JointDrive& drive = study_.drives[k];
      if (drive.joint == static_cast<int>(joint) && drive.freedom == freedom) {
        force += pose.drives[k].force;
      }
    }
    return force;
  }

  LoadStudy study_;
  const Mechanism& mechanism_;
  LoadStudyResult result_;
};

TEST_P(EveryDrivenExample, RaisesNoDoubt) {
  EXPECT_THAT(DoubtsOf(study_, result_), testing::IsEmpty());
}

TEST_P(EveryDrivenExample, PowerBalances) {
  ASSERT_EQ(result_.poses.size(), study_.times.size());
  EXPECT_LE(result_.max_power_error, kBalance);
}

TEST_P(EveryDrivenExample, PowerOfDrivesIsWhatTheLinksAndPassiveForcesTakeUp) {
  for (const PoseLoads& pose : result_.poses) {
    double power = 0, taken = 0, largest = 0;
    auto count = [&](double* sum, double term) {
      *sum += term;
      largest = std::max(largest, std::abs(term));
    };
    for (size_t k = 0; k < study_.drives.size(); ++k) {
      count(&power, pose.drives[k].force * study_.drives[k].law.At(pose.time).velocity);
    }
    const std::vector<Wrenchd> needed = NeededOfJoints(study_, pose);
    for (size_t i = 0; i < needed.size(); ++i) {
      const LinkMotion& m = pose.links[i];
      const Vector3d r = CentreOfGravity(mechanism_.links[i], m) - m.X_WL.p;
      count(&taken, needed[i].force.dot(m.v + m.w.cross(r)) + needed[i].moment.dot(m.w));
    }
    for (size_t j = 0; j < mechanism_.joints.size(); ++j) {
      for (size_t k = 0; k < mechanism_.joints[j].passive.size(); ++k) {
        const int freedom = static_cast<int>(k);
        count(&taken, -PassiveForceOf(pose, j, freedom) * pose.joints[j].rate[freedom]);
      }
    }
    EXPECT_GT(largest, 0);
    EXPECT_NEAR(power, taken, kBalance * largest) << "t = " << pose.time;
    EXPECT_NEAR(power, pose.power, kBalance * largest);
  }
}

TEST_P(EveryDrivenExample, EveryLinkIsInEquilibriumUnderItsJoints) {
  for (const PoseLoads& pose : result_.poses) {
    std::vector<Wrenchd> missing = NeededOfJoints(study_, pose);
    for (size_t j = 0; j < mechanism_.joints.size(); ++j) {
      const FreeJoint free = CutFree(mechanism_, pose.links, static_cast<int>(j));
      const Wrenchd W = pose.joints[j].In(free.R_WF.transpose());
      const int first = mechanism_.joints[j].first.link, second = mechanism_.joints[j].second.link;
      auto shifted = [&](int link) {
        return W.ShiftedBy(free.p_WM - CentreOfGravity(mechanism_.links[link], pose.links[link]));
      };
      missing[second] -= shifted(second);
      missing[first] += shifted(first);
    }
    const LoadScale scale = ScaleOf(mechanism_, pose);
    for (size_t i = 0; i < missing.size(); ++i) {
      if (static_cast<int>(i) == mechanism_.ground) continue;
      EXPECT_LE(missing[i].force.norm(), kBalance * scale.force) << mechanism_.links[i].name;
      EXPECT_LE(missing[i].moment.norm(), kBalance * scale.moment) << mechanism_.links[i].name;
    }
  }
}

TEST_P(EveryDrivenExample, AlongItsFreedomsAJointCarriesItsDriveAndItsSprings) {
  for (const PoseLoads& pose : result_.poses) {
    const LoadScale scale = ScaleOf(mechanism_, pose);
    for (size_t j = 0; j < mechanism_.joints.size(); ++j) {
      const FreeJoint free = CutFree(mechanism_, pose.links, static_cast<int>(j));
      const bool spherical = mechanism_.joints[j].type == JointType::kSpherical;
      const VectorXd along = free.freedoms.transpose() * pose.joints[j].Stacked();
      for (Eigen::Index k = 0; k < along.size(); ++k) {
        const int freedom = static_cast<int>(k);
        const double expected =
            spherical ? 0 : PassiveForceOf(pose, j, freedom) + DriveForceOf(pose, j, freedom);
        EXPECT_NEAR(along[k], expected, kBalance * std::max(scale.force, scale.moment))
            << mechanism_.joints[j].name << " at t = " << pose.time;
      }
    }
  }
}

TEST_P(EveryDrivenExample, LinksMoveAgainstEachOtherOnlyAsTheirJointsDo) {
  for (const PoseLoads& pose : result_.poses) {
    for (size_t j = 0; j < mechanism_.joints.size(); ++j) {
      const FreeJoint free = CutFree(mechanism_, pose.links, static_cast<int>(j));
      VectorXd rates = pose.joints[j].rate.head(free.freedoms.cols());
      if (mechanism_.joints[j].type == JointType::kSpherical) rates = free.R_FM * rates;
      const Vector6d V = RelativeTwist(mechanism_, pose.links, static_cast<int>(j));
      EXPECT_LE((V - free.freedoms * rates).norm(), kBalance * (1 + V.norm()))
          << mechanism_.joints[j].name << " at t = " << pose.time;
    }
    for (size_t k = 0; k < study_.drives.size(); ++k) {
      const MotionSample law = study_.drives[k].law.At(pose.time);
      EXPECT_NEAR(pose.joints[study_.drives[k].joint].position[0], law.position, kBalance);
      EXPECT_NEAR(pose.joints[study_.drives[k].joint].rate[0], law.velocity, kBalance);
    }
  }
}

TEST_P(EveryDrivenExample, AccelerationsAreTheSlopesOfVelocities) {
  constexpr double kStep = 1e-5;
  // step^2 times third derivatives of the motion, a few hundred in these units
  constexpr double kDifference = 1e-6;
  const double middle = study_.times[12];
  study_.times = {middle - kStep, middle, middle + kStep};
  const LoadStudyResult result = RunLoadStudy(study_);
  for (size_t i = 0; i < mechanism_.links.size(); ++i) {
    const LinkMotion &behind = result.poses[0].links[i], &here = result.poses[1].links[i],
                     &ahead = result.poses[2].links[i];
    const double scale = 1 + here.a.norm() + here.alpha.norm();
    EXPECT_LE(((ahead.v - behind.v) / (2 * kStep) - here.a).norm(), kDifference * scale);
    EXPECT_LE(((ahead.w - behind.w) / (2 * kStep) - here.alpha).norm(), kDifference * scale);
    EXPECT_LE(((ahead.X_WL.p - behind.X_WL.p) / (2 * kStep) - here.v).norm(),
              kDifference * (1 + here.v.norm()));
  }
}

TEST_P(EveryDrivenExample, JointAccelerationsAreTheSlopesOfRatesWhereverLoopsAreCut) {
  constexpr double kStep = 1e-5;
  constexpr double kDifference = 1e-6;  // step^2 times third derivatives of the rates
  const double middle = study_.times[12];
  study_.times = {middle - kStep, middle, middle + kStep};
  for (size_t cut = 0; cut < mechanism_.joints.size(); ++cut) {
    study_.mechanism.preferred_cuts = {static_cast<int>(cut)};
    const LoadStudyResult result = RunLoadStudy(study_);
    const PoseLoads behind = result.poses[0], here = result.poses[1], ahead = result.poses[2];
    for (size_t j = 0; j < mechanism_.joints.size(); ++j) {
      const Vector3d slope = (ahead.joints[j].rate - behind.joints[j].rate) / (2 * kStep);
      const Vector3d& acceleration = here.joints[j].acceleration;
      EXPECT_LE((slope - acceleration).norm(), kDifference * (1 + acceleration.norm()))
          << mechanism_.joints[j].name << ", cut at " << mechanism_.joints[cut].name;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Examples, EveryDrivenExample, testing::ValuesIn(DrivenExamples()),
                         [](const auto& info) { return TestName(info.param.name); });

TEST(DrivenExamples, CoverEveryShippedMechanism) {
  for (const std::string& name : ExampleNames()) EXPECT_NO_THROW(FindDrivenExample(name)) << name;
}

}  // namespace
}  // namespace vmech
