/// What the hand feels of a mechanism on the virtual coupling: its weight, its inertia, and nothing
/// of its constraints along the way that they leave free.

#include <gtest/gtest.h>

#include <complex>
#include <numbers>

#include "hw_interface/free_motion.h"
#include "hw_interface/tick_input.h"
#include "support/examples.h"
#include "vmech/dynamics/loads/load_study.h"
#include "vmech/dynamics/loads/run_load_study.h"
#include "vmech/hw_interface/masters/simulated_master.h"
#include "vmech/hw_interface/rendering/coupled_tick.h"
#include "vmech/hw_interface/rendering/coupling_choice.h"
#include "vmech/kinematics/loops/assembly.h"
#include "vmech/kinematics/tree/forward_kinematics.h"

namespace vmech::feel_test {
namespace {

constexpr double kPeriod = 1e-3;

/// The grasp called "handle", else the first; -1 if there is none.
int HandleOf(const Mechanism& mechanism) {
  for (size_t i = 0; i < mechanism.grasps.size(); ++i) {
    if (mechanism.grasps[i].name == "handle") return static_cast<int>(i);
  }
  return mechanism.grasps.empty() ? -1 : 0;
}

std::vector<std::string> ExamplesToHold() {
  std::vector<std::string> names;
  for (const std::string& name : ExampleNames()) {
    if (HandleOf(Example(name)) >= 0) names.push_back(name);
  }
  return names;
}

/// The coupling of a mechanism to a simulated arm.
CoupledTickOptions CouplingFor(const Mechanism& mechanism) {
  const KinematicTree tree = BuildKinematicTree(mechanism);
  SimulatedMaster master;
  master.Configure();
  CoupledTickOptions options;
  const CouplingChoice choice = ChooseCoupling(tree, GraspFrameOf(tree, HandleOf(mechanism)),
                                               ClosedStart(tree), master.info(), options.smoothing);
  options.coupling = choice.coupling;
  options.scale = choice.scale;
  return options;
}

/// A mechanism in a hand that goes exactly where it is told.
struct Held {
  Held(const Mechanism& mechanism, const CoupledTickOptions& options)
      : tree(BuildKinematicTree(mechanism)),
        grasp(HandleOf(mechanism)),
        frame(GraspFrameOf(tree, grasp)),
        q(ClosedStart(tree)),
        scale(options.scale),
        tick(tree, grasp, q, kPeriod, options),
        channels(tick.ChannelNames().size()) {}
  explicit Held(const Mechanism& mechanism) : Held(mechanism, CouplingFor(mechanism)) {}

  TickOutput Step(const Posed& X_WH) {
    const TickOutput out = tick.Step(FreshInput(X_WH, kPeriod), channels);
    EXPECT_EQ(out.status, TickStatus::kOk);
    return out;
  }
  /// What the hand does to the whole mechanism, not scaled.
  Vector6d RestingWrench(const Posed& X_WH) {
    for (int k = 0; k < 4000; ++k) Step(X_WH);
    return -Step(X_WH).F_Ho_W / scale;
  }

