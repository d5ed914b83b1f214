// SDFormat files that hold more than one model: includes, worlds of several, joints between them.

#include <gtest/gtest.h>
#include <stdlib.h>

#include <fstream>

#include "support/temp_folder.h"
#include "vmech/mechanisms/exchange/sdf/sdf.h"
#include "vmech/mechanisms/exchange/start_pose.h"
#include "vmech/mechanisms/files/document.h"

namespace vmech::sdf_files_test {
namespace {

constexpr double kRounding = 1e-14;

std::string Inertial(const std::string& mass, const std::string& izz = "1") {
  return "<inertial><mass>" + mass + "</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>" + izz +
         "</izz></inertia></inertial>";
}

/// A model with a foot and an arm on it.
std::string Arm(const std::string& name, const std::string& mass = "3",
                const std::string& izz = "1") {
  return "<model name='" + name + "'><link name='foot'>" + Inertial("1") +
         "</link>\n<link name='arm'><pose>0 0 1 0 0 0</pose>\n" + Inertial(mass, izz) +
         "</link><joint name='j' type='revolute'><parent>foot</parent><child>arm</child><axis><xyz>"
         "0 0 1</xyz></axis></joint></model>";
}

std::string Sdf(const std::string& content) {
  return "<sdf version='1.9'>" + content + "</sdf>";
}

std::string World(const std::string& content) {
  return Sdf("<world name='w'>\n<gravity>0 0 -3</gravity>\n" + content + "</world>");
}

std::string NotesOf(const ImportedMechanism& imported) {
  std::string notes;
  for (const std::string& note : imported.notes) notes += note + "\n";
  return notes;
}

class SdfFiles : public testing::Test {
 protected:
  void SetUp() override {
    if (!HasSdfReader()) GTEST_SKIP() << "vmech was built without libsdformat";
  }
  void TearDown() override {
    for (const char* variable : kVariables) unsetenv(variable);
  }

  void Write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name) << text;
  }

  ImportedMechanism Read(const std::string& text, const ImportOptions& options = {}) const {
    Write("here/world.sdf", text);
    return ReadSdf(folder_ / "here/world.sdf", options);
  }

  std::string Refusal(const std::string& text, const ImportOptions& options = {}) const {
    try {
      Read(text, options);
    } catch (const FileErrors& errors) {
      return errors.what();
    }
    return "accepted";
  }

  static constexpr const char* kVariables[] = {"SDF_PATH", "GZ_SIM_RESOURCE_PATH",
                                               "IGN_GAZEBO_RESOURCE_PATH", "GAZEBO_MODEL_PATH"};
  const TempFolder folder_;
};

std::string Include(const std::string& uri) {
  return World("<include><uri>" + uri + "</uri></include>");
}

double MassOfArm(const ImportedMechanism& imported) {
  const int arm = FindLink(imported.mechanism, "arm");
  return arm < 0 ? -1 : imported.mechanism.links[arm].mass_properties.mass;
}

TEST_F(SdfFiles, AreFoundBesideTheFileThatIncludesThem) {
  Write("here/robot/model.sdf", Sdf(Arm("robot")));
  for (const char* uri : {"model://robot", "robot", " robot\n", "file://robot/model.sdf",
                          "robot/model.sdf", "../here/robot"}) {
    EXPECT_EQ(MassOfArm(Read(Include(uri))), 3) << uri;
  }
  EXPECT_EQ(MassOfArm(Read(Include((folder_ / "here/robot").string()))), 3);
  EXPECT_EQ(MassOfArm(Read(Include("file://" + (folder_ / "here/robot").string()))), 3);
}

TEST_F(SdfFiles, AreFoundThroughTheirModelConfig) {
  Write("here/robot/model.config",
        "<?xml version='1.0'?><model><name>robot</name><sdf version='1.5'>old.sdf</sdf>"
        "<sdf version='1.9'>\n new.sdf </sdf></model>");
  Write("here/robot/old.sdf", Sdf(Arm("robot", "1")));
  Write("here/robot/new.sdf", Sdf(Arm("robot", "7")));
  EXPECT_EQ(MassOfArm(Read(Include("model://robot"))), 7);
}

