#include "simbody_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>

namespace vmech::peers {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kRounding = 1e-12;  // closed forms at forces of order one
constexpr double kReference = 1e-9;  // the reference table's two methods agree to 4e-10
constexpr double kTwoTrees = 1e-10;  // one linkage by two sets of equations, forces up to 100 N

Posed At(double x, double y, double z, const Matrix3d& R = Matrix3d::Identity()) {
  return {R, Vector3d(x, y, z)};
}

Matrix3d About(const Vector3d& axis, double angle) {
  return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
}

Matrix3d AboutZ(double angle) {
  return About(Vector3d::UnitZ(), angle);
}

Link MakeLink(std::string name, double mass, const Vector3d& com, const Vector3d& inertia,
              std::vector<Anchor> anchors) {
  return {std::move(name), {mass, com, inertia.asDiagonal()}, std::move(anchors)};
}

double Difference(const Wrenchd& a, const Wrenchd& b) {
  return (a.Stacked() - b.Stacked()).cwiseAbs().maxCoeff();
}

// A pendulum of mass 2 kg whose centre of gravity is 0.3 m from its pin; gravity along -y.
Mechanism Pendulum(bool swapped) {
  Mechanism m;
  m.gravity_W = {0, -9.81, 0};
  m.links = {MakeLink("ground", 0, Vector3d::Zero(), Vector3d::Zero(), {{"pin", At(0, 0, 0)}}),
             MakeLink("bob", 2, {0.3, 0, 0}, {0.01, 0.02, 0.03}, {{"pin", At(0, 0, 0)}})};
  m.joints = {swapped ? MakeJoint("pin", JointType::kRevolute, {1, 0}, {0, 0})
                      : MakeJoint("pin", JointType::kRevolute, {0, 0}, {1, 0})};
  return m;
}

// Force of the pin on the bob, in world axes, at angle 0.7, rate 3 and acceleration 5.
TEST(SimbodyModel, PendulumHasTheTextbookReaction) {
  const double angle = 0.7, rate = 3, acceleration = 5;
  const Vector3d e(std::cos(angle), std::sin(angle), 0), n(-e.y(), e.x(), 0);
  const Vector3d force = 2 * (0.3 * (acceleration * n - rate * rate * e) + Vector3d(0, 9.81, 0));
  const double torque = (0.03 + 2 * 0.09) * acceleration + 2 * 9.81 * 0.3 * e.x();
  const SimbodyQuery query{
      {{}, {At(0, 0, 0, AboutZ(angle)), Vector3d::Zero(), {0, 0, rate}}}, {acceleration}, {}};

  SimbodyModel model(Pendulum(false), {{0, 0}}, DriveMode::kAcceleration);
  const SimbodyAnswer answer = model.Evaluate(query);
  EXPECT_LT((answer.joints[0].force - force).norm(), kRounding);
  EXPECT_LT((answer.joints[0].moment - Vector3d(0, 0, torque)).norm(), kRounding);
  EXPECT_NEAR(answer.drive_forces[0], torque, kRounding);
  EXPECT_LT(answer.pose_error + answer.velocity_error, kRounding);
}

TEST(SimbodyModel, SwappedConnectionTurnsTheWrenchRound) {
  const double angle = 0.7;
  SimbodyQuery query{{{}, {At(0, 0, 0, AboutZ(angle)), Vector3d::Zero(), {0, 0, 3}}}, {5}, {}};
  SimbodyModel forward(Pendulum(false), {{0, 0}}, DriveMode::kAcceleration);
  const SimbodyAnswer expected = forward.Evaluate(query);

  // The coordinate is now that of ground in the bob: it runs the other way.
  query.drives = {-5};
  SimbodyModel swapped(Pendulum(true), {{0, 0}}, DriveMode::kAcceleration);
  const SimbodyAnswer answer = swapped.Evaluate(query);
  EXPECT_LT(Difference(answer.joints[0], (-expected.joints[0]).In(AboutZ(angle))), kRounding);
  EXPECT_NEAR(answer.drive_forces[0], -expected.drive_forces[0], kRounding);
  EXPECT_LT((answer.accelerations[1].alpha_WL - Vector3d(0, 0, 5)).norm(), kRounding);
}

// Lengths, masses and inertias of RigidBodyDynamics.jl, example "3. Double4-bar linkage". Crank at
// 5 rad/s and 2 rad/s^2, gravity 9.81 m/s^2 along -y. The pin forces are those of a 9x9 free-body
// matrix and of Lagrange multipliers in maximal coordinates, which agree to 4e-10.
struct FourBarRow {
  double crank_deg, theta3, theta4, omega3, omega4;
  double f12[2], f23[2], f34[2], f14[2], torque;
};

constexpr FourBarRow kFourBar[] = {
    {0,
     0.5367501772287115,
     0.9581921787462746,
     -4.166666666666666,
     -4.166666666666664,
     {-162.74118077817067, -85.0172443671513},
     {-159.61618077817067, -90.17224436715131},
     {-130.44002665854424, -108.6373432544793},
     {113.24541106882441, 122.11116741997527},
     -43.13137218357565},
    {60,
     0.20376450403606317,
     1.1223506133514483,
     -0.19681996537227614,
     3.1327904031675233,
     {-20.405275796623474, -1.8462342763748714},
     {-18.626269445677366, -4.169904889548501},
     {-10.843668144940482, -6.765631515189141},
     {7.675226695806984, 12.584420564659176},
     8.36456003645812},
    {150,
     0.3278101518580275,
     2.1284743351615867,
     1.0060499361712136,
     2.5750991815538073,
     {19.763901617427084, 7.727073618691757},
     {17.182572230600712, 4.601079969637866},
     {8.46588406639425, -0.936904517549486},
     {-5.800362023478958, 7.758902409359163},
     -6.621432778315908},
    {240,
     0.8678104604035252,
     2.4427734659215097,
     2.0514514316706203,
     -0.5947602728025745,
     {16.161571461542056, 30.60927405380569},
     {14.382565110595944, 23.122944666979322},
     {8.334156665296334, 5.392689850391607},
     {-6.46635985774079, 4.033007181809625},
     0.5624722119350793},
};

Mechanism FourBar() {
  const auto bar = [](std::string name, double length, double mass, double com, double inertia) {
    return MakeLink(std::move(name), mass, {com, 0, 0}, {inertia, inertia, inertia},
                    {{"a", At(0, 0, 0)}, {"b", At(length, 0, 0)}});
  };
  Mechanism m;
  m.gravity_W = {0, -9.81, 0};
  m.links = {MakeLink("ground", 0, Vector3d::Zero(), Vector3d::Zero(),
                      {{"a", At(0, 0, 0)}, {"b", At(1.1, 0, 0)}}),
             bar("crank", 0.5, 0.5, 0.25, 0.333), bar("coupler", 1.2, 1.0, 0.60, 0.537),
             bar("rocker", 0.75, 0.75, 0.375, 0.4)};
  m.joints = {MakeJoint("crank", JointType::kRevolute, {0, 0}, {1, 0}),
              MakeJoint("pin", JointType::kRevolute, {1, 1}, {2, 0}),
              MakeJoint("tip", JointType::kRevolute, {2, 1}, {3, 1}),
              MakeJoint("rocker", JointType::kRevolute, {0, 1}, {3, 0})};
  return m;
}

std::vector<LinkMotion> FourBarMotion(const FourBarRow& row) {
  const double crank = row.crank_deg * kPi / 180, rate = 5;
  const Vector3d along(std::cos(crank), std::sin(crank), 0);
  return {{},
          {At(0, 0, 0, AboutZ(crank)), Vector3d::Zero(), {0, 0, rate}},
          {{AboutZ(row.theta3), 0.5 * along},
           0.5 * rate * Vector3d(-along.y(), along.x(), 0),
           {0, 0, row.omega3}},
          {At(1.1, 0, 0, AboutZ(row.theta4)), Vector3d::Zero(), {0, 0, row.omega4}}};
}

void ExpectPinForces(const FourBarRow& row, const SimbodyAnswer& answer) {
  const double* expected[] = {row.f12, row.f23, row.f34, row.f14};
  const double first_axes[] = {0, row.crank_deg * kPi / 180, row.theta3, 0};
  for (int j = 0; j < 4; ++j) {
    const Vector3d force = AboutZ(first_axes[j]) * answer.joints[j].force;
    const double size = std::hypot(expected[j][0], expected[j][1]);
    EXPECT_NEAR(force.x(), expected[j][0], kReference * size) << "joint " << j;
    EXPECT_NEAR(force.y(), expected[j][1], kReference * size) << "joint " << j;
  }
}

TEST(SimbodyModel, FourBarInSpaceHasTheReferencePinForces) {
  SimbodyModel model(FourBar(), {{0, 0}}, DriveMode::kAcceleration);
  ASSERT_FALSE(model.IsTreeJoint(3));
  for (const FourBarRow& row : kFourBar) {
    SCOPED_TRACE(row.crank_deg);
    const SimbodyAnswer answer = model.Evaluate({FourBarMotion(row), {2}, {}});
    ExpectPinForces(row, answer);
    EXPECT_NEAR(answer.drive_forces[0], row.torque, kReference * std::abs(row.torque));
  }
}

TEST(SimbodyModel, FourBarDrivenByItsTorqueHasTheReferenceAcceleration) {
  SimbodyModel model(FourBar(), {{0, 0}}, DriveMode::kForce);
  for (const FourBarRow& row : kFourBar) {
    SCOPED_TRACE(row.crank_deg);
    const SimbodyAnswer answer = model.Evaluate({FourBarMotion(row), {row.torque}, {}});
    ExpectPinForces(row, answer);
    EXPECT_NEAR(answer.accelerations[1].alpha_WL.z(), 2, 2 * kReference);
  }
}

TEST(SimbodyModel, DroppingRedundantEquationsKeepsThePinForces) {
  SimbodyModel model(FourBar(), {{0, 0}}, DriveMode::kAcceleration);
  EXPECT_EQ(model.DropRedundantEquations(FourBarMotion(kFourBar[1])), 2);
  for (const FourBarRow& row : kFourBar) {
    SCOPED_TRACE(row.crank_deg);
    ExpectPinForces(row, model.Evaluate({FourBarMotion(row), {2}, {}}));
  }
}

// Pose and velocity of M in F at the coordinates q and rates v; a spherical joint turns by the
// vector q and its rates are its angular velocity in F.
struct JointMotion {
  Posed X_FM;
  Vector3d v = Vector3d::Zero();
  Vector3d w = Vector3d::Zero();
};

JointMotion MotionOf(const Joint& joint, const Vector3d& q, const Vector3d& v) {
  const Vector3d x = Vector3d::UnitX(), z = Vector3d::UnitZ();
  switch (joint.type) {
    case JointType::kRevolute:
      return {{AboutZ(q[0]), Vector3d::Zero()}, Vector3d::Zero(), v[0] * z};
    case JointType::kPrismatic:
      return {At(0, 0, q[0]), v[0] * z, Vector3d::Zero()};
    case JointType::kCylindrical:
      return {At(0, 0, q[0], AboutZ(q[1])), v[0] * z, v[1] * z};
    case JointType::kScrew:
      return {At(0, 0, joint.pitch * q[0], AboutZ(q[0])), joint.pitch * v[0] * z, v[0] * z};
    case JointType::kUniversal: {
      const Matrix3d R = About(x, q[0]);
      return {{R * About(Vector3d::UnitY(), q[1]), Vector3d::Zero()},
              Vector3d::Zero(),
              v[0] * x + v[1] * R.col(1)};
    }
    case JointType::kSpherical:
      return {{About(q, q.norm()), Vector3d::Zero()}, Vector3d::Zero(), v};
    case JointType::kPlanar:
      return {At(q[0], q[1], 0, AboutZ(q[2])), {v[0], v[1], 0}, v[2] * z};
    case JointType::kWeld:
      break;
  }
  return {};
}

// A body held by joint 0 of the given type; three sliders and a ball follow it without holding it.
Mechanism Held(JointType type, bool swapped) {
  const Posed axes_x = At(0, 0, 0, AxesFromZX(Vector3d::UnitX(), Vector3d::UnitY()));
  const Posed axes_y = At(0, 0, 0, AxesFromZX(Vector3d::UnitY(), Vector3d::UnitX()));
  const Posed axes_z = At(0, 0, 0);
  const Vector3d I(0.02, 0.03, 0.04);
  Mechanism m;
  m.gravity_W = {1, -9.81, 2};
  m.links = {MakeLink("ground", 0, {0, 0, 0}, {0, 0, 0},
                      {{"hold", At(0.1, 0.2, 0.3, About({1, 2, 3}, 0.8))}, {"x", axes_x}}),
             MakeLink("body", 1.5, {0.1, 0.05, -0.08}, I,
                      {{"hold", At(-0.2, 0.1, 0.05, About({2, -1, 1}, 1.1))},
                       {"ball", At(0.3, -0.1, 0.2)}}),
             MakeLink("x", 0.4, {0.01, 0, 0}, I, {{"x", axes_x}, {"y", axes_y}}),
             MakeLink("y", 0.5, {0, 0.02, 0}, I, {{"y", axes_y}, {"z", axes_z}}),
             MakeLink("z", 0.6, {0, 0, 0.03}, I, {{"z", axes_z}, {"ball", axes_z}})};
  m.joints = {
      swapped ? MakeJoint("hold", type, {1, 0}, {0, 0}) : MakeJoint("hold", type, {0, 0}, {1, 0}),
      MakeJoint("x", JointType::kPrismatic, {0, 1}, {2, 0}),
      MakeJoint("y", JointType::kPrismatic, {3, 0}, {2, 1}),
      MakeJoint("z", JointType::kPrismatic, {3, 1}, {4, 0}),
      MakeJoint("ball", JointType::kSpherical, {4, 1}, {1, 1})};
  m.joints[0].pitch = 0.04;
  return m;
}

std::vector<LinkMotion> HeldMotion(const Mechanism& m, const Vector3d& q, const Vector3d& v) {
  const Joint& hold = m.joints[0];
  const JointMotion motion = MotionOf(hold, q, v);
  const Posed& X_GA = m.links[0].anchors[0].X_LA;
  const Posed& X_BA = m.links[1].anchors[0].X_LA;
  const bool swapped = hold.first.link == 1;
  const double sign = swapped ? -1 : 1;
  const Posed X_WB = X_GA * (swapped ? motion.X_FM.inverse() : motion.X_FM) * X_BA.inverse();
  const Posed X_WF = swapped ? X_WB * X_BA : X_GA;
  const Posed X_WM = swapped ? X_GA : X_WB * X_BA;
  LinkMotion body{X_WB, Vector3d::Zero(), sign * (X_WF.R * motion.w)};
  body.v_WLo = sign * (X_WF.R * motion.v) + body.w_WL.cross(X_WB.p - X_WM.p);
  const Vector3d p = X_WB * m.links[1].anchors[1].X_LA.p;
  const Vector3d v_p = body.v_WLo + body.w_WL.cross(p - X_WB.p);
  return {{},
          body,
          {At(p.x(), 0, 0), {v_p.x(), 0, 0}},
          {At(p.x(), p.y(), 0), {v_p.x(), v_p.y(), 0}},
          {At(p.x(), p.y(), p.z()), v_p}};
}

std::vector<JointFreedom> FreedomsOfHold(const Mechanism& m) {
  std::vector<JointFreedom> freedoms(FreedomsOf(m.joints[0].type));
  for (size_t i = 0; i < freedoms.size(); ++i) freedoms[i] = {0, static_cast<int>(i)};
  return freedoms;
}

const Vector3d kCoordinates(0.4, 0.3, -0.2);
const Vector3d kRates(1.1, -0.7, 0.9);
constexpr JointType kAllTypes[] = {
    JointType::kRevolute,  JointType::kPrismatic, JointType::kCylindrical, JointType::kScrew,
    JointType::kUniversal, JointType::kSpherical, JointType::kPlanar,      JointType::kWeld};

TEST(SimbodyModel, LoopJointCarriesWhatTreeJointCarries) {
  for (bool swapped : {false, true}) {
    for (JointType type : kAllTypes) {
      if (type == JointType::kScrew) continue;  // always in the tree
      SCOPED_TRACE(std::string(NameOf(type)) + (swapped ? ", swapped" : ""));
      const Mechanism m = Held(type, swapped);
      SimbodyQuery query{HeldMotion(m, kCoordinates, kRates), {0, 0, 0, 0}, {}};
      query.external_W.resize(m.links.size());
      query.external_W[1] = {{3, -2, 5}, {0.4, 0.2, -0.6}};
      SimbodyModel cut_hold(m, {{1, 0}, {2, 0}, {3, 0}, {4, 0}}, DriveMode::kForce);
      ASSERT_FALSE(cut_hold.IsTreeJoint(0));
      const SimbodyAnswer by_loop = cut_hold.Evaluate(query);
      query.drives.assign(FreedomsOf(type), 0.0);
      SimbodyModel keep_hold(m, FreedomsOfHold(m), DriveMode::kForce);
      ASSERT_TRUE(keep_hold.IsTreeJoint(0));
      const SimbodyAnswer by_tree = keep_hold.Evaluate(query);

      EXPECT_LT(by_loop.pose_error + by_loop.velocity_error, kRounding);
      EXPECT_LT(by_tree.pose_error + by_tree.velocity_error, kRounding);
      for (size_t j = 0; j < m.joints.size(); ++j) {
        EXPECT_LT(Difference(by_loop.joints[j], by_tree.joints[j]), kTwoTrees) << "joint " << j;
      }
    }
  }
}

// From rest, accelerating the coordinates moves the body as rates would, and what the drive exerts
// is what the joint's wrench does along the freedom.
TEST(SimbodyModel, DriveActsAlongTheCoordinatesOfTheJoint) {
  for (bool swapped : {false, true}) {
    for (JointType type : kAllTypes) {
      SCOPED_TRACE(std::string(NameOf(type)) + (swapped ? ", swapped" : ""));
      const Mechanism m = Held(type, swapped);
      const std::vector<double> accelerations(kRates.data(), kRates.data() + FreedomsOf(type));
      SimbodyModel model(m, FreedomsOfHold(m), DriveMode::kAcceleration);
      const SimbodyAnswer answer =
          model.Evaluate({HeldMotion(m, kCoordinates, Vector3d::Zero()), accelerations, {}});
      const LinkMotion body = HeldMotion(m, kCoordinates, kRates)[1];
      EXPECT_LT((answer.accelerations[1].a_WLo - body.v_WLo).norm(), kRounding);
      EXPECT_LT((answer.accelerations[1].alpha_WL - body.w_WL).norm(), kRounding);
      for (int i = 0; i < FreedomsOf(type); ++i) {
        const JointMotion unit = MotionOf(m.joints[0], kCoordinates, Vector3d::Unit(i));
        const Wrenchd& w = answer.joints[0];
        EXPECT_NEAR(answer.drive_forces[i], w.force.dot(unit.v) + w.moment.dot(unit.w), kTwoTrees);
      }
    }
  }
}

TEST(SimbodyModel, DrivenJointsThatCloseALoopAreRefused) {
  EXPECT_THROW(SimbodyModel(FourBar(), {{0, 0}, {1, 0}, {2, 0}, {3, 0}}, DriveMode::kForce),
               std::invalid_argument);
}

TEST(SimbodyModel, AcceleratingSomeFreedomsOfAJointIsRefused) {
  const Mechanism m = Held(JointType::kUniversal, false);
  EXPECT_THROW(SimbodyModel(m, {{0, 1}}, DriveMode::kAcceleration), std::invalid_argument);
}

}  // namespace
}  // namespace vmech::peers
