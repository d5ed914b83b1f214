#include "vmech/mechanisms/exchange/sdf/sdf.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <ostream>
#include <stdexcept>

#include "support/examples.h"
#include "support/temp_folder.h"
#include "vmech/mechanisms/exchange/start_pose.h"
#include "vmech/mechanisms/files/document.h"
#include "vmech/mechanisms/mass_properties.h"

namespace vmech::sdf_test {
namespace {

constexpr double kSixteenDigits = 1e-14;  // poses of order one as decimals and quaternions

ImportedMechanism ReadText(const std::string& text, const ImportOptions& options = {}) {
  const TempFolder folder;
  std::ofstream(folder / "file.sdf") << text;
  return ReadSdf(folder / "file.sdf", options);
}

class SdfOfExample : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    if (!HasSdfReader()) GTEST_SKIP() << "vmech was built without libsdformat";
  }
};

TEST_P(SdfOfExample, KeepsGraphAndMasses) {
  const Mechanism before = WithoutCompositeJoints(Example(GetParam()));
  const Mechanism after = ReadText(WriteSdf(Example(GetParam())).text).mechanism;
  ASSERT_EQ(after.links.size(), before.links.size());
  ASSERT_EQ(after.joints.size(), before.joints.size());
  EXPECT_EQ(after.ground, before.ground);
  EXPECT_TRUE(after.gravity_W.isApprox(before.gravity_W, kSixteenDigits));
  for (size_t i = 0; i < before.links.size(); ++i) {
    const MassProperties &a = before.links[i].mass_properties, &b = after.links[i].mass_properties;
    EXPECT_EQ(after.links[i].name, before.links[i].name);
    EXPECT_EQ(b.mass, a.mass);
    EXPECT_LE((b.p_LoLcm - a.p_LoLcm).norm(), kSixteenDigits);
    EXPECT_LE((b.I_Lcm - a.I_Lcm).norm(), kSixteenDigits * (1 + a.I_Lcm.norm()));
  }
  for (size_t j = 0; j < before.joints.size(); ++j) {
    EXPECT_EQ(after.joints[j].type, before.joints[j].type);
    EXPECT_EQ(after.joints[j].first.link, before.joints[j].first.link);
    EXPECT_EQ(after.joints[j].second.link, before.joints[j].second.link);
    EXPECT_NEAR(after.joints[j].pitch, before.joints[j].pitch, kSixteenDigits);
  }
  EXPECT_EQ(after.grasps.size(), before.grasps.size());
}

TEST_P(SdfOfExample, HasTheJointsWhereTheyAreAtTheStart) {
  const Mechanism before = WithoutCompositeJoints(Example(GetParam()));
  const Mechanism after = ReadText(WriteSdf(Example(GetParam())).text).mechanism;
  const auto poses = LinkStartPoses(before, FindSpanningTree(before));
  const auto poses_after = LinkStartPoses(after, FindSpanningTree(after));
  for (size_t j = 0; j < before.joints.size(); ++j) {
    const AnchorId M = before.joints[j].second, M_after = after.joints[j].second;
    const Vector3d centre = poses[M.link] * before.anchor(M).X_LA.p;
    const Posed X_WM = poses_after[M_after.link] * after.anchor(M_after).X_LA;
    EXPECT_LT((X_WM.p - centre).norm(), kSixteenDigits) << before.joints[j].name;
    if (before.joints[j].type == JointType::kUniversal) continue;  // its z is made anew
    const Vector3d z = poses[M.link].R * before.anchor(M).X_LA.R.col(2);
    EXPECT_LT((X_WM.R.col(2) - z).norm(), kSixteenDigits) << before.joints[j].name;
  }
}

INSTANTIATE_TEST_SUITE_P(All, SdfOfExample, testing::ValuesIn(ExampleNames()),
                         [](const auto& info) { return TestName(info.param); });

/// One link on one joint with whatever is inside.
std::string Model(const std::string& joint, const std::string& more = "") {
  return "<sdf version='1.9'><model name='m'><link name='base'/><link name='arm'><pose>1 0 0 0 0 "
         "0</pose></link><joint name='b' type='fixed'><parent>world</parent><child>base</child>"
         "</joint>" +
         joint + more + "</model></sdf>";
}

class Sdf : public testing::Test {
 protected:
  void SetUp() override {
    if (!HasSdfReader()) GTEST_SKIP() << "vmech was built without libsdformat";
  }
};