TEST_F(SdfFiles, AreFoundAlongTheUsualVariables) {
  for (const char* variable : kVariables) {
    const std::string name = std::string("robot_") + variable;
    Write("far/" + name + "/model.sdf", Sdf(Arm("robot")));
    EXPECT_NE(Refusal(Include("model://" + name)).find("is not found"), std::string::npos);
    setenv(variable, ("/nowhere::" + (folder_ / "far").string()).c_str(), 1);
    EXPECT_EQ(MassOfArm(Read(Include("model://" + name))), 3) << variable;
    unsetenv(variable);
  }
}

TEST_F(SdfFiles, AreFoundFromThoseThatAreIncluded) {
  Write("here/robot/model.sdf",
        Sdf("<model name='robot'><include merge='true'><uri>model://part</uri></include></model>"));
  Write("here/part/model.sdf", Sdf(Arm("part")));
  EXPECT_EQ(MassOfArm(Read(Include("model://robot"))), 3);
}

TEST_F(SdfFiles, ThatAreNotFoundAreNamedWithTheirLine) {
  const std::string what = Refusal(Include("model://nobody"));
  EXPECT_NE(what.find("world.sdf:3:1: 'model://nobody' is not found"), what.npos) << what;
  EXPECT_NE(what.find("GZ_SIM_RESOURCE_PATH"), what.npos) << what;
}

TEST_F(SdfFiles, ThatGoRoundInACircleAreNamed) {
  Write("here/a.sdf", Sdf("<model name='a'><include><uri>b.sdf</uri></include></model>"));
  Write("here/b.sdf", Sdf("<model name='b'>\n<include><uri>a.sdf</uri></include></model>"));
  const std::string what = Refusal(Include("a.sdf"));
  EXPECT_NE(what.find("b.sdf:2:1: "), what.npos) << what;
  EXPECT_NE(what.find("a.sdf includes itself by 'a.sdf'"), what.npos) << what;
}

TEST_F(SdfFiles, ThatBecomeTooManyAreRefused) {
  std::string twice;
  for (int i = 0; i < 20; ++i) {
    Write("here/" + std::to_string(i) + ".sdf",
          Sdf(twice.empty() ? Arm("arm") : "<model name='m'>" + twice + "</model>"));
    const std::string include = "<include><uri>" + std::to_string(i) + ".sdf</uri><name>";
    twice = include + "a</name></include>" + include + "b</name></include>";
  }
  EXPECT_NE(Refusal(Include("19.sdf")).find("more than 10000 files are included"),
            std::string::npos);
}

TEST_F(SdfFiles, HaveTheirNumbersCheckedWhereTheyStand) {
  Write("here/robot/model.sdf", Sdf(Arm("robot", "1e999")));
  const std::string what = Refusal(Include("model://robot"));
  EXPECT_NE(what.find("robot/model.sdf:3:1: <mass> of link 'arm': '1e999'"), what.npos) << what;
}

TEST_F(SdfFiles, HaveTheirInertiasMendedWhereTheyStand) {
  Write("here/robot/model.sdf", Sdf(Arm("robot", "3", "2.5")));
  const ImportedMechanism imported = Read(Include("model://robot"));
  const MassProperties& arm =
      imported.mechanism.links[FindLink(imported.mechanism, "arm")].mass_properties;
  // Second moments 1.25, 1.25, -0.25, of which the last becomes zero.
  EXPECT_LT((arm.I_Lcm - Matrix3d(Vector3d(1.25, 1.25, 2.5).asDiagonal())).norm(), kRounding);
  const std::string notes = NotesOf(imported);
  EXPECT_NE(notes.find("link 'arm': the largest moment"), notes.npos) << notes;
  EXPECT_NE(notes.find("robot/model.sdf:3)"), notes.npos) << notes;
  EXPECT_EQ(imported.mechanism.gravity_W, Vector3d(0, 0, -3));
  ImportOptions strict;
  strict.strict = true;
  const std::string what = Refusal(Include("model://robot"), strict);
  EXPECT_NE(what.find("model.sdf:3:1: link 'arm'"), what.npos) << what;
}

