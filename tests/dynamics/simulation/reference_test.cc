#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "simulated.h"
#include "support/windows.h"

namespace vmech {
namespace {

/// Simple pendulum, benchmark A01 of the IFToMM library: closed form with Jacobi's functions; the
/// benchmark asks for 1e-3 over 845 swings.
TEST(Simulate, PendulumSwingsForTwoThousandSeconds) {
  Simulation simulation;
  simulation.mechanism = Pendulum();
  simulation.times = {0, 10, 2000};
  const SimulationResult result = Simulate(simulation, Tight(1e-12));
  ASSERT_EQ(result.status, SimulationStatus::kFinished) << result.message;
  EXPECT_NEAR(std::cos(result.Q(1)[0]), 0.2750874625761169, 1e-9);
  EXPECT_NEAR(std::cos(result.Q(2)[0]), -0.8146030685890322, 2e-6);
  EXPECT_NEAR(std::sin(result.Q(2)[0]), -0.5800188278369355, 2e-6);
  EXPECT_NEAR(result.loads.poses.back().joints[0].force.norm(), 17.06995410324101, 1e-4);
  EXPECT_LT(EnergyError(result), 1e-7);
}

/// N-window four-bar, benchmark A02: the equation of one freedom with 40 digits; through the flat
/// pose, where all windows could fold.
TEST(Simulate, WindowsFallThroughTheirFlatPose) {
  const double expected[][3] = {{1, 0.478385057760970559, 0.878150178791209301},
                                {2, 0.328458111540815379, 0.944518538178600962},
                                {40, 0.18051222668672839, 0.983572740582311575}};
  for (const auto& [windows, x, y] : expected) {
    Simulation simulation;
    simulation.mechanism = Windows(static_cast<int>(windows), 0);
    simulation.start_rates = {{FreedomOf(simulation.mechanism, "a0"), -1}};
    for (double t = 0; t < 10.5; ++t) simulation.times.push_back(t);
    // As little as the time of the longest one allows; measured there 1.3e-7 at most.
    const double tolerance = windows > 2 ? 1e-10 : 1e-12, error = windows > 2 ? 5e-7 : 1e-7;
    const SimulationResult result = Simulate(simulation, Tight(tolerance));
    ASSERT_EQ(result.status, SimulationStatus::kFinished) << result.message;
    const double lean = PositionIn(result, 10, "a0");
    EXPECT_NEAR(-std::sin(lean), x, error) << windows;
    EXPECT_NEAR(std::cos(lean), y, error) << windows;
    EXPECT_LT(EnergyError(result), 1e-8) << windows;
    EXPECT_LT(result.statistics.largest_closure, 1e-12) << windows;
  }
}

/// Problem "andrews" of the CWI/Bari test set: published to 1.4e-9 rad.
TEST(Simulate, AndrewsSqueezerIsWhereItIsPublished) {
  const std::pair<const char*, double> expected[] = {
      {"main", 15.810771195155032}, {"k2", -15.756371058413496}, {"k3", 0.040822240119658605},
      {"k4", -0.5347301163420572},  {"k5", 0.5244099658799546},  {"k6", 0.5347301163420572},
      {"k7", 1.0480807410419382}};
  Simulation simulation;
  simulation.mechanism = Example("andrews-squeezer");
  JointMotor motor;
  motor.at = FreedomOf(simulation.mechanism, "main");
  motor.force = {{0}, {0.033}, 0};
  simulation.motors = {motor};
  simulation.times = {0, 0.03};
  const SimulationResult result = Simulate(simulation);
  for (const auto& [joint, position] : expected) {
    EXPECT_NEAR(PositionIn(result, 1, joint), position, 1e-8) << joint;
  }
  EXPECT_LT(EnergyError(result), 1e-8);
}

/// Bricard's linkage, benchmark A04: by absolute coordinates with multipliers, energy kept to
/// 6e-14.
TEST(Simulate, BricardsLinkageFallsAsInTheBenchmark) {
  const std::pair<double, Vector3d> expected[] = {
      {0, {1, -1, 1}},
      {1, {0.5105014611872213, -1.649167599394806, 0.1401231145531867}},
      {5, {0.9999999977380492, -1.0000672576978755, 0.9999327400403255}},
      {10, {0.9999999638063495, -1.0002690126961575, 0.999730951119927}}};
  Simulation simulation;
  simulation.mechanism = Example("bricard");
  for (const auto& [t, p3] : expected) simulation.times.push_back(t);
  const SimulationResult result = Simulate(simulation, Tight(1e-12));
  const Grasp& p3 = simulation.mechanism.grasps[FindGrasp(simulation.mechanism, "p3")];
  for (size_t i = 0; i < result.size(); ++i) {
    const Vector3d p = result.loads.poses[i].links[p3.link].X_WL * p3.X_LG.p;
    EXPECT_LT((p - expected[i].second).norm(), 1e-8) << expected[i].first;
  }
  EXPECT_LT(EnergyError(result), 1e-8);
}

/// Flyball governor, benchmark A05: Lagrange's equations of the symmetric motion by RK4 in long
/// double. Its springs and dampers are stiff.
TEST(Simulate, FlyballGovernorProvesStiff) {
  const double expected[][3] = {{0.5, 2.807679488368, 0.743249424786},
                                {1, 5.586346965869, 0.50142092238},
                                {5, 27.942531991043, 0.535563103722}};
  Simulation simulation;
  simulation.mechanism = Example("flyball-governor");
  simulation.start_rates = {{FreedomOf(simulation.mechanism, "spin"), 2 * std::numbers::pi}};
  simulation.times = {0, 0.5, 1, 5};
  const SimulationResult result = Simulate(simulation);
  ASSERT_EQ(result.status, SimulationStatus::kFinished) << result.message;
  for (size_t i = 1; i < result.size(); ++i) {
    EXPECT_NEAR(PositionIn(result, i, "spin"), expected[i - 1][1], 1e-6);
    EXPECT_NEAR(PositionIn(result, i, "slide"), expected[i - 1][2], 1e-7);
  }
  EXPECT_EQ(result.statistics.method, SimulationMethod::kBdf);
  EXPECT_LT(EnergyError(result), 1e-6);
}

/// idaSlCrank of the SUNDIALS examples: five digits are published, twelve by elimination of the
/// dependent coordinates.
TEST(Simulate, SliderCrankOfSundials) {
  const double expected[][3] = {{1, 1.315420570882, 1.001491807231},
                                {2, 0.579038812049, 1.380335271961},
                                {5, -1.429996967647, 0.939030613578},
                                {10, 1.27567584865, 1.02357855898}};
  Simulation simulation;
  simulation.mechanism = Example("sundials-slider-crank");
  ExternalLoad load;
  load.link = FindLink(simulation.mechanism, "rod");
  load.p_L = {1, 0, 0};
  load.wrenches = {{{1, 0, 0}, {0, 0, 0}}};
  simulation.external = {load};
  simulation.times = {0, 1, 2, 5, 10};
  const SimulationResult result = Simulate(simulation, Tight(1e-12));
  for (size_t i = 1; i < result.size(); ++i) {
    EXPECT_NEAR(PositionIn(result, i, "main"), expected[i - 1][1], 1e-8);
    EXPECT_NEAR(PositionIn(result, i, "guide"), expected[i - 1][2], 1e-8);
  }
  EXPECT_LT(EnergyError(result), 1e-8);
}

/// Loops.Examples.Fourbar_... and Engine1a of the Modelica Standard Library: results published with
/// a tolerance of 1e-6, and by Gragg-Bulirsch-Stoer extrapolation with multipliers.
TEST(Simulate, LoopsOfModelica) {
  Simulation four_bar;
  four_bar.mechanism = Example("modelica-four-bar");
  four_bar.times = {0, 0.5, 1, 2};
  const SimulationResult swung = Simulate(four_bar, Tight(1e-12));
  EXPECT_NEAR(PositionIn(swung, 1, "revolute1"), -3.29455123505894, 1e-7);
  EXPECT_NEAR(PositionIn(swung, 2, "revolute1"), -1.821090896419348, 1e-7);
  EXPECT_NEAR(PositionIn(swung, 3, "revolute1"), -3.6244711850790043, 1e-7);
  Simulation engine;
  engine.mechanism = Example("modelica-engine1a");
  engine.start_rates = {{FreedomOf(engine.mechanism, "main"), 10}};
  engine.times = {0, 0.5, 1, 2};
  const SimulationResult turned = Simulate(engine, Tight(1e-12));
  EXPECT_NEAR(PositionIn(turned, 1, "main"), 5.402105345659297, 1e-7);
  EXPECT_NEAR(PositionIn(turned, 2, "main"), 10.76755532849101, 1e-7);
  EXPECT_NEAR(PositionIn(turned, 3, "main"), 21.31296283203241, 1e-7);
}

}  // namespace
}  // namespace vmech
