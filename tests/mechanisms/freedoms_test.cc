#include "vmech/mechanisms/freedoms.h"
#include "vmech/mechanisms/mechanism.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace vmech::freedoms_test {
namespace {

using Names = std::vector<std::string>;

TEST(Freedoms, HaveTheNamesOfTheMotionsThatTheyLeaveFree) {
  EXPECT_EQ(NamesOfFreedoms(JointType::kRevolute), Names{"rz"});
  EXPECT_EQ(NamesOfFreedoms(JointType::kPrismatic), Names{"z"});
  EXPECT_EQ(NamesOfFreedoms(JointType::kCylindrical), (Names{"z", "rz"}));
  EXPECT_EQ(NamesOfFreedoms(JointType::kScrew), Names{"rz"});
  EXPECT_EQ(NamesOfFreedoms(JointType::kUniversal), (Names{"rx", "ry"}));
  EXPECT_EQ(NamesOfFreedoms(JointType::kSpherical), (Names{"rx", "ry", "rz"}));
  EXPECT_EQ(NamesOfFreedoms(JointType::kPlanar), (Names{"x", "y", "rz"}));
  EXPECT_EQ(NamesOfFreedoms(JointType::kWeld), Names{});
}

TEST(Freedoms, NamesAgreeWithWhatIsFreeAndWithWhatTurns) {
  constexpr const char* kAll[] = {"x", "y", "z", "rx", "ry", "rz"};
  for (int t = 0; t <= static_cast<int>(JointType::kWeld); ++t) {
    const auto type = static_cast<JointType>(t);
    const Freedoms& freedoms = FreedomsOfType(type);
    for (int k = 0; k < FreedomsOf(type); ++k) {
      const std::string name = NameOfFreedom(type, k);
      const auto at = std::find(std::begin(kAll), std::end(kAll), name) - std::begin(kAll);
      ASSERT_LT(at, 6) << NameOf(type) << name;
      EXPECT_TRUE(freedoms.free[at]) << NameOf(type) << name;
      EXPECT_EQ(name[0] == 'r', freedoms.rotates[k]) << NameOf(type) << name;
      EXPECT_EQ(FindFreedom(type, name), k);
    }
  }
}

TEST(Freedoms, AreFoundByNameOnly) {
  EXPECT_EQ(FindFreedom(JointType::kRevolute, "z"), -1);
  EXPECT_EQ(FindFreedom(JointType::kPlanar, "2"), -1);
  EXPECT_EQ(FindFreedom(JointType::kWeld, "x"), -1);
}

TEST(Freedoms, AJointWithOneLendsItItsName) {
  const Joint pin = MakeJoint("pin", JointType::kRevolute, {}, {});
  const Joint tube = MakeJoint("tube", JointType::kCylindrical, {}, {});
  EXPECT_EQ(NameOfFreedom(pin, 0), "pin");
  EXPECT_EQ(NameOfFreedom(tube, 1), "tube.rz");
  EXPECT_EQ(NameOfFreedom(MakeJoint("seam", JointType::kWeld, {}, {}), 0), "seam");
}

}  // namespace
}  // namespace vmech::freedoms_test
