#include "vmech/mechanisms/exchange/urdf/urdf.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <ostream>

#include "support/temp_folder.h"
#include "vmech/mechanisms/exchange/start_pose.h"
#include "vmech/mechanisms/files/document.h"

namespace vmech::urdf_test {
namespace {

constexpr double kRounding = 1e-15;

std::string Link(const std::string& name, const std::string& more = "") {
  return "<link name='" + name +
         "'><inertial><origin xyz='0.1 0 0' rpy='0 0 1.5707963267948966'/>"
         "<mass value='2'/><inertia ixx='1' ixy='0' ixz='0' iyy='2' iyz='0' "
         "izz='2.5'/></inertial>" +
         more + "</link>";
}

std::string Joint(const std::string& name, const std::string& type, const std::string& parent,
                  const std::string& child, const std::string& more = "") {
  return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent +
         "'/><child link='" + child + "'/>" + more + "</joint>";
}

const std::string kAxis = "<axis xyz='0 0 1'/>";
/// A parallelogram without the joint that closes it: bars of 1 m and 2 m.
const std::string kFourBar =
    "<robot name='bars'><link name='base'/>" + Link("left") + Link("top") + Link("right") +
    Joint("a", "continuous", "base", "left", kAxis) +
    Joint("b", "revolute", "left", "top",
          "<origin xyz='0 1 0' rpy='0 0 0'/><limit lower='-1' upper='2' effort='1' velocity='1'/>"
          "<dynamics damping='0.1' friction='0.2'/>" +
              kAxis) +
    Joint("d", "continuous", "base", "right", "<origin xyz='2 0 0'/>" + kAxis) + "</robot>";
const std::string kLoops = R"(vmech_loops: "1.0"
units: {length: mm}
links:
  top:   {anchors: {c: {origin: [2000, 0, 0]}}}
  right: {anchors: {c: {origin: [0, 1000, 0]}}}
loops:
  c: {type: revolute, connects: [top/c, right/c]}
)";

ImportedMechanism ReadText(const std::string& text) {
  const TempFolder folder;
  std::ofstream(folder / "file.urdf") << text;
  return ReadUrdf(folder / "file.urdf");
}

void AddLoopsText(const std::string& text, Mechanism* mechanism) {
  const TempFolder folder;
  std::ofstream(folder / "loops.yaml") << text;
  AddLoops(folder / "loops.yaml", mechanism);
}

TEST(Urdf, ReadsTheTreeWithItsRootAsGround) {
  const Mechanism mechanism = ReadText(kFourBar).mechanism;
  EXPECT_EQ(mechanism.name, "bars");
  EXPECT_EQ(mechanism.links[mechanism.ground].name, "base");
  EXPECT_EQ(mechanism.gravity_W, Vector3d(0, 0, -9.81));
  ASSERT_EQ(mechanism.joints.size(), 3u);
  const vmech::Joint& b = mechanism.joints[FindJoint(mechanism, "b")];
  EXPECT_EQ(mechanism.anchor(b.first).X_LA.p, Vector3d(0, 1, 0));
  EXPECT_EQ(b.lower[0], -1);
  EXPECT_EQ(b.upper[0], 2);
  EXPECT_EQ(b.passive[0].viscous, 0.1);
  EXPECT_EQ(b.passive[0].coulomb, 0.2);
  EXPECT_TRUE(std::isinf(mechanism.joints[FindJoint(mechanism, "a")].upper[0]));
}

TEST(Urdf, TurnsTheInertiaWithItsOrigin) {
  const Mechanism mechanism = ReadText(kFourBar).mechanism;
  const MassProperties& left = mechanism.links[FindLink(mechanism, "left")].mass_properties;
  EXPECT_EQ(left.mass, 2);
  EXPECT_EQ(left.p_LoLcm, Vector3d(0.1, 0, 0));
  EXPECT_LT((left.I_Lcm - Matrix3d(Vector3d(2, 1, 2.5).asDiagonal())).norm(), kRounding);
}

TEST(Urdf, PutsTheZAxisAlongTheAxis) {
  const std::string axis = "<origin xyz='1 2 3' rpy='0 0 1.5707963267948966'/><axis xyz='3 0 4'/>";
  const Mechanism mechanism =
      ReadText("<robot name='r'><link name='a'/>" + Link("b") +
               Joint("j", "prismatic", "a", "b", axis + "<limit effort='1' velocity='1'/>") +
               "</robot>")
          .mechanism;
  const Posed& X_LF = mechanism.anchor(mechanism.joints[0].first).X_LA;
  EXPECT_LT((X_LF.R.col(2) - Vector3d(0, 0.6, 0.8)).norm(), kRounding);
  const Posed& X_LM = mechanism.anchor(mechanism.joints[0].second).X_LA;
  EXPECT_LT((X_LM.R.col(2) - Vector3d(0.6, 0, 0.8)).norm(), kRounding);
  EXPECT_EQ(X_LM.p, Vector3d::Zero());
}

TEST(Urdf, ClosesItsLoopsByASideFile) {
  Mechanism mechanism = ReadText(kFourBar).mechanism;
  AddLoopsText(kLoops, &mechanism);
  const SpanningTree tree = FindSpanningTree(mechanism);
  ASSERT_EQ(tree.cuts.size(), 1u);
  const vmech::Joint& c = mechanism.joints[FindJoint(mechanism, "c")];
  const std::vector<Posed> poses = LinkStartPoses(mechanism, tree);
  const Vector3d on_top = poses[c.first.link] * mechanism.anchor(c.first).X_LA.p;
  const Vector3d on_right = poses[c.second.link] * mechanism.anchor(c.second).X_LA.p;
  EXPECT_LT((on_top - on_right).norm(), kRounding);
}

TEST(Urdf, NamesBothJointsOfALinkWithTwoParents) {
  try {
    ReadText("<robot name='r'><link name='base'/>" + Link("left") + Link("right") + Link("top") +
             Joint("a", "continuous", "base", "left", kAxis) +
             Joint("d", "continuous", "base", "right", kAxis) +
             Joint("b", "continuous", "left", "top", kAxis) +
             Joint("c", "continuous", "right", "top", kAxis) + "</robot>");
    FAIL() << "accepted";
  } catch (const FileErrors& errors) {
    EXPECT_NE(
        std::string(errors.what())
            .find("file.urdf:1:1: link 'top' is the child of two joints, 'c' and 'b' (line 1)"),
        std::string::npos)
        << errors.what();
  }
}

TEST(Urdf, ReadsALongChainWithoutRunningOutOfStack) {
  std::string text = "<robot name='r'><link name='l0'/>";
  constexpr int kLinks = 20000;
  for (int i = 1; i < kLinks; ++i) {
    const std::string name = "l" + std::to_string(i);
    text += "<link name='" + name + "'/>" +
            Joint("j" + name, "fixed", "l" + std::to_string(i - 1), name);
  }
  EXPECT_EQ(ReadText(text + "</robot>").mechanism.joints.size(), size_t{kLinks - 1});
}

TEST(Urdf, OfWhichTheEndIsMissingIsRefusedWhereverItEnds) {
  for (size_t length = 0; length + 8 < kFourBar.size(); length += 13) {
    EXPECT_THROW(ReadText(kFourBar.substr(0, length)), FileErrors) << length;
  }
}

TEST(Urdf, TakesLoopsBetweenTheAnchorsOfItsJointsWithoutLinks) {
  Mechanism mechanism = ReadText(kFourBar).mechanism;
  AddLoopsText("vmech_loops: \"1.0\"\nloops: {c: {type: spherical, connects: [top/b, right/d]}}\n",
               &mechanism);
  EXPECT_EQ(mechanism.joints.back().name, "c");
  EXPECT_EQ(mechanism.links[mechanism.joints.back().second.link].name, "right");
}

struct Malformed {
  const char* subject;
  std::string text;
  const char* message;
};

void PrintTo(const Malformed& malformed, std::ostream* out) {
  *out << malformed.subject;
}

class MalformedLoops : public testing::TestWithParam<Malformed> {};

TEST_P(MalformedLoops, AreRefusedWithThePlace) {
  Mechanism mechanism = ReadText(kFourBar).mechanism;
  try {
    AddLoopsText(GetParam().text, &mechanism);
    FAIL() << "accepted";
  } catch (const FileErrors& errors) {
    EXPECT_NE(std::string(errors.what()).find(GetParam().message), std::string::npos)
        << errors.what();
  }
}

std::string Loops(const std::string& links, const std::string& loops) {
  return "vmech_loops: \"1.0\"\nlinks: " + links + "\nloops: " + loops + "\n";
}

INSTANTIATE_TEST_SUITE_P(
    All, MalformedLoops,
    testing::Values(
        Malformed{"Empty", "", "empty"},
        Malformed{"OtherVersion", "vmech_loops: \"2.0\"\nlinks: {}\nloops: {}\n", "1:14"},
        Malformed{"NoLoops", "vmech_loops: \"1.0\"\n", "'loops'"},
        Malformed{"UnknownLink", Loops("{tpo: {anchors: {}}}", "{}"), "did you mean 'top'?"},
        Malformed{"AnchorTaken", Loops("{top: {anchors: {b: {}}}}", "{}"), "of this name"},
        Malformed{"JointTaken", Loops("{}", "{a: {type: spherical, connects: [top/b, base/a]}}"),
                  "there is a joint of this name"},
        Malformed{"NotFinite", Loops("{top: {anchors: {c: {origin: [.nan, 0, 0]}}}}", "{}"),
                  "2:38: links.top.anchors.c.origin[0]"},
        Malformed{"TooLarge", Loops("{top: {anchors: {c: {origin: [1e999, 0, 0]}}}}", "{}"),
                  "2:38: links.top.anchors.c.origin[0]"},
        Malformed{"TwoNumbers", Loops("{top: {anchors: {c: {origin: [1, 0]}}}}", "{}"),
                  "2:37: links.top.anchors.c.origin"},
        Malformed{"NulByte", Loops("{}", std::string("{c\0: {}}", 8)), "0x00"},
        Malformed{"Alias", Loops("&a {}", "*a"), "2:8"},
        Malformed{"DeeplyNested", Loops("{}", std::string(1000, '[') + std::string(1000, ']')),
                  "deep"},
        Malformed{
            "LinkWithItself",
            Loops("{top: {anchors: {c: {}}}}", "{c: {type: spherical, connects: [top/b, top/c]}}"),
            "3:"},
        Malformed{"UnknownAnchor", Loops("{}", "{c: {type: spherical, connects: [top/c, base/a]}}"),
                  "anchor 'top/c' not found"}),
    [](const auto& info) { return info.param.subject; });

}  // namespace
}  // namespace vmech::urdf_test