TEST_F(Sdf, ResolvesPosesAndAxesThroughFrames) {
  const Mechanism mechanism =
      ReadText(Model("<frame name='f' attached_to='base'><pose>0 2 0 0 0 1.5707963267948966</pose>"
                     "</frame><joint name='j' type='prismatic'><pose relative_to='f'>0.5 0 0 0 0 0"
                     "</pose><parent>base</parent><child>arm</child><axis><xyz expressed_in='f'>1 "
                     "0 0</xyz></axis></joint>"))
          .mechanism;
  const Posed& X_LF = mechanism.anchor(mechanism.joints[0].first).X_LA;
  EXPECT_LT((X_LF.p - Vector3d(0, 2.5, 0)).norm(), kSixteenDigits);
  EXPECT_LT((X_LF.R.col(2) - Vector3d::UnitY()).norm(), kSixteenDigits);
  const Posed& X_LM = mechanism.anchor(mechanism.joints[0].second).X_LA;
  EXPECT_LT((X_LM.p - Vector3d(-1, 2.5, 0)).norm(), kSixteenDigits);
}

TEST_F(Sdf, TurnsTheInertiaWithThePoseOfTheInertial) {
  const std::string inertial =
      "<link name='tip'><inertial><pose>0.1 0.2 0.3 0 0 1.5707963267948966</pose><mass>2</mass>"
      "<inertia><ixx>1</ixx><iyy>2</iyy><izz>2.5</izz></inertia></inertial></link>"
      "<joint name='j' type='revolute'><parent>arm</parent><child>tip</child><axis><xyz>0 0 1"
      "</xyz></axis></joint><joint name='k' type='fixed'><parent>base</parent><child>arm</child>"
      "</joint>";
  const Mechanism mechanism = ReadText(Model("", inertial)).mechanism;
  const MassProperties& tip = mechanism.links[2].mass_properties;
  EXPECT_EQ(tip.mass, 2);
  EXPECT_LT((tip.p_LoLcm - Vector3d(0.1, 0.2, 0.3)).norm(), kSixteenDigits);
  EXPECT_LT((tip.I_Lcm - Matrix3d(Vector3d(2, 1, 2.5).asDiagonal())).norm(), kSixteenDigits);
}

TEST_F(Sdf, ReadsLimitsAndDynamics) {
  const Joint joint =
      ReadText(Model("<joint name='j' type='revolute'><parent>base</parent><child>arm</child><axis>"
                     "<xyz>0 0 1</xyz><limit><lower>-1</lower></limit><dynamics><damping>0.1"
                     "</damping><friction>0.2</friction><spring_reference>0.3</spring_reference>"
                     "<spring_stiffness>4</spring_stiffness></dynamics></axis></joint>"))
          .mechanism.joints[0];
  EXPECT_EQ(joint.lower[0], -1);
  EXPECT_TRUE(std::isinf(joint.upper[0]));
  EXPECT_EQ(joint.passive[0].viscous, 0.1);
  EXPECT_EQ(joint.passive[0].coulomb, 0.2);
  EXPECT_EQ(joint.passive[0].rest, 0.3);
  EXPECT_EQ(joint.passive[0].stiffness, 4);
}

TEST_F(Sdf, CountsLimitsAndSpringsFromTheStart) {
  Mechanism mechanism = Example("crank");
  Joint& joint = mechanism.joints[0];
  joint.start = {0.5};
  joint.lower = {-1};
  joint.upper = {2};
  joint.passive[0] = {3, 0.75, 0.1, 0.2};
  const Joint after = ReadText(WriteSdf(mechanism).text).mechanism.joints[0];
  EXPECT_EQ(after.start[0], 0);
  EXPECT_EQ(after.lower[0], -1.5);
  EXPECT_EQ(after.upper[0], 1.5);
  EXPECT_EQ(after.passive[0].rest, 0.25);
}