  KinematicTree tree;
  int grasp;
  GraspFrame frame;
  VectorXd q;
  double scale;
  CoupledTick tick;
  std::vector<double> channels;
};

/// Of all links, and of springs in the tree's joints.
double PotentialEnergy(const KinematicTree& tree, const VectorXd& q) {
  GraspedMechanism pose(tree, GraspFrame{});
  pose.Set(q);
  double energy = 0;
  for (size_t i = 0; i < tree.nodes.size(); ++i) {
    const TreeNode& node = tree.nodes[i];
    const Posed X_WB = pose.X_WB(static_cast<int>(i));
    energy -= node.mass * tree.mechanism.gravity_W.dot(X_WB * node.p_BoBcm);
    if (node.v < 0 || node.motion == NodeMotion::kSpherical) continue;
    const Passive& spring = tree.mechanism.joints[node.joint].passive[node.freedom];
    energy += 0.5 * spring.stiffness * std::pow(q[node.q] - spring.rest, 2);
  }
  return energy;
}

/// dV/ds along each free motion, by central differences of fourth order between closed poses.
VectorXd EnergyGradient(const KinematicTree& tree, const VectorXd& q, const MatrixXd& N) {
  constexpr double kStep = 2e-3;
  VectorXd gradient(N.cols());
  for (int i = 0; i < N.cols(); ++i) {
    const auto at = [&](double steps) {
      VectorXd there = q;
      MoveCoordinates(tree, steps * kStep * N.col(i), &there);
      EXPECT_TRUE(Assemble(tree, {}, &there).closed);
      return PotentialEnergy(tree, there);
    };
    gradient[i] = (8 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12 * kStep);
  }
  return gradient;
}

class EveryHeldExample : public testing::TestWithParam<std::string> {};

/// Resting means: at the pose where the mechanism really stands, sagged on the spring. The whole
/// weight is the scale; a free motion may be level.
TEST_P(EveryHeldExample, HandAtRestFeelsExactlyTheGravityShare) {
  Held held(Example(GetParam()));
  const Vector6d w = held.RestingWrench(held.tick.GraspFrame());
  const VectorXd& q = held.tick.dynamics().q();
  const MatrixXd N = FreeVelocities(held.tree, q);
  GraspedMechanism pose(held.tree, held.frame);
  pose.Set(q);
  const VectorXd felt = (pose.J() * N).transpose() * w;
  const VectorXd share = EnergyGradient(held.tree, q, N);
  constexpr double kExact = 1e-6;
  EXPECT_LT((felt - share).norm(), kExact * std::max(1.0, share.norm()))
      << "felt " << felt.transpose() << " share " << share.transpose();
}

/// The load study of the same pose, held by the hand, in all that works along the free motions.
TEST_P(EveryHeldExample, HandAtRestFeelsWhatTheLoadStudyOfThatPoseSays) {
  Held held(Example(GetParam()));
  const Vector6d w = held.RestingWrench(held.tick.GraspFrame());
  LoadStudy study;
  study.mechanism = held.tree.mechanism;
  study.hand =
      HandDrive{held.grasp, HandLaw::Table({0}, {held.tick.GraspFrame()}), Vector6d::Zero()};
  study.times = {0};
  study.rule = ReactionRule::kMinimumNorm;
  const Vector6d w_study = RunLoadStudy(study).poses[0].hand.Stacked();
  GraspedMechanism pose(held.tree, held.frame);
  pose.Set(held.tick.dynamics().q());
  const MatrixXd JN = pose.J() * FreeVelocities(held.tree, held.tick.dynamics().q());
  constexpr double kExact = 1e-6;
  EXPECT_LT((JN.transpose() * (w - w_study)).norm(),
            kExact * std::max(1.0, (JN.transpose() * w_study).norm()));
}

INSTANTIATE_TEST_SUITE_P(Examples, EveryHeldExample, testing::ValuesIn(ExamplesToHold()),
                         [](const auto& info) { return TestName(info.param); });

/// Next to no mass, no friction, no weight.
Mechanism Feather(Mechanism mechanism) {
  constexpr double kFeather = 1e-6;
  mechanism.gravity_W.setZero();
  for (Link& link : mechanism.links) {
    link.mass_properties.mass *= kFeather;
    link.mass_properties.I_Lcm *= kFeather;
  }
  for (Joint& joint : mechanism.joints) {
    std::fill(joint.passive.begin(), joint.passive.end(), Passive{});
  }
  return mechanism;
}

class EveryOneFreedomExample : public testing::TestWithParam<std::string> {};

/// The hand goes to and fro beside the track, so that the constraints pull at it.
TEST_P(EveryOneFreedomExample, FreeMotionFeelsNoConstraint) {
  CoupledTickOptions options;
  options.coupling.stiffness << 2000, 2000, 2000, 5, 5, 5;
  options.coupling.damping << 20, 20, 20, 0.05, 0.05, 0.05;
  Held held(Feather(Example(GetParam())), options);
  constexpr double kStroke = 0.025;
  const FreeMotion motion(held.tree, held.frame, held.q, kStroke + 0.005);
  GraspedMechanism pose(held.tree, held.frame);
  double most = 0;
  for (int k = 0; k < 2000; ++k) {
    Posed X_WH = motion.At(kStroke * std::sin(2 * std::numbers::pi * k * kPeriod)).X_WH;
    X_WH.p += Vector3d(2e-3, -1e-3, 3e-3);
    X_WH.R = Eigen::AngleAxisd(0.02, Vector3d(0.6, 0, 0.8)).toRotationMatrix() * X_WH.R;
    const VectorXd q = held.tick.dynamics().q();
    const Vector6d w = -held.Step(X_WH).F_Ho_W;
    if (k < 500 || k % 50 != 0) continue;
    pose.Set(q);
    const Vector6d way = (pose.J() * FreeVelocities(held.tree, q)).col(0).normalized();
    most = std::max(most, w.norm());
    constexpr double kNothing = 1e-4;  // of the constraint's pull
    EXPECT_LT(std::abs(way.dot(w)), kNothing * w.norm()) << k;
  }
  EXPECT_GT(most, 2);  // the constraints do pull
}

/// The part of the felt force that goes with what the true mechanism resists the motion with, both
/// as they vary at the rate of the stroke.
double FeltOverTrueInertia(Held* held, const FreeMotion& motion, double stroke, double hertz) {
  const double rate = 2 * std::numbers::pi * hertz;
  std::complex<double> felt = 0, expected = 0;
  for (int k = 0; k < 4000; ++k) {
    const double t = k * kPeriod, s = stroke * std::sin(rate * t);
    const HandSample hand = motion.At(s);
    const double force = -held->Step(hand.X_WH).F_Ho_W.dot(hand.V_WH) / held->scale;
    if (k < 2000) continue;  // the rest is whole periods of every rate here
    const std::complex<double> phase = std::polar(1.0, -rate * t);
    felt += phase * force;
    expected +=
        phase * motion.InertiaForce(s, stroke * rate * std::cos(rate * t), -rate * rate * s);
  }
  return (felt / expected).real();
}

/// As far as the device can exert it: to half of its largest force.
TEST_P(EveryOneFreedomExample, FeltInertiaIsTheTrueOneAlongLongStrokes) {
  Mechanism mechanism = Example(GetParam());
  const CoupledTickOptions options = CouplingFor(mechanism);
  mechanism.gravity_W.setZero();
  for (Joint& joint : mechanism.joints) {
    std::fill(joint.passive.begin(), joint.passive.end(), Passive{});
  }
  const KinematicTree tree = BuildKinematicTree(mechanism);
  const FreeMotion motion(tree, GraspFrameOf(tree, HandleOf(mechanism)), ClosedStart(tree), 0.055);
  int felt = 0;
  for (const double stroke : {0.01, 0.025, 0.05}) {
    for (const double hertz : {0.5, 1.0, 2.0, 3.0}) {
      const double rate = 2 * std::numbers::pi * hertz;
      double most = 0;
      for (const double s : {-stroke, stroke}) {
        most = std::max(most, std::abs(motion.InertiaForce(s, 0, -rate * rate * s)));
      }
      if (options.scale * most > 0.5 * options.coupling.max_force) continue;
      Held held(mechanism, options);
      EXPECT_NEAR(FeltOverTrueInertia(&held, motion, stroke, hertz), 1, 0.05)
          << stroke << " m at " << hertz << " Hz";
      ++felt;
    }
  }
  EXPECT_GE(felt, 8);
}

INSTANTIATE_TEST_SUITE_P(Examples, EveryOneFreedomExample,
                         testing::Values("crank", "slider-crank", "four-bar", "rssr", "rsup",
                                         "spherical-four-bar", "bennett", "bricard",
                                         "marghitu-slider-crank", "modelica-four-bar",
                                         "n-window-four-bar", "square-four-bar",
                                         "door-on-two-hinges"),
                         [](const auto& info) { return TestName(info.param); });

}  // namespace
}  // namespace vmech::feel_test
