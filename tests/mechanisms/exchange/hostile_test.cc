#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <ostream>

#include "support/temp_folder.h"
#include "vmech/mechanisms/exchange/sdf/sdf.h"
#include "vmech/mechanisms/exchange/urdf/urdf.h"
#include "vmech/mechanisms/files/document.h"

namespace vmech::hostile_test {
namespace {

/// A file that must be refused, and what must be in the message; beginning with the place.
struct Hostile {
  const char* subject;
  std::string text;
  const char* message;
};

void PrintTo(const Hostile& hostile, std::ostream* out) {
  *out << hostile.subject;
}

std::string Repeated(const std::string& text, int count) {
  std::string all;
  for (int i = 0; i < count; ++i) all += text;
  return all;
}

/// What reading a file of this name and text throws, without the folder.
std::string Refusal(const std::string& name, const std::string& text,
                    const std::function<void(const std::filesystem::path&)>& read) {
  const TempFolder folder;
  std::ofstream(folder / name, std::ios::binary) << text;
  try {
    read(folder / name);
  } catch (const FileErrors& errors) {
    const std::string what = errors.what(), path = folder.path().string() + "/";
    return what.substr(what.starts_with(path) ? path.size() : 0);
  }
  return "accepted";
}

// URDF

class HostileUrdf : public testing::TestWithParam<Hostile> {};

TEST_P(HostileUrdf, IsRefusedByPlaceAndName) {
  const std::string what = Refusal("file.urdf", GetParam().text,
                                   [](const std::filesystem::path& path) { ReadUrdf(path); });
  EXPECT_TRUE(what.starts_with("file.urdf:")) << what;
  EXPECT_NE(what.find(GetParam().message), what.npos) << what;
}

/// A base in line 2, and the parts from line 3 on.
std::string Robot(const std::string& parts) {
  return "<robot name='r'>\n<link name='a'/>\n" + parts + "</robot>";
}

std::string Body(const std::string& name, const std::string& mass = "1",
                 const std::string& ixx = "1", const std::string& origin = "") {
  return "<link name='" + name + "'><inertial>" + origin + "<mass value='" + mass +
         "'/><inertia ixx='" + ixx +
         "' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial></link>\n";
}

std::string Hinge(const std::string& name, const std::string& parent, const std::string& child,
                  const std::string& more = "", const std::string& type = "continuous") {
  return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent +
         "'/><child link='" + child + "'/>" + more + "</joint>\n";
}

/// One arm on the base, whose joint has more to it.
std::string Arm(const std::string& more, const std::string& type = "continuous") {
  return Robot(Body("b") + Hinge("j", "a", "b", more, type));
}

const std::string kBomb =
    "<?xml version='1.0'?>\n<!DOCTYPE lolz [<!ENTITY lol 'lol'><!ENTITY lol2 "
    "'&lol;&lol;&lol;&lol;&lol;'>]>\n<robot name='&lol2;'/>";

INSTANTIATE_TEST_SUITE_P(
    Text, HostileUrdf,
    testing::Values(
        Hostile{"Empty", "", "file.urdf:1:1: the file is empty"},
        Hostile{"Blank", " \n\n ", "the file is empty"},
        Hostile{"NotXml", "vmech: \"1.0\"\n", "file.urdf:1:1: is not XML"},
        Hostile{"Truncated", Robot("").substr(0, 33), "within <robot> of line 1: cut off?"},
        Hostile{"TruncatedInATag", "<robot name='r'><link na", "'=' expected"},
        Hostile{"TruncatedInAValue", "<robot name='r", "the value of 'name' has no end"},
        Hostile{"EntityBomb", kBomb, "file.urdf:2:1: declarations (<!DOCTYPE>"},
        Hostile{"UnknownEntity", Robot("<link name='&nbsp;'/>"), "&nbsp; stands for nothing"},
        Hostile{"NotACharacter", Robot("<link name='&#0;'/>"), "&#0; stands for nothing"},
        Hostile{
            "DeeplyNested",
            "<robot name='r'>" + Repeated("<a>", 100000) + Repeated("</a>", 100000) + "</robot>",
            "nested more than 64 deep"},
        Hostile{
            "HiddenNesting",
            "<robot name='r'>" + Repeated("<a b='/>'>", 100) + Repeated("</a>", 100) + "</robot>",
            "nested more than 64 deep"},
        Hostile{"TooManyElements", "<robot name='r'>" + Repeated("<a/>", 500001) + "</robot>",
                "more than 500000 elements"},
        Hostile{"TooManyAttributes",
                [] {
                  std::string text = "<robot";
                  for (int i = 0; i < 200000; ++i) text += " a" + std::to_string(i) + "=''";
                  return text + "/>";
                }(),
                "<robot> has more than 100 attributes"},
        Hostile{"NumbersWithoutEnd", Robot(Body("b", Repeated("1 ", 1000000))), "is not a number"},
        Hostile{"CrossedTags", Robot("<a><b></a></b>"), "</a> stands where <b> of line 3"},
        Hostile{"TwoRoots", Robot("") + "<robot name='r'/>", "behind the end of <robot>"},
        Hostile{"TwoAttributes", "<robot name='r' name='s'/>", "two attributes 'name'"},
        Hostile{"Utf16", std::string("\xFF\xFE<\0r\0o\0", 8), "save the file as UTF-8"},
        Hostile{"Latin1", Robot("<link name='b\xE9te'/>"),
                "file.urdf:3:14: byte that is not UTF-8"},
        Hostile{"NulBytes", Robot(std::string("<link\0name='b'/>", 16)), "control character 0x00"},
        Hostile{"Binary",
                std::string("\x7f"
                            "ELF\1\2\3\0",
                            8),
                "control character 0x7F"}),
    [](const auto& info) { return info.param.subject; });

INSTANTIATE_TEST_SUITE_P(
    Numbers, HostileUrdf,
    testing::Values(
        Hostile{"MassNan", Robot(Body("b", "nan")),
                "file.urdf:3:1: 'value' of <mass> of link 'b': 'nan'"},
        Hostile{"MassInfinite", Robot(Body("b", "inf")), "'inf' is not a finite number"},
        Hostile{"MassTooLarge", Robot(Body("b", "1e999")), "'1e999' is not a finite number"},
        Hostile{"MassBeyondReason", Robot(Body("b", "1e40")), "'1e40' is not a finite number"},
        Hostile{"MassHexadecimal", Robot(Body("b", "0x10")), "'0x10' is not a number"},
        Hostile{"MassWithComma", Robot(Body("b", "1,5")), "'1,5' is not a number"},
        Hostile{"MassEmpty", Robot(Body("b", "")), "'' is not a number"},
        Hostile{"MassOfXacro", Robot(Body("b", "${m}")), "has to go through xacro first"},
        Hostile{"InertiaNan", Robot(Body("b", "1", "nan")),
                "'ixx' of <inertia> of link 'b': 'nan'"},
        Hostile{"OriginOfTwoNumbers", Robot(Body("b", "1", "1", "<origin xyz='1 2'/>")),
                "'xyz' of <origin> of link 'b': '1 2' is not 3 numbers"},
        Hostile{"OriginOfFourNumbers", Arm("<origin xyz='1 2 3 4'/>"), "is not 3 numbers"},
        Hostile{"OriginOfWords", Arm("<origin xyz='a b c'/>"), "'a' is not a number"},
        Hostile{"OriginNan", Arm("<origin xyz='0 0 nan'/>"),
                "'xyz' of <origin> of joint 'j': 'nan'"},
        Hostile{"AnglesInfinite", Arm("<origin rpy='0 0 -inf'/>"),
                "'rpy' of <origin> of joint 'j': '-inf'"},
        Hostile{"QuaternionZero", Arm("<origin quat_xyzw='0 0 0 0'/>"), "has no length"},
        Hostile{"AxisZero", Arm("<axis xyz='0 0 0'/>"), "the axis of joint 'j' has no length"},
        Hostile{"AxisNan", Arm("<axis xyz='0 nan 1'/>"), "'xyz' of <axis> of joint 'j': 'nan'"},
        Hostile{"LimitsCrossed", Arm("<limit lower='2' upper='1'/>", "revolute"),
                "file.urdf:4:1: the lower limit of joint 'j', 2, is above the upper one, 1"},
        Hostile{"LimitNan", Arm("<limit lower='nan' upper='1'/>", "revolute"),
                "'lower' of <limit> of joint 'j'"},
        Hostile{"DampingNegative", Arm("<dynamics damping='-1'/>"), "must not be negative"}),
    [](const auto& info) { return info.param.subject; });

INSTANTIATE_TEST_SUITE_P(
    Parts, HostileUrdf,
    testing::Values(
        Hostile{"NoRobot", "<sdf version='1.9'/>", "<robot> expected"},
        Hostile{"NoName", "<robot><link name='a'/></robot>", "the robot has no name"},
        Hostile{"NoLink", "<robot name='r'/>", "there is no link"},
        Hostile{"LinkWithoutName", Robot("<link/>"), "file.urdf:3:1: a link has no name"},
        Hostile{"DuplicateLink", Robot("<link name='a'/>"),
                "a second link is called 'a'; the first"},
        Hostile{"DuplicateJoint",
                Robot(Body("b") + Body("c") + Hinge("j", "a", "b") + Hinge("j", "a", "c")),
                "file.urdf:6:1: a second joint is called 'j'; the first is in line 5"},
        Hostile{"TwoInertials",
                Robot("<link name='b'><inertial><mass value='1'/></inertial>"
                      "<inertial><mass value='2'/></inertial></link>"),
                "a second <inertial>"},
        Hostile{"InertialWithoutMass", Robot("<link name='b'><inertial/></link>"), "lacks <mass"},
        Hostile{"InertiaWithoutMoment",
                Robot("<link name='b'><inertial><mass value='1'/><inertia ixx='1'/></inertial>"
                      "</link>"),
                "<inertia> of link 'b' lacks 'iyy'"},
        Hostile{"NegativeMass", Robot(Body("b", "-1") + Hinge("j", "a", "b")),
                "the mass of link 'b', -1 kg, must not be negative"},
        Hostile{"SeveralRoots", Robot(Body("b")), "no joint leads to link 'b', nor to 'a'"},
        Hostile{"MissingParent", Robot(Body("b") + Hinge("j", "base", "b")),
                "joint 'j': there is no link 'base'"},
        Hostile{"MisspelledChild", Robot(Body("bar") + Hinge("j", "a", "baar")),
                "there is no link 'baar'; did you mean 'bar'?"},
        Hostile{"NoParent",
                Robot(Body("b") + "<joint name='j' type='fixed'><child link='b'/></joint>"),
                "joint 'j' lacks <parent link='...'>"},
        Hostile{"JointOfLinkWithItself", Robot(Body("b") + Hinge("j", "b", "b")),
                "joint 'j' joins link 'b' with itself"},
        Hostile{"TwoParents",
                Robot(Body("b") + Body("c") + Hinge("j", "a", "b") + Hinge("k", "a", "c") +
                      Hinge("l", "b", "c")),
                "link 'c' is the child of two joints, 'l' and 'k' (line 6)"},
        Hostile{"Cycle",
                Robot(Body("b") + Body("c") + Body("d") + Hinge("j", "d", "b") +
                      Hinge("k", "b", "c") + Hinge("l", "c", "d")),
                "in a circle, b -> c -> d -> b (joints 'k', 'l', 'j')"},
        Hostile{"NothingButACycle",
                "<robot name='r'>" + Body("b") + Body("c") + Hinge("j", "c", "b") +
                    Hinge("k", "b", "c") + "</robot>",
                "b -> c -> b"},
        Hostile{"UnknownType", Arm("", "revolut"), "'revolut', which is none of"},
        Hostile{"NoType",
                Robot(Body("b") + "<joint name='j'><parent link='a'/><child link='b'/>"
                                  "</joint>"),
                "joint 'j' is of type ''"},
        Hostile{"MimicOfNothing", Arm("<mimic/>"), "<mimic> of joint 'j' lacks 'joint'"},
        Hostile{"Xacro", Robot("<xacro:arm/>"), "has to go through xacro first"},
        Hostile{"MasslessEnd",
                Robot("<link name='b'/>" + Body("c") + Hinge("k", "a", "c") + Hinge("j", "a", "b")),
                "file.urdf:3:1: links.b: this link ends a chain and has no mass"}),
    [](const auto& info) { return info.param.subject; });

TEST(HostileUrdf, TellsAllFaultsOfAFileInOneGo) {
  const std::string what =
      Refusal("file.urdf", Robot(Body("b", "nan") + Body("c", "1", "inf") + Hinge("j", "a", "b")),
              [](const std::filesystem::path& path) { ReadUrdf(path); });
  EXPECT_NE(what.find("file.urdf:3:1:"), what.npos) << what;
  EXPECT_NE(what.find("file.urdf:4:1:"), what.npos) << what;
}

TEST(HostileUrdf, ThatIsAFolderOrIsNotThereIsNamed) {
  const TempFolder folder;
  std::filesystem::create_directory(folder / "robot.urdf");
  for (const char* name : {"robot.urdf", "absent.urdf"}) {
    try {
      ReadUrdf(folder / name);
      FAIL() << "accepted";
    } catch (const FileErrors& errors) {
      EXPECT_NE(std::string(errors.what()).find(name), std::string::npos) << errors.what();
    }
  }
}

// SDFormat

class HostileSdf : public testing::TestWithParam<Hostile> {};

TEST_P(HostileSdf, IsRefusedByPlaceAndName) {
  if (!HasSdfReader()) GTEST_SKIP() << "vmech was built without libsdformat";
  const std::string what = Refusal("file.sdf", GetParam().text,
                                   [](const std::filesystem::path& path) { ReadSdf(path); });
  EXPECT_TRUE(what.starts_with("file.sdf")) << what;
  EXPECT_NE(what.find(GetParam().message), what.npos) << what;
}

/// A base that stands still, an arm in line 3, and more.
std::string Sdf(const std::string& arm, const std::string& more = "",
                const std::string& joint = "") {
  return "<sdf version='1.9'><model name='m'><link name='base'/>\n"
         "<joint name='b' type='fixed'><parent>world</parent><child>base</child></joint>\n"
         "<link name='arm'>" +
         arm + "</link>\n" + more +
         "<joint name='j' type='revolute'><parent>base</parent><child>arm</child><axis><xyz>0 0 1"
         "</xyz>" +
         joint + "</axis></joint></model></sdf>";
}

std::string Mass(const std::string& mass) {
  return "<inertial><mass>" + mass + "</mass></inertial>";
}

INSTANTIATE_TEST_SUITE_P(
    All, HostileSdf,
    testing::Values(
        Hostile{"EntityBomb", "<!DOCTYPE a [<!ENTITY b 'b'>]><sdf version='1.9'>&b;</sdf>",
                "declarations"},
        Hostile{"Urdf", "<robot name='r'/>", "name a URDF .urdf"},
        Hostile{"DeeplyNested",
                "<sdf version='1.9'>" + Repeated("<model name='m'>", 3000) +
                    Repeated("</model>", 3000) + "</sdf>",
                "nested more than 64 deep"},
        Hostile{"NulBytes", Sdf(std::string("\0", 1)), "file.sdf:3:18: control character 0x00"},
        Hostile{"MassNan", Sdf(Mass("nan")), "file.sdf:3:1: <mass> of link 'arm': 'nan'"},
        Hostile{"MassInfinite", Sdf(Mass("inf")), "'inf' is not a finite number"},
        Hostile{"MassTooLarge", Sdf(Mass("1e999")), "'1e999' is not a finite number"},
        Hostile{"MassNegative", Sdf(Mass("-1")), "<mass> of link 'arm', -1, must not be negative"},
        Hostile{"MassOfWords", Sdf(Mass("heavy")), "'heavy' is not a number"},
        Hostile{"InertiaInfinite",
                Sdf("<inertial><mass>1</mass><inertia><ixx>inf</ixx></inertia></inertial>"),
                "<ixx> of link 'arm': 'inf'"},
        Hostile{"PoseOfFiveNumbers", Sdf("<pose>0 0 0 0 0</pose>"),
                "<pose> of link 'arm': '0 0 0 0 0' is not 6 numbers"},
        Hostile{"PoseNan", Sdf("<pose>0 0 0 0 nan 0</pose>"), "'nan' is not a finite number"},
        Hostile{"QuaternionZero", Sdf("<pose rotation_format='quat_xyzw'>0 0 0 0 0 0 0</pose>"),
                "has no length"},
        Hostile{"GravityNan",
                "<sdf version='1.9'><world name='w'><gravity>0 0 nan</gravity></world></sdf>",
                "<gravity> of world 'w'"},
        Hostile{"LimitsCrossed",
                Sdf(Mass("1"), "", "<limit><lower>2</lower><upper>1</upper></limit>"),
                "joint 'j': the lower limit 2 is above the upper one 1"},
        Hostile{"DampingNegative", Sdf(Mass("1"), "", "<dynamics><damping>-2</damping></dynamics>"),
                "<damping> of joint 'j', -2, must not be negative"},
        Hostile{"JointOfLinkWithItself",
                Sdf(Mass("1"),
                    "<joint name='k' type='ball'><parent>arm</parent><child>arm</child></joint>"),
                "k"},
        Hostile{"DuplicateLink", Sdf(Mass("1"), "<link name='arm'/>"), "arm"},
        Hostile{"TwoModelsWithoutAWorld",
                "<sdf version='1.9'><model name='a'><link name='l'/></model>\n"
                "<model name='b'><link name='l'/></model></sdf>",
                "file.sdf:2:1: a second <model> beside that of line 1"},
        Hostile{"IncludeFromTheNetwork",
                Sdf(Mass("1"), "<include><uri>https://fuel.org/arm</uri></include>"),
                "is on the network"},
        Hostile{"IncludeWithoutUri", Sdf(Mass("1"), "<include/>"), "<include> has no <uri>"},
        Hostile{"IncludeOfItself", Sdf(Mass("1"), "<include><uri>file.sdf</uri></include>"),
                "includes itself by 'file.sdf'"}),
    [](const auto& info) { return info.param.subject; });

}  // namespace
}  // namespace vmech::hostile_test