TEST_F(Sdf, TakesCompositeJointsApart) {
  Mechanism mechanism = Example("crank");
  const AnchorId F = mechanism.joints[0].first, M = mechanism.joints[0].second;
  mechanism.joints = {MakeJoint("table", JointType::kPlanar, F, M)};
  mechanism.joints[0].start = {0.1, 0.2, 0.3};
  const ExportedText exported = WriteSdf(mechanism);
  const Mechanism after = ReadText(exported.text).mechanism;
  ASSERT_EQ(after.joints.size(), 3u);
  EXPECT_EQ(after.joints[0].type, JointType::kPrismatic);
  EXPECT_EQ(after.joints[1].type, JointType::kPrismatic);
  EXPECT_EQ(after.joints[2].name, "table_rz");
  EXPECT_EQ(after.links.size(), mechanism.links.size() + 2);
  EXPECT_NE(exported.notes[0].find("planar, which SDF has not"), std::string::npos);
  const auto poses = LinkStartPoses(mechanism, FindSpanningTree(mechanism));
  const auto poses_after = LinkStartPoses(after, FindSpanningTree(after));
  EXPECT_LT((poses[1].R - poses_after[1].R).norm(), kSixteenDigits);
  EXPECT_LT((poses[1].p - poses_after[1].p).norm(), kSixteenDigits);
}

TEST_F(Sdf, KeepsScrewsRightHanded) {
  Mechanism mechanism = Example("crank");
  mechanism.joints[0].type = JointType::kScrew;
  mechanism.joints[0].pitch = 1e-3;
  const std::string text = WriteSdf(mechanism).text;
  EXPECT_NE(text.find("<thread_pitch>-1000</thread_pitch>"), text.npos);
  EXPECT_EQ(ReadText(text).mechanism.joints[0].pitch, 1e-3);
}

TEST_F(Sdf, TakesGravityIntoTheAxesOfATurnedGround) {
  const std::string text =
      "<sdf version='1.9'><world name='w'><gravity>0 0 -10</gravity><model name='m'><pose>0 0 0 "
      "1.5707963267948966 0 0</pose><link name='base'/><joint name='b' type='fixed'><parent>world"
      "</parent><child>base</child></joint><link name='arm'/><joint name='j' type='ball'><parent>"
      "base</parent><child>arm</child></joint></model></world></sdf>";
  const Mechanism mechanism = ReadText(text).mechanism;
  EXPECT_LT((mechanism.gravity_W - Vector3d(0, -10, 0)).norm(), 1e-13);
  EXPECT_EQ(mechanism.joints[0].type, JointType::kSpherical);
}

TEST_F(Sdf, SaysWhatItGuessed) {
  const ImportedMechanism imported = ReadText(
      "<sdf version='1.9'><model name='m'><link name='a'/><link name='b'/><joint name='j' "
      "type='continuous'><parent>a</parent><child>b</child><axis><xyz>0 0 1</xyz></axis></joint>"
      "</model></sdf>");
  std::string notes;
  for (const std::string& note : imported.notes) notes += note + "\n";
  for (const char* part :
       {"taken for the ground is 'a'", "9.81 m/s^2 along -z", "link 'b' has no inertial: 1 kg"}) {
    EXPECT_NE(notes.find(part), notes.npos) << notes;
  }
}

TEST_F(Sdf, TakesTheGroundThatIsAskedFor) {
  const std::string text = Model(
      "<joint name='j' type='ball'><parent>base</parent><child>arm"
      "</child></joint>");
  ImportOptions options;
  options.ground = "arm";
  const Mechanism mechanism = ReadText(text, options).mechanism;
  EXPECT_EQ(mechanism.links[mechanism.ground].name, "arm");
  options.ground = "amr";
  EXPECT_THROW(ReadText(text, options), FileErrors);
}

TEST(SdfWriter, RefusesNamesThatSdfKeepsForItself) {
  Mechanism mechanism = Example("crank");
  mechanism.links[1].name = "world";
  EXPECT_THROW(WriteSdf(mechanism), std::invalid_argument);
  mechanism.links[1].name = "a::b";
  EXPECT_THROW(WriteSdf(mechanism), std::invalid_argument);
}

TEST(SdfWriter, EscapesNames) {
  Mechanism mechanism = Example("crank");
  mechanism.links[1].name = "<crank> & 'rod'";
  EXPECT_NE(WriteSdf(mechanism).text.find("\"&lt;crank&gt; &amp; 'rod'\""), std::string::npos);
  if (!HasSdfReader()) GTEST_SKIP() << "vmech was built without libsdformat";
  EXPECT_EQ(ReadText(WriteSdf(mechanism).text).mechanism.links[1].name, "<crank> & 'rod'");
}

