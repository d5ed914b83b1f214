#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "reference_case.h"

namespace vmech::reference::modelica_test {
namespace {

/// PlanarFourbar and Engine1a of the Modelica Standard Library, g = 9.80665 m/s^2. The free motion
/// is published (modelica/MAP-LIB_ReferenceResults, Dymola 2020x); the states and reactions here
/// are of an integration in absolute coordinates with multipliers, which meets the published angles
/// to 3e-5 rad at 2 s. Driven along that motion the drive has nothing to do.
constexpr double kTolerance = 1e-8;  // of the largest reaction: accuracy of the integration

struct FourBarRow {
  double t, angle, rate, acceleration;                            // of revolute1 [s, rad]
  double revolute1[2], revolute2[2], revolute3[2], revolute4[2];  // force on the second link [N]
};
constexpr FourBarRow kFourBarRows[] = {
    {0,
     0,
     0,
     -27.004123849399374,
     {6.0751854464263175, 24.00178337899602},
     {6.0751854464263175, -9.92307089292895},
     {22.510295295386193, 41.944866147275334},
     {11.842186287504642, -12.86177965540254}},
    {0.1,
     -0.135509168570342,
     -2.722338312081175,
     -27.77578246661517,
     {-51.822042575369984, 31.230416023661096},
     {-34.73489516271939, -3.4400690316325333},
     {-31.154654841231842, 36.98136072753279},
     {-24.173525132376426, -17.623964484980128}},
    {0.25,
     -0.8816471539477067,
     -7.551127963446318,
     -42.090507806872644,
     {-307.60845857302445, 380.3645392218924},
     {-201.7449405242833, 278.3000243250583},
     {-237.91458757125002, 144.09230639025057},
     {-182.92937488453, 13.819436232329899}},
    {0.5,
     -3.29455123505894,
     -4.887362057574277,
     42.81350353488857,
     {94.36858154022677, -0.09228931112291627},
     {68.0588525885719, -4.835835132266015},
     {-93.67391451756305, 87.5628532659211},
     {-57.001324888886295, -16.23929409486347}},
    {1.0,
     -1.821090896419348,
     12.455705724055269,
     -41.92173480745927,
     {394.14257501733124, 1678.2238149486066},
     {397.5117325415612, 1355.2441739360931},
     {-43.43659946579494, 193.7746717617979},
     {-179.04956093574472, -129.29520389481735}},
    {2.0,
     -3.6244711850790043,
     0.019803028684106726,
     23.492295092135578,
     {-51.619721481516905, 51.31427118093038},
     {-34.821645040327, 7.844945650400451},
     {-44.50252692765174, 45.355275798637145},
     {-32.20969558098313, -7.519272483574393}},
};

struct EngineRow {
  double t, angle, rate, acceleration;  // of the crankshaft [s, rad]
  double main_force_yz[2], main_moment_yz[2];
  double cylinder_force_z, cylinder_moment_x;
  double wrist_force_yz[2], pin_force_yz[2];  // [N]
};
constexpr EngineRow kEngineRows[] = {
    {0,
     0,
     10.0,
     0,
     {-14.260842236025832, 0},
     {0, -3.6217853784770795},
     0,
     0,
     {31.407126149477108, 0},
     {36.38443694947711, 0}},
    {0.05,
     0.49952196754763767,
     9.979857762557312,
     0.000837247749504565,
     {11.149467518185771, -6.136571353928027},
     {0.9204857030892041, 0.18976108465466057},
     -4.541615932764346,
     0.45416159327643474,
     {11.805607546014311, -4.541615932764346},
     {12.626401797130137, -0.13348068358686746}},
    {0.1,
     1.000414882604904,
     10.105694514514267,
     5.878347259774522,
     {70.22433551394604, -34.09658626565828},
     {5.1144879398487415, 9.050991284018703},
     15.56717251151394,
     -1.556717251151396,
     {-34.13160872446463, 15.567172511513967},
     {-42.85551454286121, 23.216426052705454}},
    {0.25,
     2.6298906986976527,
     11.545789134514717,
     4.405326833298719,
     {191.16460659808885, -44.35155552647381},
     {6.652733328971074, 27.192031946640128},
     28.881551354212817,
     -2.8881551354212824,
     {-105.22659288023827, 28.88155135421281},
     {-140.90575646457006, 35.26782918075483}},
    {0.5,
     5.402105345659297,
     10.046852418236671,
     -4.07770354078812,
     {54.442357190703014, 25.100171145913354},
     {-3.7650256718870034, 6.683694535532245},
     -8.25207274779139,
     0.8252072747791406,
     {-21.855747092288688, -8.252072747791416},
     {-28.03094028072563, -15.207251041295306}},
    {1.0,
     10.76755532849101,
     10.907845198509053,
     -12.308141152196773,
     {169.3851835407114, 89.94395233544147},
     {-13.491592850316227, 23.92511848803352},
     -63.37922234524729,
     6.337922234524741,
     {-105.58836191121274, -63.37922234524748},
     {-132.1597252337536, -74.34558953011535}},
    {2.0,
     21.31296283203241,
     11.47027916869492,
     6.055866866425064,
     {191.1661577251775, -58.352398838361644},
     {8.752859825754252, 27.192264615703426},
     38.82146377718563,
     -3.8821463777185725,
     {-108.22185165211705, 38.82146377718579},
     {-142.9338819740309, 46.88416215295422}},
};

class ModelicaFourBar : public testing::TestWithParam<FourBarRow> {
 protected:
  void ExpectForce(const std::string& joint, const double expected[2]) const {
    const Vector3d force = OnSecond_W(four_bar_, loads_, joint).force;
    EXPECT_NEAR(force.x(), expected[0], kTolerance * scale_) << joint << " at " << row_.t << " s";
    EXPECT_NEAR(force.y(), expected[1], kTolerance * scale_) << joint << " at " << row_.t << " s";
  }

