#include "vmech/mechanisms/cad/step/frame_name.h"

#include <gtest/gtest.h>

namespace vmech::frame_name_test {
namespace {

using Role = FrameName::Role;

struct Named {
  const char* text;
  Role role;
  const char* name;
  std::optional<JointType> type;
  bool inverted = false;
};

TEST(FrameName, IsTakenApart) {
  for (const Named& expected : {
           Named{"anchor_main", Role::kJoint, "main", {}},
           Named{"Anchor_Main", Role::kJoint, "Main", {}},
           Named{"anchor_guide__prismatic", Role::kJoint, "guide", JointType::kPrismatic},
           Named{"anchor_end__ball", Role::kJoint, "end", JointType::kSpherical},
           Named{"anchor_a__fixed", Role::kJoint, "a", JointType::kWeld},
           Named{"dof_knee_inv", Role::kJoint, "knee", {}, true},
           Named{"dof_knee_inv__cylindrical", Role::kJoint, "knee", JointType::kCylindrical, true},
           Named{"dof_knee__cylindrical_inv", Role::kJoint, "knee", JointType::kCylindrical, true},
           Named{"anchor_guide__prismatic001", Role::kJoint, "guide", JointType::kPrismatic},
           Named{"dof_knee_inv002", Role::kJoint, "knee", {}, true},
           Named{"anchor_pin001", Role::kJoint, "pin001", {}},
           Named{"fix_plate", Role::kJoint, "plate", JointType::kWeld},
           Named{"frame_tip", Role::kAnchor, "tip", {}},
           Named{"grasp_handle", Role::kGrasp, "handle", {}},
           Named{"anchor_", Role::kNone, "", {}},
           Named{"LCS001", Role::kNone, "", {}},
       }) {
    const FrameName parsed = ParseFrameName(expected.text);
    EXPECT_EQ(parsed.role, expected.role) << expected.text;
    EXPECT_EQ(parsed.name, expected.name);
    EXPECT_EQ(parsed.type, expected.type) << expected.text;
    EXPECT_EQ(parsed.inverted, expected.inverted) << expected.text;
    EXPECT_EQ(parsed.error, "");
  }
}

TEST(FrameName, PrefersToCutWhatIsClosing) {
  EXPECT_TRUE(ParseFrameName("closing_top").prefer_cut);
  EXPECT_FALSE(ParseFrameName("dof_top").prefer_cut);
}

TEST(FrameName, SaysWhetherAGraspHoldsTheDirection) {
  EXPECT_EQ(ParseFrameName("grasp_tip__point").grasp, GraspKind::kPoint);
  EXPECT_EQ(ParseFrameName("grasp_tip").grasp, GraspKind::kRigid);
}

TEST(FrameName, NamesTheTypesThatThereAre) {
  EXPECT_NE(ParseFrameName("anchor_a__hinge").error.find("revolute"), std::string::npos);
  EXPECT_NE(ParseFrameName("anchor_a__screw").error, "") << "a frame has no pitch";
  EXPECT_NE(ParseFrameName("grasp_a__soft").error.find("point"), std::string::npos);
}

}  // namespace
}  // namespace vmech::frame_name_test