TEST_F(Sdf, OfWhichTheEndIsMissingIsRefusedWhereverItEnds) {
  const std::string text = WriteSdf(Example("crank")).text;
  for (size_t length = 0; length + 8 < text.size(); length += 61) {
    EXPECT_THROW(ReadText(text.substr(0, length)), FileErrors) << length;
  }
}

struct Malformed {
  const char* subject;
  std::string text;
  const char* message;
};

void PrintTo(const Malformed& malformed, std::ostream* out) {
  *out << malformed.subject;
}

class MalformedSdf : public testing::TestWithParam<Malformed> {};

TEST_P(MalformedSdf, IsRefusedWithAMessage) {
  if (!HasSdfReader()) GTEST_SKIP() << "vmech was built without libsdformat";
  try {
    ReadText(GetParam().text);
    FAIL() << "accepted";
  } catch (const FileErrors& errors) {
    EXPECT_NE(std::string(errors.what()).find(GetParam().message), std::string::npos)
        << errors.what();
    EXPECT_NE(std::string(errors.what()).find("file.sdf"), std::string::npos) << errors.what();
  }
}

std::string JointOf(const std::string& type, const std::string& more = "") {
  return Model("<joint name='j' type='" + type + "'><parent>base</parent><child>arm</child>" +
               more + "</joint>");
}

INSTANTIATE_TEST_SUITE_P(
    All, MalformedSdf,
    testing::Values(
        Malformed{"Empty", "", ""}, Malformed{"NotXml", "vmech: \"1.0\"\n", "is not XML"},
        Malformed{"Truncated", Model("").substr(0, 120), ""},
        Malformed{"Binary",
                  std::string("\x7f"
                              "ELF\0\1\2\3",
                              8),
                  ""},
        Malformed{"NoModel", "<sdf version='1.9'><world name='w'/></sdf>", "no model"},
        Malformed{"TwoModels",
                  "<sdf version='1.9'><world name='w'><model name='a'><link name='l'/></model>"
                  "<model name='b'><link name='l'/></model></world></sdf>",
                  "several models"},
        Malformed{"UnknownLink",
                  Model("<joint name='j' type='ball'><parent>base</parent><child>nobody</child>"
                        "</joint>"),
                  "nobody"},
        Malformed{"DuplicateName", Model("", "<link name='arm'/>"), "arm"},
        Malformed{"PoseNotANumber", Model("", "<link name='x'><pose>nan 0 0 0 0 0</pose></link>"),
                  "pose"},
        Malformed{"IncludeOfNothing", Model("", "<include><uri>model://nobody</uri></include>"),
                  "model://nobody"},
        Malformed{"Gearbox", JointOf("gearbox", "<axis><xyz>0 0 1</xyz></axis>"), "gearbox"},
        Malformed{"UnknownJointType", JointOf("revolut"), "revolut"},
        Malformed{"ZeroAxis", JointOf("revolute", "<axis><xyz>0 0 0</xyz></axis>"), ""},
        Malformed{"NoAxis", JointOf("revolute"), "axis"},
        Malformed{"ScrewWithoutPitch",
                  JointOf("screw", "<thread_pitch>0</thread_pitch><axis><xyz>0 0 1</xyz></axis>"),
                  "thread_pitch"},
        Malformed{"ScrewWithoutAnyPitch", JointOf("screw", "<axis><xyz>0 0 1</xyz></axis>"),
                  "thread_pitch"},
        Malformed{
            "ScrewOfALaterVersion",
            JointOf("screw",
                    "<screw_thread_pitch>-0.5</screw_thread_pitch><axis><xyz>0 0 1</xyz></axis>"),
            "<thread_pitch>12.566370614359172</thread_pitch>"},
        Malformed{
            "ObliqueUniversal",
            JointOf("universal", "<axis><xyz>1 0 0</xyz></axis><axis2><xyz>1 1 0</xyz></axis2>"),
            "square"},
        Malformed{"NegativeMass",
                  Model("", "<link name='x'><inertial><mass>-1</mass></inertial></link>"), ""},
        Malformed{"LinkWithoutJoint",
                  Model("",
                        "<link name='x'><inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1"
                        "</iyy><izz>5</izz></inertia></inertial></link>"),
                  "file.sdf:1:1: links.x: no chain of joints"}),
    [](const auto& info) { return info.param.subject; });

}  // namespace
}  // namespace vmech::sdf_test
