// Rods between two spherical joints, whose spin nothing prescribes and, where they have no inertia
// about their axis, nothing resists.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <ostream>
#include <stdexcept>

#include "driven_examples.h"
#include "vmech/dynamics/in_hand/coupled_dynamics.h"
#include "vmech/dynamics/in_hand/hand_dynamics.h"
#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/prepare_study.h"
#include "vmech/dynamics/loads/run_load_study.h"
#include "vmech/kinematics/loops/assembled_mechanism.h"

namespace vmech {
namespace {

constexpr double kAlike = 1e-9;  // of the largest force: the promise

enum class Rods { kUniversal, kMassless, kPointMass, kThin };

void PrintTo(Rods rods, std::ostream* out) {
  constexpr const char* kNames[] = {"Universal", "Massless", "PointMass", "Thin"};
  *out << kNames[static_cast<int>(rods)];
}

/// A frame at p whose z points to q.
Posed Towards(const Vector3d& p, const Vector3d& q) {
  const Vector3d z = (q - p).normalized();
  const Vector3d x = std::abs(z.x()) < 0.9 ? Vector3d::UnitX() : Vector3d::UnitY();
  return {AxesFromZX(z, x), p};
}

/// Mechanisms drawn in the world at their start, link by link.
class Drawing {
 public:
  explicit Drawing(const Vector3d& gravity) {
    mechanism_.gravity_W = gravity;
    Body("ground", 0, Vector3d::Zero(), 0);
  }

  int Body(const std::string& name, double mass, const Vector3d& p_cm, double inertia) {
    Link link;
    link.name = name;
    link.mass_properties = {mass, p_cm, inertia * Matrix3d::Identity()};
    mechanism_.links.push_back(link);
    return static_cast<int>(mechanism_.links.size()) - 1;
  }

  int Connect(const std::string& name, JointType type, int a, int b, const Posed& X) {
    mechanism_.joints.push_back(MakeJoint(name, type, Anchor(a, name, X), Anchor(b, name, X)));
    return static_cast<int>(mechanism_.joints.size()) - 1;
  }

  /// A rod from p on link a to q on link b.
  void Rod(const std::string& name, Rods rods, double mass, int a, const Vector3d& p, int b,
           const Vector3d& q) {
    const bool no_mass = rods == Rods::kMassless || mass == 0;
    const int rod = Body(name, no_mass ? 0 : mass, 0.5 * (p + q), 0);
    if (rods == Rods::kThin || rods == Rods::kUniversal) {
      const Vector3d way = q - p;
      mechanism_.links[rod].mass_properties.I_Lcm =
          mass / 12 * (way.squaredNorm() * Matrix3d::Identity() - way * way.transpose());
    }
    const Posed X = Towards(p, q);
    Connect(name + "_p", rods == Rods::kUniversal ? JointType::kUniversal : JointType::kSpherical,
            a, rod, X);
    Connect(name + "_q", JointType::kSpherical, rod, b, {X.R, q});
  }

  Mechanism& mechanism() { return mechanism_; }

 private:
  AnchorId Anchor(int link, const std::string& name, const Posed& X) {
    mechanism_.links[link].anchors.push_back({name, X});
    return {link, static_cast<int>(mechanism_.links[link].anchors.size()) - 1};
  }

