#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "reference_cases.h"
#include "simulated.h"
#include "support/windows.h"
#include "vmech/base/linear_algebra/linear_algebra.h"
#include "vmech/dynamics/in_hand/coupled_dynamics.h"
#include "vmech/dynamics/loads/run_load_study.h"
#include "vmech/dynamics/simulation/motion_loads.h"
#include "vmech/dynamics/simulation/prepared_simulation.h"
#include "vmech/kinematics/loops/assembled_mechanism.h"
#include "vmech/kinematics/loops/dimensionless_loops.h"
#include "vmech/kinematics/tree/grasp_frame.h"

namespace vmech {
namespace {

/// An example, how long it is compared with IDAS, and how long it must keep its energy.
struct Case {
  std::string example;
  double compared = 0, kept = 0;  // [s]
};

class EveryMechanism : public testing::TestWithParam<Case> {
 protected:
  /// Under its weight and springs, without limits, which IDAS does not know.
  Simulation Falling(std::vector<double> times) const {
    Simulation simulation;
    simulation.mechanism = Example(GetParam().example);
    simulation.times = std::move(times);
    for (Joint& joint : simulation.mechanism.joints) {
      const Joint free = MakeJoint("", joint.type, {}, {});
      joint.lower = free.lower;
      joint.upper = free.upper;
    }
    return simulation;
  }
};

/// IDAS on the index-two equations shares no solve with CVODES on the free motions.
TEST_P(EveryMechanism, MovesTheSameByCvodesAndByIdas) {
  const double end = GetParam().compared;
  const Simulation simulation = Falling({0, 0.5 * end, end});
  const SimulationResult by_cvodes = Simulate(simulation, Tight(1e-10));
  SimulationOptions options = Tight(1e-9);
  options.method = SimulationMethod::kIdas;
  const SimulationResult by_idas = Simulate(simulation, options);
  ASSERT_EQ(by_idas.status, SimulationStatus::kFinished) << by_idas.message;
  const double size = 1 + by_cvodes.V(2).cwiseAbs().maxCoeff();
  EXPECT_LT((by_idas.Q(2) - by_cvodes.Q(2)).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_LT((by_idas.V(2) - by_cvodes.V(2)).cwiseAbs().maxCoeff(), 1e-5 * size);
  EXPECT_LT((by_idas.Vdot(2) - by_cvodes.Vdot(2)).cwiseAbs().maxCoeff(),
            1e-4 * (1 + by_cvodes.Vdot(2).cwiseAbs().maxCoeff()));
}

/// Loops' rates C v at a result, dimensionless [1/s].
double LargestLoopRate(const SimulationResult& result, size_t pose) {
  if (result.tree.loops.empty()) return 0;
  const VectorXd v = result.V(pose).cwiseQuotient(VelocityScale(result.tree));
  return (DimensionlessLoopJacobian(result.tree, result.Q(pose)) * v).cwiseAbs().maxCoeff();
}

TEST_P(EveryMechanism, KeepsItsEnergyAndItsLoops) {
  std::vector<double> times;
  for (int i = 0; i <= 10; ++i) times.push_back(0.1 * i * GetParam().kept);
  SimulationOptions options = Tight(1e-12);
  options.loads = false;
  const SimulationResult result = Simulate(Falling(times), options);
  ASSERT_EQ(result.status, SimulationStatus::kFinished) << result.message;
  EXPECT_GT(result.V(10).norm(), 1e-3);  // it moves
  EXPECT_LT(EnergyError(result), 1e-8);
  EXPECT_LT(result.statistics.largest_closure, 1e-12);
  // Nothing decays where energy is kept.
  const bool damped = GetParam().example == "flyball-governor";
  if (!damped) EXPECT_EQ(result.statistics.method, SimulationMethod::kAdams);
  for (size_t i = 0; i < result.size(); ++i) EXPECT_LT(LargestLoopRate(result, i), 1e-10);
}

/// Motors at independent freedoms that move as the mechanism does; none at ball joints, about which
/// a rod then spins as it likes.
std::vector<JointDrive> DrivesLike(const SimulationResult& result, size_t pose) {
  const KinematicTree& tree = result.tree;
  MatrixXd free =
      FindNullSpace(DimensionlessLoopJacobian(tree, result.Q(pose)), kRankTolerance).basis;
  for (const TreeNode& node : tree.nodes) {
    if (node.motion == NodeMotion::kSpherical) free.middleRows(node.v, 3).setZero();
  }
  const auto rank = static_cast<int>(FindNullSpace(free, kRankTolerance).rank);
  std::vector<JointDrive> drives;
  for (const int v : MostIndependentRows(free, rank)) {
    const auto node = std::find_if(tree.nodes.begin(), tree.nodes.end(), [v](const TreeNode& n) {
      return n.v >= 0 && n.v <= v && v < n.v + VelocitiesOf(n.motion);
    });
    const JointSample joint =
        result.loads.poses.arrays().Joint(pose, static_cast<size_t>(node->joint));
    const int k = node->freedom;
    drives.push_back({node->joint, k,
                      MotionLaw::Uniform(joint.position[k], joint.rate[k], joint.acceleration[k])});
  }
  return drives;
}

/// What moves by itself needs no motor: those that prescribe the same motion exert nothing.
TEST_P(EveryMechanism, InverseDynamicsAsksForNoForce) {
  const SimulationResult result = Simulate(Falling({0, 0.5 * GetParam().compared}), Tight(1e-10));
  LoadStudy study;
  study.drives = DrivesLike(result, 1);
  ASSERT_FALSE(study.drives.empty());
  study.mechanism = result.tree.mechanism;
  SetStarts(result.tree, result.Q(1), &study.mechanism);
  study.times = {0};
  const PoseLoads inverse = RunLoadStudy(study).poses.front();
  const LoadArrays& loads = result.loads.poses.arrays();
  double size = 0;
  for (const double wrench : loads.wrenches) size = std::max(size, std::abs(wrench));
  for (const DriveSample& drive : inverse.drives) EXPECT_NEAR(drive.force, 0, 1e-7 * size);
  for (size_t j = 0; j < loads.joint_count(); ++j) {
    EXPECT_LT((inverse.joints[j].Stacked() - loads.Wrench(1, j).Stacked()).norm(), 1e-7 * size);
  }
}

// All that move of themselves. Platforms whose legs have no limits fall out of all reach within ten
// seconds: a leg is then a hundred times as long as the mechanism.
INSTANTIATE_TEST_SUITE_P(
    Examples, EveryMechanism,
    testing::Values(Case{"crank", 0.5, 10}, Case{"two-link-arm", 0.5, 10},
                    Case{"slider-crank", 0.3, 10}, Case{"four-bar", 0.5, 10}, Case{"rssr", 0.3, 10},
                    Case{"rsup", 0.3, 10}, Case{"spherical-four-bar", 0.5, 10},
                    Case{"bennett", 0.5, 10}, Case{"bricard", 0.5, 10},
                    Case{"stewart-gough", 0.05, 3}, Case{"delta-robot", 0.1, 10},
                    Case{"square-four-bar", 0.3, 10}, Case{"marghitu-slider-crank", 0.3, 10},
                    Case{"modelica-four-bar", 0.3, 10}, Case{"flyball-governor", 0.1, 1},
                    Case{"sundials-slider-crank", 0.3, 10}, Case{"dietmaier-platform", 0.05, 3},
                    Case{"manseur-doty", 0.3, 10}, Case{"puma-560", 0.3, 10},
                    Case{"redundant-arm", 0.3, 5}),
    [](const auto& info) { return TestName(info.param.example); });

/// Of a simulation with a crank's motor and an external load from 0 to 1 s.
void ExpectInverseGivesBackForces(const Simulation& simulation) {
  const SimulationResult result = Simulate(simulation);
  ASSERT_EQ(result.status, SimulationStatus::kFinished) << result.message;
  const LoadArrays& loads = result.loads.poses.arrays();
  for (size_t i = 0; i < result.size(); ++i) {
    LoadStudy study;
    study.mechanism = result.tree.mechanism;
    SetStarts(result.tree, result.Q(i), &study.mechanism);
    const JointSample crank = loads.Joint(i, 0);
    study.drives = {
        {0, 0, MotionLaw::Uniform(crank.position[0], crank.rate[0], crank.acceleration[0])}};
    study.times = {0};
    study.external = simulation.external;
    const Wrenchd &a = study.external[0].wrenches[0], &b = study.external[0].wrenches[1];
    const double s = result.times[i];
    study.external[0].over = ExternalLoad::Over::kConstant;
    study.external[0].at.clear();
    study.external[0].wrenches = {
        {(1 - s) * a.force + s * b.force, (1 - s) * a.moment + s * b.moment}};
    const PoseLoads inverse = RunLoadStudy(study).poses.front();
    EXPECT_NEAR(inverse.drives[0].force, result.motor_forces[i], 1e-7);
    for (size_t j = 0; j < loads.joint_count(); ++j) {
      EXPECT_LT((inverse.joints[j].Stacked() - loads.Wrench(i, j).Stacked()).norm(),
                1e-7 * (1 + loads.Wrench(i, j).Stacked().norm()))
          << j;
    }
  }
  EXPECT_LT(result.loads.max_power_error, 1e-9);
}

TEST(Simulate, InverseDynamicsGivesBackTheForcesAndTheWrenches) {
  Simulation simulation = LoadedFourBar();
  ExpectInverseGivesBackForces(simulation);
  // Its crank stops dead and falls back; its rocker turns back twice, under friction.
  simulation.mechanism.joints[0].upper = {simulation.mechanism.joints[0].start[0] + 0.3};
  simulation.mechanism.joints[3].passive[0].coulomb = 0.4;
  ExpectInverseGivesBackForces(simulation);
}

JointHistory HistoryOf(const SimulationResult& result) {
  const LoadArrays& loads = result.loads.poses.arrays();
  return {result.times,
          {loads.positions.begin(), loads.positions.end()},
          {loads.rates.begin(), loads.rates.end()},
          {loads.accelerations.begin(), loads.accelerations.end()}};
}

/// Largest difference of wrenches, over the largest of them.
double WrenchesApart(const LoadStudyResult& a, const LoadStudyResult& b) {
  const auto& x = a.poses.arrays().wrenches;
  const auto& y = b.poses.arrays().wrenches;
  double apart = 0, size = 0;
  for (size_t i = 0; i < x.size(); ++i) {
    apart = std::max(apart, std::abs(x[i] - y.at(i)));
    size = std::max(size, std::abs(x[i]));
  }
  return apart / size;
}

void ExpectSameLoads(const Simulation& simulation) {
  const SimulationResult result = Simulate(simulation);
  ASSERT_EQ(result.status, SimulationStatus::kFinished) << result.message;
  const LoadStudyResult again = EvaluateMotionLoads(simulation, HistoryOf(result));
  ASSERT_EQ(again.poses.size(), result.size());
  EXPECT_LT(WrenchesApart(result.loads, again), 1e-12);
  EXPECT_EQ(again.certainty, result.loads.certainty);
  EXPECT_EQ(again.open, result.loads.open);
  EXPECT_EQ(again.mobility, result.loads.mobility);
}

TEST(EvaluateMotionLoads, AreThoseOfTheSimulationThatMadeTheMotion) {
  Simulation simulation = LoadedFourBar();
  ExpectSameLoads(simulation);
  simulation = {};
  simulation.mechanism = Pendulum(3);
  simulation.mechanism.joints[0].passive[0].coulomb = 16;  // it comes to rest aslant
  simulation.mechanism.joints[0].lower = {-1.2};           // after a rebound
  simulation.rebounds = {{{0, 0}, 0.5}};
  simulation.times = {0, 0.2, 0.5, 0.9, 2};
  ExpectSameLoads(simulation);
  simulation = {};
  simulation.mechanism = Example("delta-robot");
  simulation.drives = {{0, 0, MotionLaw::Uniform(0.1, 0.5, 2)}};
  simulation.times = {0, 0.03, 0.06};
  ExpectSameLoads(simulation);
  simulation = {};
  simulation.mechanism = Example("two-link-arm");
  simulation.times = {0, 0.1, 0.4};
  ExpectSameLoads(simulation);
}

TEST(EvaluateMotionLoads, AForceThatIsMissingIsTold) {
  Simulation simulation = LoadedFourBar();
  const JointHistory history = HistoryOf(Simulate(simulation));
  simulation.motors.clear();
  try {
    EvaluateMotionLoads(simulation, history);
    FAIL();
  } catch (const std::invalid_argument& error) {
    // The motor's force is largest at the start.
    const std::string message = error.what();
    EXPECT_NE(message.find("does not give this motion: at t = 0 s"), std::string::npos) << message;
    EXPECT_NE(message.find("N m are missing along"), std::string::npos) << message;
  }
  // A drive exerts what is missing.
  const Joint& crank = simulation.mechanism.joints[0];
  simulation.drives = {{0, 0, MotionLaw::Uniform(crank.start[0], 1)}};
  const LoadStudyResult loads = EvaluateMotionLoads(simulation, history);
  for (size_t i = 0; i < loads.poses.size(); ++i) {
    const double t = history.times[i];
    const double motor = t < 0.3 ? 2 - 10 * t : -1 + 2 * (t - 0.3) / 0.7;
    EXPECT_NEAR(loads.poses[i].drives[0].force, motor, 1e-9) << t;
  }
}

TEST(Simulate, ADriveMovesAsPrescribedAndItsForceIsThatOfALoadStudy) {
  Simulation simulation;
  simulation.mechanism = Example("slider-crank");
  LoadStudy study;
  study.drives = {{0, 0, MotionLaw::Uniform(0.3, 5, 2)}};
  simulation.drives = study.drives;
  simulation.times = {0, 0.2, 0.7};
  const SimulationResult result = Simulate(simulation);
  study.mechanism = simulation.mechanism;
  study.times = simulation.times;
  const LoadStudyResult inverse = RunLoadStudy(study);
  for (size_t i = 0; i < 3; ++i) {
    const double force = inverse.poses[i].drives[0].force;
    EXPECT_NEAR(result.loads.poses[i].drives[0].force, force, 1e-9 * (1 + std::abs(force)));
  }
}

/// Four-bar in a hand that stands still: errors of the real-time loop's step against the
/// simulation.
TEST(CoupledDynamics, ConvergesToTheSimulationAsItsStepShrinks) {
  Simulation simulation;
  simulation.mechanism = Example("four-bar");
  GraspSpring spring;
  spring.grasp = 0;
  spring.coupling.stiffness << 40, 40, 40, 0.5, 0.5, 0.5;
  spring.coupling.damping << 4, 4, 4, 0.02, 0.02, 0.02;
  const AssembledMechanism assembled = RequireAssembled(simulation.mechanism);
  const KinematicTree tree = BuildKinematicTree(assembled.mechanism);
  const GraspFrame grasp = GraspFrameOf(tree, 0);
  const VectorXd q = StartCoordinates(tree);
  CoupledDynamics at_start(tree, grasp, spring.coupling, 1e-3, q);
  Posed X_WH = at_start.X_WG();
  X_WH.p += Vector3d(0.03, 0.02, 0);
  spring.hand = [&](double) { return HandSample{X_WH, Vector6d::Zero(), Vector6d::Zero()}; };
  simulation.hand = spring;
  constexpr double kEnd = 0.1;
  simulation.times = {0, kEnd};
  const SimulationResult exact = Simulate(simulation, Tight(1e-11));
  std::vector<double> errors;
  for (const double step : {1e-3, 5e-4, 2.5e-4}) {
    CoupledDynamics loop(tree, grasp, spring.coupling, step, q);
    for (int i = 0; i < std::lround(kEnd / step); ++i) {
      ASSERT_EQ(loop.Step(X_WH, Vector6d::Zero()), CoupledStatus::kMoved);
    }
    const int crank = CoordinateIndex(tree, 0, 0);
    errors.push_back(loop.q()[crank] - PositionIn(exact, 1, tree.mechanism.joints[0].name));
  }
  EXPECT_NEAR(errors[0] / errors[1], 2, 0.1);  // first order
  EXPECT_NEAR(errors[1] / errors[2], 2, 0.05);
  EXPECT_LT(std::abs(errors[2]), 2e-3);
}

}  // namespace
}  // namespace vmech
