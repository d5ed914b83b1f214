#include <gtest/gtest.h>

#include <cmath>

#include "reference_case.h"

namespace vmech::reference::pendulum_test {
namespace {

/// Simple pendulum, benchmark A01 of the IFToMM library of multibody problems: 1 kg at 1 m, let go
/// level at x = 1 m. Positions and pin forces from the closed form with Jacobi's elliptic
/// functions, 30 digits. At the bottom the pin carries 3 m g.
struct Row {
  double t, x, y, pin_force;  // [s, m, m, N]
};
constexpr Row kRows[] = {
    {0.1, 0.9987974827498897, -0.04902640566555758, 1.442847118737359},
    {0.25, 0.953664612211401, -0.3008717457915882, 8.854655478646441},
    {0.5, 0.3910487915505464, -0.9203699487851922, 27.08648759274821},
    {1.0, -0.9862917511318753, -0.1650108531255412, 4.856269407484677},
    {2.0, 0.7935661953433217, -0.6084839304437915, 17.90768207296078},
    {10.0, 0.2750874625761169, -0.9614192050991251, 28.29456720606725},
    {2000.0, -0.8146030685890322, -0.5800188278369355, 17.06995410324101},
};
constexpr double kGravity = 9.81;
constexpr double kTolerance = 1e-12;  // of 3 m g; the table has 16 digits

Mechanism Pendulum() {
  Mechanism pendulum;
  pendulum.gravity_W = {0, -kGravity, 0};
  pendulum.links.resize(2);
  pendulum.links[0].name = "frame";
  pendulum.links[0].anchors = {{"pin", {}}};
  pendulum.links[1].name = "bob";
  pendulum.links[1].anchors = {{"pin", {}}};
  pendulum.links[1].mass_properties = {1, {1, 0, 0}, Matrix3d::Zero()};
  pendulum.joints = {MakeJoint("pin", JointType::kRevolute, {0, 0}, {1, 0})};
  return pendulum;
}

class SimplePendulum : public testing::TestWithParam<Row> {};

TEST_P(SimplePendulum, PinForceIsThatOfTheFreeSwing) {
  const Row row = GetParam();
  const Mechanism pendulum = Pendulum();
  const MotionSample swing = {std::atan2(row.y, row.x), std::sqrt(-2 * kGravity * row.y),
                              -kGravity * row.x};
  const PoseLoads loads = LoadsAt(pendulum, {{"pin", swing}});
  const Vector3d force = OnSecond_W(pendulum, loads, "pin").force;
  EXPECT_NEAR(force.norm(), row.pin_force, kTolerance * 3 * kGravity);
  EXPECT_NEAR(force.dot(Vector3d(-row.x, -row.y, 0)), row.pin_force, kTolerance * 3 * kGravity);
  EXPECT_NEAR(loads.drives[0].force, 0, kTolerance * 3 * kGravity);
}

INSTANTIATE_TEST_SUITE_P(AlongTheSwing, SimplePendulum, testing::ValuesIn(kRows));

}  // namespace
}  // namespace vmech::reference::pendulum_test