  Mechanism mechanism_;
};

/// Takes the inertia of point masses from the rods of a universal version, or their mass.
void SetRods(Rods like, Mechanism* mechanism) {
  for (Link& link : mechanism->links) {
    if (link.name.rfind("rod", 0) != 0) continue;
    if (like == Rods::kMassless) link.mass_properties.mass = 0;
    if (like != Rods::kThin) link.mass_properties.I_Lcm.setZero();
  }
}

Vector3d About(double angle, const Vector3d& p) {
  return Eigen::AngleAxisd(angle, Vector3d::UnitZ()) * p;
}

/// A delta robot with six rods in three parallelograms.
Mechanism Delta(Rods rods) {
  Drawing drawing({0, 0, -9.81});
  const Vector3d p_plat(0.03, -0.02, -0.776);
  const int platform = drawing.Body("platform", 1, p_plat, 0.001);
  for (int i = 0; i < 3; ++i) {
    const double turn = 2 * std::numbers::pi / 3 * i;
    const Vector3d hip = About(turn, {0.2, 0, 0}), elbow = About(turn, {0.482, 0, -0.1026});
    const std::string n = std::to_string(i);
    const int arm = drawing.Body("arm" + n, 0.5, 0.5 * (hip + elbow), 0.004);
    drawing.Connect("motor" + n, JointType::kRevolute, 0, arm,
                    Towards(hip, hip + About(turn, {0, 1, 0})));
    for (const double side : {0.04, -0.04}) {
      const Vector3d aside = About(turn, {0, side, 0});
      drawing.Rod("rod" + n + (side > 0 ? "l" : "r"), rods, 0.1, arm, elbow + aside, platform,
                  p_plat + About(turn, {0.05, 0, 0}) + aside);
    }
  }
  drawing.mechanism().grasps.push_back(
      {"hand", platform, {Matrix3d::Identity(), p_plat}, GraspKind::kPoint});
  return drawing.mechanism();
}

/// A platform on six legs, each two tubes that slide in each other.
Mechanism Hexapod(Rods rods) {
  Drawing drawing({0, 0.5, -9.81});
  const int platform = drawing.Body("platform", 3, {0.02, 0.01, 0.6}, 0.02);
  for (int i = 0; i < 6; ++i) {
    const double turn = std::numbers::pi / 3 * i;
    const double low = turn + (i % 2 ? 0.35 : -0.35), high = turn + (i % 2 ? -0.3 : 0.3);
    const Vector3d p = About(low, {0.5, 0, 0}), q = About(high, {0.25, 0, 0.6});
    const Posed X = Towards(p, q);
    const std::string n = std::to_string(i);
    const int lower = drawing.Body("rod_low" + n, 0.4, p + 0.2 * (q - p), 0);
    const int upper = drawing.Body("rod_high" + n, 0.2, p + 0.8 * (q - p), 0);
    drawing.Connect("hip" + n,
                    rods == Rods::kUniversal ? JointType::kUniversal : JointType::kSpherical, 0,
                    lower, X);
    drawing.Connect("leg" + n, JointType::kPrismatic, lower, upper, {X.R, 0.5 * (p + q)});
    drawing.Connect("ball" + n, JointType::kSpherical, upper, platform, {X.R, q});
    for (const int tube : {lower, upper}) {
      MassProperties& body = drawing.mechanism().links[tube].mass_properties;
      const Vector3d z = X.R.col(2);
      if (rods == Rods::kThin || rods == Rods::kUniversal) {
        body.I_Lcm = 0.004 * (Matrix3d::Identity() - z * z.transpose());
      }
      if (rods == Rods::kMassless) body.mass = 0;
    }
  }
  drawing.mechanism().grasps.push_back({"hand", platform, {Matrix3d::Identity(), {0, 0, 0.6}}});
  return drawing.mechanism();
}

/// A wheel carrier on two wishbones, its tie rod, and its strut as a rod to a bell crank.
Mechanism DoubleWishbone(Rods rods) {
  Drawing drawing({0, 0, -9.81});
  const Vector3d low_ball(0, 0.7, 0.2), high_ball(0.02, 0.62, 0.5);
  const int low = drawing.Body("low", 2, {0, 0.5, 0.2}, 0.02);
  const int high = drawing.Body("high", 1.5, {0, 0.45, 0.47}, 0.015);
  const int carrier = drawing.Body("carrier", 8, {0.01, 0.7, 0.36}, 0.1);
  const int bell = drawing.Body("bell", 0.6, {0.1, 0.3, 0.6}, 0.002);
  drawing.Connect("inner_low", JointType::kRevolute, 0, low,
                  Towards({0, 0.3, 0.2}, {1, 0.3, 0.25}));
  drawing.Connect("inner_high", JointType::kRevolute, 0, high,
                  Towards({0, 0.35, 0.45}, {1, 0.33, 0.43}));
  drawing.Connect("bell", JointType::kRevolute, 0, bell, Towards({0.1, 0.28, 0.6}, {1, 0.3, 0.6}));
  drawing.Connect("ball_low", JointType::kSpherical, low, carrier,
                  {Matrix3d::Identity(), low_ball});
  drawing.Connect("ball_high", JointType::kSpherical, high, carrier,
                  {Matrix3d::Identity(), high_ball});
  drawing.Rod("rod_tie", rods, 0.5, 0, {-0.12, 0.32, 0.25}, carrier, {-0.13, 0.68, 0.27});
  drawing.Rod("rod_push", rods, 0.4, low, {0.02, 0.6, 0.22}, bell, {0.1, 0.36, 0.62});
  drawing.mechanism().grasps.push_back(
      {"hub", carrier, {Matrix3d::Identity(), {0, 0.75, 0.35}}, GraspKind::kPoint});
  return drawing.mechanism();
}

Mechanism MakeRodMechanism(const std::string& name, Rods rods) {
  return name == "delta" ? Delta(rods) : name == "hexapod" ? Hexapod(rods) : DoubleWishbone(rods);
}

/// The drives at speed, or at rest.
LoadStudy Driven(const std::string& name, Mechanism mechanism, bool moving) {
  LoadStudy study;
  study.mechanism = std::move(mechanism);
  const std::vector<std::string> drives =
      name == "delta"     ? std::vector<std::string>{"motor0", "motor1", "motor2"}
      : name == "hexapod" ? std::vector<std::string>{"leg0", "leg1", "leg2", "leg3", "leg4", "leg5"}
                          : std::vector<std::string>{"inner_low"};
  double speed = moving ? (name == "hexapod" ? 0.05 : 0.6) : 0;
  for (const std::string& drive : drives) {
    study.drives.push_back(
        {FindJoint(study.mechanism, drive), 0, MotionLaw::Uniform(0, speed, 0.7 * speed)});
    speed *= -0.8;
  }
  for (int i = 0; i < 7; ++i) study.times.push_back(0.05 * i);
  return study;
}

struct RodCase {
  const char* name;
  Rods rods;
};
void PrintTo(const RodCase& c, std::ostream* out) {
  *out << c.name;
  PrintTo(c.rods, out);
}

class RodsOnBalls : public testing::TestWithParam<RodCase> {};

TEST_P(RodsOnBalls, CarryWhatRodsOnUniversalJointsCarry) {
  const auto& [name, rods] = GetParam();
  Mechanism universal = MakeRodMechanism(name, Rods::kUniversal);
  SetRods(rods, &universal);
  for (const bool moving : {false, true}) {
    const LoadStudyResult expected = RunLoadStudy(Driven(name, universal, moving));
    const LoadStudyResult result = RunLoadStudy(Driven(name, MakeRodMechanism(name, rods), moving));
    EXPECT_FALSE(result.idle.empty());
    EXPECT_LE(result.max_power_error, kAlike);
    for (size_t i = 0; i < result.poses.size(); ++i) {
      const PoseLoads &a = expected.poses[i], &b = result.poses[i];
      const LoadScale scale = ScaleOf(universal, a);
      for (size_t j = 0; j < a.joints.size(); ++j) {
        // Axes of a joint on a spinning rod differ; the size of the force does not.
        EXPECT_NEAR(a.joints[j].force.norm(), b.joints[j].force.norm(), kAlike * scale.force)
            << universal.joints[j].name << ", pose " << i << (moving ? ", moving" : ", at rest");
      }
      for (size_t k = 0; k < a.drives.size(); ++k) {
        EXPECT_NEAR(a.drives[k].force, b.drives[k].force, kAlike * scale.moment) << "pose " << i;
      }
    }
  }
}

TEST_P(RodsOnBalls, AreHeldByAHandAsThoseOnUniversalJoints) {
  const auto& [name, rods] = GetParam();
  const auto held = [&](Mechanism mechanism) {
    LoadStudy study;
    const Grasp grasp = mechanism.grasps[0];
    study.mechanism = std::move(mechanism);
    std::vector<Posed> poses;
    for (int i = 0; i < 6; ++i) {
      study.times.push_back(0.1 * i);
      poses.push_back(grasp.X_LG);
      poses.back().p += Vector3d(0.004 * i, -0.003 * i, 0.005 * i * i);
    }
    study.hand = HandDrive{0, HandLaw::Table(study.times, poses)};
    return RunLoadStudy(study);
  };
  Mechanism universal = MakeRodMechanism(name, Rods::kUniversal);
  SetRods(rods, &universal);
  const LoadStudyResult expected = held(universal), result = held(MakeRodMechanism(name, rods));
  for (size_t i = 0; i < result.poses.size(); ++i) {
    const Wrenchd &a = expected.poses[i].hand, &b = result.poses[i].hand;
    const double scale = std::max(ScaleOf(universal, expected.poses[i]).force, a.force.norm());
    EXPECT_LE((a.force - b.force).norm(), 1e-8 * scale) << "pose " << i;
  }
}

TEST_P(RodsOnBalls, StayQuietInAHand) {
  const auto& [name, rods] = GetParam();
  const AssembledMechanism assembled = RequireAssembled(MakeRodMechanism(name, rods));
  const KinematicTree tree = BuildKinematicTree(assembled.mechanism);
  const VectorXd q = StartCoordinates(tree);
  HandCoupling coupling;
  coupling.stiffness << 5000, 5000, 5000, 50, 50, 50;
  coupling.damping << 500, 500, 500, 5, 5, 5;
  CoupledDynamics dynamics(tree, GraspFrameOf(tree, 0), coupling, 1e-3, q);
  const Posed X_WH = dynamics.X_WG();
  for (int i = 0; i < 4000; ++i) {
    ASSERT_EQ(dynamics.Step(X_WH, Vector6d::Zero()), CoupledStatus::kMoved) << i;
  }
  EXPECT_LE(dynamics.v().cwiseAbs().maxCoeff(), 1e-3);  // it hangs still, spins and all
  HandDynamics measured(tree, GraspFrameOf(tree, 0), coupling.stiffness, q);
  ASSERT_TRUE(measured.Evaluate(Vector6d::Zero(), Vector6d::Zero()));
  EXPECT_NEAR(measured.w_d().z(), dynamics.w().z(), 0.02 * std::abs(measured.w_d().z()));
}

std::vector<RodCase> AllRods() {
  std::vector<RodCase> cases;
  for (const char* name : {"delta", "hexapod", "wishbone"}) {
    for (const Rods rods : {Rods::kMassless, Rods::kPointMass, Rods::kThin}) {
      cases.push_back({name, rods});
    }
  }
  return cases;
}
INSTANTIATE_TEST_SUITE_P(, RodsOnBalls, testing::ValuesIn(AllRods()),
                         testing::PrintToStringParamName());

// A crank, a rod with its mass in one point, a rocker. With the rod on a universal joint, and in
// the limit of isotropic inertias from 1e-2 to 1e-14 kg m^2, the drive needs 0.1418133 N m.
TEST(PointMassRod, NeedsTheDriveOfARodOnAUniversalJoint) {
  const std::string text = R"(vmech: "1.0"
units: {length: m, angle: deg}
gravity: [0, 0, -9.81]
ground: frame
links:
  frame: {anchors: {a: {origin: [0,0,0], z: [0,0,1], x: [1,0,0]},
      d: {origin: [1,0,0.2], z: [0,1,0], x: [1,0,0]}}}
  crank: {mass: 1, center_of_gravity: [0.1,0.05,0], inertia: {xx: 0.01, yy: 0.01, zz: 0.01},
      anchors: {a: {origin: [0,0,0], z: [0,0,1], x: [1,0,0]},
      b: {origin: [0.2,0.1,0], z: [0.8,-0.1,0.6], x: [0.1,0.8,0]}}}
  rod: {mass: 0.5, center_of_gravity: [0.6,0.05,0.3], inertia: {xx: 0, yy: 0, zz: 0},
      anchors: {b: {origin: [0.2,0.1,0], z: [0.8,-0.1,0.6], x: [0.1,0.8,0]},
      c: {origin: [1,0,0.6], z: [0.8,-0.1,0.6], x: [0.1,0.8,0]}}}
  rocker: {mass: 2, center_of_gravity: [1,0,0.5], inertia: {xx: 0.05, yy: 0.05, zz: 0.05},
      anchors: {c: {origin: [1,0,0.6], z: [0.8,-0.1,0.6], x: [0.1,0.8,0]},
      d: {origin: [1,0,0.2], z: [0,1,0], x: [1,0,0]}}}
joints:
  a: {type: revolute, connects: [frame/a, crank/a]}
  b: {type: spherical, connects: [crank/b, rod/b]}
  c: {type: spherical, connects: [rod/c, rocker/c]}
  d: {type: revolute, connects: [frame/d, rocker/d]}
)";
  LoadStudy study;
  study.mechanism = ParseMechanism(text, "point mass");
  study.drives = {{0, 0, MotionLaw::Uniform(0, 100 * std::numbers::pi / 180)}};
  study.times = {0, 0.25, 0.5, 0.75, 1};
  EXPECT_NEAR(RunLoadStudy(study).poses[0].drives[0].force, 0.1418133, 5e-8);
}

// By virtual work, three times the same by symmetry.
TEST(MasslessDelta, HoldsItsPlatform) {
  Drawing drawing({0, 0, -9.81});
  const double z = -0.7759972102912094, elbow_z = -0.10260604299770061;
  const int platform = drawing.Body("platform", 1, {0, 0, z}, 0.001);
  for (int i = 0; i < 3; ++i) {
    const double turn = 2 * std::numbers::pi / 3 * i;
    const Vector3d hip = About(turn, {0.2, 0, 0});
    const Vector3d elbow = About(turn, {0.4819077862357725, 0, elbow_z});
    const std::string n = std::to_string(i);
    const int arm = drawing.Body("arm" + n, 0.5, 0.5 * (hip + elbow), 0.004);
    drawing.Connect("m" + n, JointType::kRevolute, 0, arm,
                    Towards(hip, hip + About(turn, {0, 1, 0})));
    for (const double side : {0.04, -0.04}) {
      const Vector3d aside = About(turn, {0, side, 0});
      drawing.Rod("rod" + n + (side > 0 ? "l" : "r"), Rods::kMassless, 0, arm, elbow + aside,
                  platform, About(turn, {0.05, 0, z}) + aside);
    }
  }
  LoadStudy study;
  study.mechanism = drawing.mechanism();
  for (const char* motor : {"m0", "m1", "m2"}) {
    study.drives.push_back({FindJoint(study.mechanism, motor), 0, MotionLaw::Uniform(0, 0)});
  }
  study.times = {0, 0.5, 1};
  for (const PoseLoads& pose : RunLoadStudy(study).poses) {
    for (const DriveSample& drive : pose.drives) EXPECT_NEAR(drive.force, -1.828418, 5e-7);
  }
}

TEST(MasslessRod, RefusesALoadThatNothingResists) {
  LoadStudy study = Driven("wishbone", DoubleWishbone(Rods::kMassless), false);
  ExternalLoad load;
  load.link = FindLink(study.mechanism, "rod_tie");
  load.axes = ExternalLoad::Axes::kLink;
  load.at = {0};
  load.wrenches = {{Vector3d::Zero(), Vector3d(-0.01, 0.36, 0.02)}};  // about its own axis
  study.external = {load};
  EXPECT_THROW(RunLoadStudy(study), std::runtime_error);
}

}  // namespace
}  // namespace vmech
