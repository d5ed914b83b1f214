#include "vmech/hw_interface/arm/sarcos_arm.h"

#include <array>
#include <numbers>

#include "vmech/mechanisms/mass_properties.h"

namespace vmech {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kJoints = 7;

/// A joint and the link that it moves. The link's frame lies in the parent's at `p`, turned by
/// Rx Ry Rz, then by q about its z.
struct Row {
  const char* name;
  double p[3];        // [m]
  double turn[3];     // [rad]
  double lower;       // [rad]
  double upper;       // [rad]
  double torque;      // full scale [N m]
  double posture;     // [rad]
  double viscous;     // [N m s/rad]
  double mass;        // [kg]
  double moment[3];   // mass times centre of gravity [kg m]
  double inertia[6];  // xx xy xz yy yz zz about the joint [kg m^2]
};

// clang-format off
constexpr std::array<Row, kJoints> kRows{{
    {"R_SFE", {0.28284271247461906, 0, 0.28284271247461906}, {0, kPi / 4, 0},
     -0.44728, 1.370363, 99.62, 0, 0.3,
     0, {0, 0, 0}, {0, 0, 0, 0, 0, 0.000118}},
    {"R_SAA", {0, 0, 0}, {-kPi / 2, 0, kPi / 4},
     -1.288088, 0.18451, 99.62, -0.3, 0.3,
     0, {0, 0, 0}, {0.00212, -0.001411, 0.000405, 0.001061, -0.000297, 9.6e-05}},
    {"R_HR", {0, -0.0381, 0}, {0, kPi / 2, 0},
     -1.570548, 1.384645, 50.94, 0, 0.2,
     0.001015, {-6e-06, -2e-05, 1e-06},
     {0.000167, -6.1e-05, -0.001712, 0.000263, 0.001618, 0.031939}},
    {"R_EB", {0, 0, 0.287}, {kPi / 2, 0, -kPi / 2},
     0.586132, 2.208897, 50.94, 1.57, 0.2,
     0.184753, {0.004733, -0.02843, 0.031864},
     {0.009976, 0.000323, -0.000886, 0.007213, 0.005136, 0.004646}},
    {"R_WR", {0, 0, -0.0025}, {0, -kPi / 2, 0},
     -1.462808, 1.539668, 50.94, 0, 0.05,
     3.357057, {0.139895, 0.111372, 0.192788},
     {0.038183, -0.004881, 0.000878, 0.016913, -0.006484, 0.012918}},
    {"R_WFE", {0, 0, 0.2781}, {-kPi / 2, 0, 0},
     -0.766664, 0.876223, 22.64, 0, 0.03,
     1.339042, {0.068897, -0.033112, 0.036859},
     {0.001855, 0.001716, -0.001769, 0.004567, 0.001081, 0.014714}},
    {"R_WAA", {0, 0, 0.0081}, {0, kPi / 2, kPi},
     -0.6487, 0.762463, 22.64, 0, 0.03,
     0.895628, {-0.046017, 0.070786, 0.026518},
     {0.007859, 0.003288, -0.001617, 0.003268, -0.001317, 0.014124}},
}};
// clang-format on

/// Where the gripper's finger turns, in the hand's frame; here the operator holds the master.
const Vector3d kHandle(-0.03, 0.1, 0.02);

Posed FrameInParent(const Row& row) {
  const auto about = [](double angle, const Vector3d& axis) {
    return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
  };
  return {about(row.turn[0], Vector3d::UnitX()) * about(row.turn[1], Vector3d::UnitY()) *
              about(row.turn[2], Vector3d::UnitZ()),
          Vector3d(row.p[0], row.p[1], row.p[2])};
}

MassProperties LinkMass(const Row& row) {
  const double* I = row.inertia;
  const Matrix3d I_Lo = InertiaFromElements(I[0], I[3], I[5], I[1], I[2], I[4]);
  if (row.mass == 0) return {0, Vector3d::Zero(), I_Lo};
  const Vector3d c = Vector3d(row.moment[0], row.moment[1], row.moment[2]) / row.mass;
  return {row.mass, c, InertiaAboutCenterOfGravity(I_Lo, row.mass, c)};
}

Mechanism SarcosMechanism() {
  Mechanism arm;
  arm.name = "sarcos master arm";
  arm.gravity_W = Vector3d(0, 0, -9.81);
  arm.links.push_back({"base", {}, {{"out", FrameInParent(kRows[0])}}});
  for (int i = 0; i < kJoints; ++i) {
    const Row& row = kRows[i];
    Link link{row.name, LinkMass(row), {{"in", Posed{}}}};
    if (i + 1 < kJoints) link.anchors.push_back({"out", FrameInParent(kRows[i + 1])});
    arm.links.push_back(std::move(link));
    const int outward = i == 0 ? 0 : 1;
    Joint joint = MakeJoint(row.name, JointType::kRevolute, {i, outward}, {i + 1, 0});
    joint.start = {row.posture};
    joint.lower = {row.lower};
    joint.upper = {row.upper};
    joint.passive[0].viscous = row.viscous;
    arm.joints.push_back(std::move(joint));
  }
  return arm;
}

}  // namespace

ArmDescription SarcosMasterArm() {
  ArmDescription arm;
  arm.tree = BuildKinematicTree(SarcosMechanism());
  arm.handle_node = arm.tree.NodeOfLink(kJoints);
  arm.X_BH = arm.tree.X_node_link(kJoints) * Posed{Matrix3d::Identity(), kHandle};
  arm.torque_limit = VectorXd::Zero(kJoints);
  for (int i = 0; i < kJoints; ++i) arm.torque_limit[i] = kRows[i].torque;
  arm.posture = StartCoordinates(arm.tree);
  return arm;
}

}  // namespace vmech
