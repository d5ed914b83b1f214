#include "vmech/mechanisms/cad/joint_fit.h"

#include <gtest/gtest.h>

namespace vmech::joint_fit_test {
namespace {

constexpr double kRoundoff = 1e-14;

Posed Turned(double x, double y, double z, const Vector3d& rotation_vector) {
  const double angle = rotation_vector.norm();
  Posed X;
  X.p = {x, y, z};
  if (angle > 0) X.R = Eigen::AngleAxisd(angle, rotation_vector / angle).toRotationMatrix();
  return X;
}

struct Allowed {
  JointType type;
  Posed X_FM;
  std::vector<double> start;
};

TEST(JointFit, ReadsTheCoordinatesOfMotionsThatTheJointAllows) {
  const Matrix3d universal = Turned(0, 0, 0, {0.4, 0, 0}).R * Turned(0, 0, 0, {0, -0.7, 0}).R;
  for (const Allowed& allowed :
       {Allowed{JointType::kRevolute, Turned(0, 0, 0, {0, 0, -2.5}), {-2.5}},
        Allowed{JointType::kPrismatic, Turned(0, 0, 0.3, {0, 0, 0}), {0.3}},
        Allowed{JointType::kCylindrical, Turned(0, 0, 0.3, {0, 0, 1}), {0.3, 1}},
        Allowed{JointType::kUniversal, {universal, Vector3d::Zero()}, {0.4, -0.7}},
        Allowed{JointType::kSpherical, Turned(0, 0, 0, {0, M_PI, 0}), {0, 0, 1, 0}},
        Allowed{JointType::kPlanar, Turned(0.1, 0.2, 0, {0, 0, 3}), {0.1, 0.2, 3}},
        Allowed{JointType::kWeld, Posed(), {}}}) {
    const JointFit fit = FitJoint(allowed.type, allowed.X_FM);
    ASSERT_EQ(fit.start.size(), allowed.start.size()) << NameOf(allowed.type);
    for (size_t i = 0; i < fit.start.size(); ++i) {
      EXPECT_NEAR(fit.start[i], allowed.start[i], kRoundoff) << NameOf(allowed.type);
    }
    EXPECT_NEAR(fit.gap, 0, kRoundoff) << NameOf(allowed.type);
    EXPECT_NEAR(fit.skew, 0, 1e-7) << NameOf(allowed.type);  // acos near 1
  }
}

TEST(JointFit, MeasuresWhatTheJointDoesNotAllow) {
  const Posed X_FM = Turned(0.003, 0.004, 0.1, {0.02, 0, 0});
  EXPECT_NEAR(FitJoint(JointType::kRevolute, X_FM).gap, X_FM.p.norm(), kRoundoff);
  EXPECT_NEAR(FitJoint(JointType::kCylindrical, X_FM).gap, 0.005, kRoundoff);
  EXPECT_NEAR(FitJoint(JointType::kCylindrical, X_FM).skew, 0.02, 1e-9);
  EXPECT_NEAR(FitJoint(JointType::kPlanar, X_FM).gap, 0.1, kRoundoff);
  EXPECT_NEAR(FitJoint(JointType::kPrismatic, Turned(0, 0, 0, {0, 0, 0.5})).skew, 0.5, 1e-9);
  EXPECT_NEAR(FitJoint(JointType::kRevolute, X_FM).angle, 0.02, 1e-9);
}

}  // namespace
}  // namespace vmech::joint_fit_test