TEST_F(SdfFiles, TellWhatIsTheirDefault) {
  const std::string notes = NotesOf(
      Read(World("<model name='m'><link name='a'/>\n<link name='b'><inertial><mass>2</mass>"
                 "</inertial></link><joint name='j' type='ball'><parent>a</parent><child>b</child>"
                 "</joint></model>")));
  EXPECT_NE(notes.find("link 'a' has no inertial: 1 kg and 1 kg m^2"), notes.npos) << notes;
  EXPECT_NE(notes.find("link 'b' has no inertia: 1 kg m^2 by SDF's default"), notes.npos) << notes;
}

TEST_F(SdfFiles, OfSeveralModelsGiveTheOneThatIsAskedFor) {
  const std::string text = World(Arm("left", "4") + Arm("right", "5"));
  ImportOptions options;
  options.model = "right";
  const ImportedMechanism imported = Read(text, options);
  EXPECT_EQ(MassOfArm(imported), 5);
  EXPECT_NE(NotesOf(imported).find("model 'left' is left out"), std::string::npos);
  EXPECT_NE(Refusal(text).find("several models that move: left, right"), std::string::npos);
  options.model = "rihgt";
  EXPECT_NE(Refusal(text, options).find("did you mean 'right'?"), std::string::npos);
}

/// Two arms of which one hangs on the other, and a table that stands still.
const std::string kJoined = World(
    "<model name='table'><static>true</static><pose>0 0 2 0 0 0</pose><link name='top'/>"
    "</model>" +
    Arm("left", "4") + "<model name='right'><pose>5 0 0 0 0 0</pose><link name='arm'>" +
    Inertial("5") +
    "</link></model>"
    "<joint name='stand' type='fixed'><parent>table::top</parent><child>left::foot</child>"
    "</joint><joint name='between' type='prismatic'><parent>left::arm</parent><child>"
    "right::arm</child><axis><xyz>0 1 0</xyz></axis></joint>");

TEST_F(SdfFiles, WithJointsInTheWorldAreOneMechanism) {
  const ImportedMechanism imported = Read(kJoined);
  const Mechanism& mechanism = imported.mechanism;
  EXPECT_EQ(mechanism.name, "w");
  EXPECT_EQ(mechanism.links[mechanism.ground].name, "world");
  EXPECT_EQ(mechanism.gravity_W, Vector3d(0, 0, -3));
  ASSERT_EQ(mechanism.joints.size(), 3u);
  const Joint& between = mechanism.joints[FindJoint(mechanism, "between")];
  EXPECT_EQ(mechanism.links[between.first.link].name, "left::arm");
  EXPECT_EQ(mechanism.links[between.second.link].name, "right::arm");
  const std::vector<Posed> poses = LinkStartPoses(mechanism, FindSpanningTree(mechanism));
  EXPECT_LT((poses[FindLink(mechanism, "right::arm")].p - Vector3d(5, 0, 0)).norm(), kRounding);
  EXPECT_NE(NotesOf(imported).find("model 'table' is static: part of the ground"),
            std::string::npos);
}

TEST_F(SdfFiles, OfTheNextVersionAreReadAlike) {
  std::string text = kJoined;
  text.replace(text.find("1.9"), 3, "1.10");
  EXPECT_EQ(Read(text).mechanism.joints.size(), 3u);
}

TEST_F(SdfFiles, KeepTheLinesOfTheirFaultsThere) {
  std::string text = kJoined;
  text.replace(text.find("right::arm"), 10, "right::amr");
  EXPECT_NE(Refusal(text).find("amr"), std::string::npos);
}

}  // namespace
}  // namespace vmech::sdf_files_test