  const FourBarRow row_ = GetParam();
  const Mechanism four_bar_ = LedTo(Example("modelica-four-bar"), "revolute1", row_.angle);
  const PoseLoads loads_ =
      LoadsAt(four_bar_, {{"revolute1", {row_.angle, row_.rate, row_.acceleration}}});
  const double scale_ = 1 + std::hypot(row_.revolute1[0], row_.revolute1[1]) +
                        std::hypot(row_.revolute3[0], row_.revolute3[1]);
};

TEST_P(ModelicaFourBar, ReactionsAreThoseOfTheFreeMotion) {
  ExpectForce("revolute1", row_.revolute1);
  ExpectForce("revolute2", row_.revolute2);
  ExpectForce("revolute3", row_.revolute3);
  ExpectForce("revolute4", row_.revolute4);
}

TEST_P(ModelicaFourBar, TheDamperAloneActsAboutTheFirstJoint) {
  EXPECT_NEAR(loads_.drives[0].force, 0, kTolerance * scale_);
  EXPECT_NEAR(OnSecond_W(four_bar_, loads_, "revolute1").moment.z(), -0.1 * row_.rate,
              kTolerance * scale_);
}

INSTANTIATE_TEST_SUITE_P(AlongTheMotion, ModelicaFourBar, testing::ValuesIn(kFourBarRows));

/// The engine with its crankshaft at an angle: crank 0.1 m, rod 0.2 m in the y-z plane.
Mechanism EngineAt(double angle) {
  Mechanism engine = Example("modelica-engine1a");
  const double rod = -std::asin(0.5 * std::sin(angle));
  const double pin_on_rod = std::remainder(angle - rod, 4 * std::acos(-1.0));
  SetStart(&engine, "main", {angle});
  SetStart(&engine, "cylinder", {0.3 - 0.1 * std::cos(angle) - 0.2 * std::cos(rod)});
  SetStart(&engine, "wrist", {rod});
  SetStart(&engine, "ball", {std::cos(pin_on_rod / 2), 0, 0, std::sin(pin_on_rod / 2)});
  return engine;
}

class ModelicaEngine : public testing::TestWithParam<EngineRow> {
 protected:
  void ExpectPair(const Vector3d& actual, const double expected_yz[2], const char* what) const {
    EXPECT_NEAR(actual.y(), expected_yz[0], kTolerance * scale_)
        << what << " at " << row_.t << " s";
    EXPECT_NEAR(actual.z(), expected_yz[1], kTolerance * scale_)
        << what << " at " << row_.t << " s";
  }

  const EngineRow row_ = GetParam();
  const Mechanism engine_ = EngineAt(row_.angle);
  const PoseLoads loads_ = LoadsAt(engine_, {{"main", {row_.angle, row_.rate, row_.acceleration}}});
  const double scale_ = 1 + std::hypot(row_.main_force_yz[0], row_.main_force_yz[1]);
};

TEST_P(ModelicaEngine, ReactionsAreThoseOfTheFreeMotion) {
  const Wrenchd main = OnSecond_W(engine_, loads_, "main");
  ExpectPair(main.force, row_.main_force_yz, "main bearing, force");
  ExpectPair(main.moment, row_.main_moment_yz, "main bearing, moment");
  const Wrenchd cylinder = OnSecond_W(engine_, loads_, "cylinder");
  EXPECT_NEAR(cylinder.force.z(), row_.cylinder_force_z, kTolerance * scale_);
  EXPECT_NEAR(cylinder.moment.x(), row_.cylinder_moment_x, kTolerance * scale_);
  ExpectPair(OnSecond_W(engine_, loads_, "wrist").force, row_.wrist_force_yz, "piston pin");
  ExpectPair(OnSecond_W(engine_, loads_, "pin").force, row_.pin_force_yz, "crank pin");
}

TEST_P(ModelicaEngine, NothingPushesAlongTheCrankshaftAndTheDriveIsIdle) {
  for (const char* joint : {"main", "cylinder", "wrist", "ball", "pin"}) {
    EXPECT_NEAR(OnSecond_W(engine_, loads_, joint).force.x(), 0, kTolerance * scale_) << joint;
  }
  EXPECT_NEAR(loads_.drives[0].force, 0, kTolerance * scale_);
}

INSTANTIATE_TEST_SUITE_P(AlongTheMotion, ModelicaEngine, testing::ValuesIn(kEngineRows));

}  // namespace
}  // namespace vmech::reference::modelica_test
