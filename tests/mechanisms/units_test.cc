#include "vmech/mechanisms/files/units.h"

#include <gtest/gtest.h>

#include <numbers>

namespace vmech::units_test {
namespace {

constexpr double kRounding = 4e-16;  // relative: a few roundings in the product of the factors
constexpr double kPi = std::numbers::pi;

Units UnitsOf(const std::string& text) {
  Document document(text, "f");
  const Units units = ReadUnits(document.root());
  document.ThrowErrors();
  return units;
}

void ExpectSame(double value, double expected) {
  EXPECT_NEAR(value, expected, kRounding * expected) << value;
}

TEST(Units, AreSiUnlessStated) {
  const Units units = UnitsOf("{}");
  for (const double factor :
       {units.length, units.angle, units.mass, units.time, units.velocity, units.angular_velocity,
        units.acceleration, units.inertia, units.force, units.torque, units.stiffness,
        units.rotational_stiffness, units.damping, units.rotational_damping}) {
    EXPECT_EQ(factor, 1);
  }
}

TEST(Units, InertiaAndSpeedsFollowTheirParts) {
  const Units units = UnitsOf("{length: mm, angle: deg, mass: g, time: ms}");
  ExpectSame(units.inertia, 1e-9);
  ExpectSame(units.velocity, 1);
  ExpectSame(units.angular_velocity, 1000 * kPi / 180);
}

TEST(Units, GravityAndForcesStaySiWhateverTheLengthIs) {
  const Units units = UnitsOf("{length: mm, angle: deg, mass: g, time: ms}");
  EXPECT_EQ(units.acceleration, 1);
  EXPECT_EQ(units.force, 1);
  EXPECT_EQ(units.torque, 1);
  EXPECT_EQ(units.stiffness, 1);
  EXPECT_EQ(units.rotational_stiffness, 1);
  EXPECT_EQ(units.damping, 1);
  EXPECT_EQ(units.rotational_damping, 1);
}

TEST(Units, StatedByNameAreTaken) {
  const Units units = UnitsOf(
      "{force: kN, torque: N mm, inertia: g mm^2, acceleration: mm/s^2, angular_velocity: rpm,"
      " stiffness: N/mm, rotational_stiffness: N m/deg, damping: N s/mm,"
      " rotational_damping: N mm s/rad}");
  ExpectSame(units.force, 1000);
  ExpectSame(units.torque, 1e-3);
  ExpectSame(units.inertia, 1e-9);
  ExpectSame(units.acceleration, 1e-3);
  ExpectSame(units.angular_velocity, 2 * kPi / 60);
  ExpectSame(units.stiffness, 1000);
  ExpectSame(units.rotational_stiffness, 180 / kPi);
  ExpectSame(units.damping, 1000);
  ExpectSame(units.rotational_damping, 1e-3);
}

TEST(Units, InchesPoundsAndTurnsAreExact) {
  const Units units = UnitsOf("{length: in, mass: lb, force: lbf, angle: rev, torque: lbf*in}");
  ExpectSame(units.length, 0.0254);
  ExpectSame(units.mass, 0.45359237);
  ExpectSame(units.force, 4.4482216152605);
  ExpectSame(units.angle, 2 * kPi);
  ExpectSame(units.torque, 4.4482216152605 * 0.0254);
}

TEST(Units, OfAnotherKindAreRefused) {
  for (const char* text : {"{length: kg}", "{torque: N}", "{stiffness: N m/rad}", "{angle: rpm}",
                           "{rotational_stiffness: N m}", "{inertia: kg mm}"}) {
    EXPECT_THROW(UnitsOf(text), FileErrors) << text;
  }
}

TEST(Units, ThatCannotBeReadAreRefused) {
  for (const char* text : {"{length: ''}", "{length: m^}", "{length: m^-1}", "{length: /m}",
                           "{stiffness: N//m}", "{stiffness: N/m/m}", "{length: 5}",
                           "{length: [m]}", "{length: M}", "{length: }", "[mm, deg]"}) {
    EXPECT_THROW(UnitsOf(text), FileErrors) << text;
  }
}

}  // namespace
}  // namespace vmech::units_test
