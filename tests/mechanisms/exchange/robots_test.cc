// Robots in the manner of those that people publish, with all that other readers let pass.

#include <gtest/gtest.h>

#include <fstream>

#include "support/temp_folder.h"
#include "vmech/mechanisms/exchange/proposed_grasps.h"
#include "vmech/mechanisms/exchange/urdf/urdf.h"
#include "vmech/mechanisms/files/document.h"
#include "vmech/mechanisms/mass_properties.h"

namespace vmech::robots_test {
namespace {

constexpr double kRounding = 1e-15;

ImportedMechanism ReadText(const std::string& text, const ImportOptions& options = {}) {
  const TempFolder folder;
  std::ofstream(folder / "robot.urdf") << text;
  return ReadUrdf(folder / "robot.urdf", options);
}

/// The notes, a line each, with the file's name instead of its path.
std::string NotesOf(const ImportedMechanism& imported) {
  std::string notes;
  for (const std::string& note : imported.notes) {
    const size_t folder = note.find("(/"), name = note.find("robot.urdf:");
    const bool has_place = folder != note.npos && name != note.npos;
    notes += has_place ? note.substr(0, folder + 1) + note.substr(name) : note;
    notes += "\n";
  }
  return notes;
}

double TotalMass(const Mechanism& mechanism) {
  double mass = 0;
  for (const Link& link : mechanism.links) mass += link.mass_properties.mass;
  return mass;
}

const Joint& JointOf(const Mechanism& mechanism, const std::string& name) {
  return mechanism.joints.at(FindJoint(mechanism, name));
}

// An axis has a direction alone; the squares of these lengths vanish.
TEST(UrdfRobots, TurnAboutAxesOfAnyLength) {
  for (const std::string axis : {"3e-160 0 4e-160", "3e-200 0 4e-200", "3e20 0 4e20"}) {
    const Mechanism mechanism =
        ReadText(
            "<robot name='r'><link name='a'/><link name='b'><inertial><mass value='1'/>"
            "</inertial></link><joint name='j' type='continuous'><parent link='a'/>"
            "<child link='b'/><axis xyz='" +
            axis + "'/></joint></robot>")
            .mechanism;
    const Vector3d z = mechanism.anchor(JointOf(mechanism, "j").first).X_LA.R.col(2);
    EXPECT_NEAR((z - Vector3d(0.6, 0, 0.8)).norm(), 0, kRounding) << axis;
  }
}

/// A manipulator: a base without mass that has an inertia, a wrist whose inertia was rounded to
/// whole kg mm^2 and that must be bent, a gripper whose fingers follow each other, a tool frame, a
/// camera frame, a cable without mass, and what simulators add.
constexpr const char* kManipulator = R"(<?xml version="1.0"?>
<robot name="manipulator">
  <material name="grey"><color rgba="0.5 0.5 0.5 1"/></material>
  <link name="base_link">
    <inertial><mass value="0"/>
      <inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial>
    <visual><geometry><box size=".1 .1 .1"/></geometry></visual>
  </link>
  <link name="shoulder">
    <inertial><origin xyz="0 0 0.05" rpy="0 0 0"/><mass value="3.5"/>
      <inertia ixx="0.010" ixy="0" ixz="0" iyy="0.010" iyz="0" izz="0.015"/></inertial>
    <collision><geometry><box size=".1 .1 .1"/></geometry></collision>
  </link>
  <link name="wrist">
    <inertial><origin xyz="0 0 0.02" rpy="0 0 0"/><mass value="0.12"/>
      <inertia ixx="1e-06" ixy="0" ixz="0" iyy="2e-06" iyz="0" izz="5e-06"/></inertial>
  </link>
  <link name="finger_left"><inertial><mass value="0.01"/>
    <inertia ixx="1e-6" ixy="0" ixz="0" iyy="1e-6" iyz="0" izz="1e-6"/></inertial></link>
  <link name="finger_right"><inertial><mass value="0.01"/>
    <inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"/></inertial></link>
  <link name="tool0"/>
  <link name="camera_frame"/>
  <link name="cable"><inertial><mass value="0"/><origin rpy="0 0 0"/>
    <inertia ixx="1e-3" ixy="0" ixz="0" iyy="1e-3" iyz="0" izz="1e-3"/></inertial></link>
  <joint name="pan" type="continuous"><origin xyz="0 0 .1" rpy="0 0 0"/><parent link="base_link"/>
    <child link="shoulder"/><axis xyz="0 0 1"/>
    <limit effort="150" velocity="3.15" lower="-6.28" upper="6.28"/></joint>
  <joint name="bend" type="revolute"><origin xyz="0 0 .3"/><parent link="shoulder"/>
    <child link="wrist"/><axis xyz="0 1 0"/>
    <limit effort="10" velocity="1" lower="0.35" upper="2.4"/><safety_controller/></joint>
  <joint name="left" type="prismatic"><parent link="wrist"/><child link="finger_left"/>
    <axis xyz="0 1 0"/><limit effort="10" velocity="1" lower="0" upper="0.04"/></joint>
  <joint name="right" type="prismatic"><parent link="wrist"/><child link="finger_right"/>
    <axis xyz="0 -1 0"/><limit effort="10" velocity="1" lower="0" upper="0"/>
    <mimic joint="left" multiplier="1"/></joint>
  <joint name="tool" type="fixed"><origin xyz="0 0 .1"/><parent link="wrist"/>
    <child link="tool0"/></joint>
  <joint name="camera" type="fixed"><parent link="base_link"/><child link="camera_frame"/></joint>
  <joint name="cable_joint" type="fixed"><parent link="shoulder"/><child link="cable"/></joint>
  <transmission name="t"><type>transmission_interface/SimpleTransmission</type></transmission>
  <gazebo reference="wrist"><mu1>0.9</mu1></gazebo>
</robot>
)";

TEST(Robots, ComeInWithTheirMasses) {
  const Mechanism robot = ReadText(kManipulator).mechanism;
  EXPECT_EQ(robot.links.size(), 8u);
  EXPECT_EQ(robot.joints.size(), 7u);
  EXPECT_NEAR(TotalMass(robot), 3.5 + 0.12 + 0.01 + 0.01, kRounding);
  EXPECT_EQ(robot.links[robot.ground].name, "base_link");
  EXPECT_TRUE(std::isinf(JointOf(robot, "pan").upper[0]));
}

TEST(Robots, TellWhatWasMended) {
  EXPECT_EQ(
      NotesOf(ReadText(kManipulator)),
      "joint 'pan' is continuous: its limits, -6.28 and 6.28, are left out\n"
      "joint 'bend' may move from 0.35 to 2.4, which leaves out zero, where it is drawn: it starts "
      "at 0.35\n"
      "link 'finger_right' has a mass of 0.01 kg and no inertia: a point (robot.urdf:20)\n"
      "joint 'right' mimics 'left': it moves by itself here\n"
      "joint 'right': its limits are both 0 and would hold it; they are left out (robot.urdf:34)\n"
      "left out: 4 'effort' of <limit>, 4 'velocity' of <limit>, 1 <collision>, 1 <gazebo>, "
      "1 <material>, 1 <safety_controller>, 1 <transmission>, 1 <visual>\n"
      "URDF has no gravity: 9.81 m/s^2 along -z\n"
      "link 'base_link' is the ground: its inertia is dropped (robot.urdf:5)\n"
      "link 'wrist': the largest moment of inertia exceeds the sum of the two others: principal "
      "moments 1e-06, 2e-06, 5e-06 kg m^2 about the centre of gravity; mended by the least change "
      "to [2e-06, 3e-06, 5e-06] kg m^2 (robot.urdf:15)\n"
      "link 'cable': no mass, but principal moments of inertia [0.001, 0.001, 0.001] kg m^2; they "
      "are dropped (robot.urdf:24)\n");
}

TEST(Robots, AreRefusedByNameWhereNothingShallBeMended) {
  try {
    ReadText(kManipulator, {.ground = "", .gravity_W = {}, .model = "", .strict = true});
    FAIL() << "accepted";
  } catch (const FileErrors& errors) {
    const std::string what = errors.what();
    for (const char* part : {"robot.urdf:15:1: link 'wrist'", "robot.urdf:24:1: link 'cable'",
                             "robot.urdf:34:1: joint 'right'"}) {
      EXPECT_NE(what.find(part), what.npos) << what;
    }
    EXPECT_EQ(what.find("base_link"), what.npos) << what;
  }
}

TEST(Robots, StartWithinTheirRanges) {
  const Joint bend = JointOf(ReadText(kManipulator).mechanism, "bend");
  EXPECT_EQ(bend.start[0], 0.35);
  EXPECT_TRUE(bend.start_given);
}

TEST(Robots, AreHeldByTheFramesAtTheEndsOfTheirChains) {
  Mechanism robot = ReadText(kManipulator).mechanism;
  std::vector<std::string> names;
  for (const int link : LeafLinks(robot)) names.push_back(robot.links[link].name);
  EXPECT_EQ(names, (std::vector<std::string>{"finger_left", "finger_right", "tool0", "cable"}));
  AddGraspAt(FindLink(robot, "tool0"), &robot);
  AddGraspAt(FindLink(robot, "tool0"), &robot);
  EXPECT_EQ(robot.grasps[0].name, "tool0");
  EXPECT_EQ(robot.grasps[1].name, "tool0_2");
}

std::string Body(const std::string& name) {
  return "<link name='" + name +
         "'><inertial><mass value='2'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/>"
         "</inertial></link>";
}

TEST(Robots, WithMoreThatIsLeftOutThanCanBeReadAreSummedUp) {
  std::string parts;
  for (int i = 10; i < 99; ++i) parts += "<kind" + std::to_string(i) + "/>";
  const std::string notes = NotesOf(ReadText("<robot name='r'>" + Body("b") + parts + "</robot>"));
  EXPECT_NE(notes.find("1 <kind29>, 69 more kinds"), notes.npos) << notes;
}

/// A vehicle that floats in the world, on which a platform slides.
const std::string kVehicle =
    "<robot name='vehicle'><link name='world'/>" + Body("hull") + Body("platform") +
    "<joint name='free' type='floating'><parent link='world'/><child link='hull'/>"
    "<origin xyz='0 0 1'/></joint>"
    "<joint name='table' type='planar'><parent link='hull'/><child link='platform'/>"
    "<axis xyz='1 0 0'/><limit lower='-1' upper='1' effort='1' velocity='1'/></joint></robot>";

TEST(Robots, ThatFloatAreHeldWhereTheyAreDrawn) {
  const ImportedMechanism imported = ReadText(kVehicle);
  EXPECT_EQ(JointOf(imported.mechanism, "free").type, JointType::kWeld);
  EXPECT_EQ(TotalMass(imported.mechanism), 4);
  EXPECT_NE(NotesOf(imported).find("joint 'free' floats, and nothing that holds it is told; link "
                                   "'hull' is welded to 'world' where it is drawn"),
            std::string::npos);
  EXPECT_THROW(ReadText(kVehicle, {.ground = "", .gravity_W = {}, .model = "", .strict = true}),
               FileErrors);
}

TEST(Robots, SlideOnThePlaneAcrossTheAxis) {
  const ImportedMechanism imported = ReadText(kVehicle);
  const Joint& table = JointOf(imported.mechanism, "table");
  EXPECT_EQ(table.type, JointType::kPlanar);
  const Matrix3d& R = imported.mechanism.anchor(table.first).X_LA.R;
  EXPECT_LT((R.col(2) - Vector3d::UnitX()).norm(), kRounding);
  EXPECT_NE(NotesOf(imported).find("joint 'table' is planar: its limits"), std::string::npos);
}

/// The same bar about its centre of gravity, drawn in frames that are ever farther away.
TEST(Robots, GetOneVerdictOnAnInertiaWhereverTheFrameIs) {
  for (const char* x : {"0", "0.5", "1", "1000"}) {
    const std::string text =
        std::string(
            "<robot name='lever'><link name='stand'/><link name='bar'><inertial><origin "
            "xyz='") +
        x +
        " 0 0'/><mass value='2'/><inertia ixx='0.001' iyy='0.002' izz='0.0035' ixy='0' ixz='0' "
        "iyz='0'/></inertial></link><joint name='pivot' type='continuous'><parent link='stand'/>"
        "<child link='bar'/><axis xyz='0 1 0'/></joint></robot>";
    const Mechanism lever = ReadText(text).mechanism;
    const Matrix3d& I = lever.links[FindLink(lever, "bar")].mass_properties.I_Lcm;
    EXPECT_LT((I - Matrix3d(Vector3d(0.00125, 0.00225, 0.0035).asDiagonal())).norm(), kRounding);
    EXPECT_THROW(ReadText(text, {.ground = "", .gravity_W = {}, .model = "", .strict = true}),
                 FileErrors);
  }
}

TEST(Robots, AreTurnedByQuaternionsToo) {
  const std::string text =
      "<robot name='r'><link name='a'/>" + Body("b") +
      "<joint name='j' type='fixed'><parent link='a'/><child link='b'/><origin "
      "xyz='1 2 3' quat_xyzw='0 0 1 1'/></joint></robot>";
  const Mechanism robot = ReadText(text).mechanism;
  const Posed& X = robot.anchor(robot.joints[0].first).X_LA;
  EXPECT_LT((X.R.col(0) - Vector3d::UnitY()).norm(), kRounding);
  EXPECT_EQ(X.p, Vector3d(1, 2, 3));
}

/// Fixed axes: about x, then y, then z. Roll 90, pitch 90: x goes to -z, y to x.
TEST(Robots, TurnByRollPitchAndYawAboutFixedAxes) {
  const std::string text =
      "<robot name='r'><link name='a'/>" + Body("b") +
      "<joint name='j' type='fixed'><parent link='a'/><child link='b'/><origin "
      "rpy='1.5707963267948966 1.5707963267948966 0'/></joint></robot>";
  const Mechanism robot = ReadText(text).mechanism;
  const Matrix3d& R = robot.anchor(robot.joints[0].first).X_LA.R;
  EXPECT_LT((R.col(0) + Vector3d::UnitZ()).norm(), kRounding);
  EXPECT_LT((R.col(1) - Vector3d::UnitX()).norm(), kRounding);
}

}  // namespace
}  // namespace vmech::robots_test
