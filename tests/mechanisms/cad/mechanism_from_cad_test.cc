#include "vmech/mechanisms/cad/mechanism_from_cad.h"

#include <gtest/gtest.h>

#include "vmech/mechanisms/files/document.h"

namespace vmech::mechanism_from_cad_test {
namespace {

constexpr double kRoundoff = 1e-12;
constexpr double kStart = 1e-11;  // [rad]: starts are rounded to 1e-9 degrees

Posed At(double x, double y, double z, double turn_about_z = 0) {
  return {Eigen::AngleAxisd(turn_about_z, Vector3d::UnitZ()).toRotationMatrix(), {x, y, z}};
}

/// A solid that weighs 1 kg at 1000 kg/m^3, around the origin.
CadShape Litre(const std::string& name) {
  CadShape shape;
  shape.name = name;
  shape.volume = {1, 1e-3, Vector3d::Zero(), 1e-6 * Matrix3d::Identity()};
  return shape;
}

/// base and arm, each a group of a part and a frame; the arm stands at (1, 0, 0), turned by 0.5.
CadAssembly BaseAndArm() {
  CadAssembly assembly;
  assembly.file = "arm.step";
  assembly.unit = "millimetre";
  assembly.shapes = {Litre("block"), Litre("bar")};
  assembly.groups = {{"arm", -1, {}}, {"base", 0, At(0, 0, 1)}, {"arm", 0, At(1, 0, 0, 0.5)}};
  assembly.groups[2].name = "lever";
  assembly.parts = {{"block", 0, 1, At(0, 0, 1)}, {"bar", 1, 2, At(2, 0, 0)}};
  assembly.frames = {{"anchor_hinge", 1, At(1, 0, 0)}, {"anchor_hinge", 2, At(1, 0, 0, 0.5)}};
  return assembly;
}

std::string ErrorOf(const CadAssembly& assembly, const CadImportOptions& options = {}) {
  try {
    MechanismFromCad(assembly, options);
  } catch (const FileErrors& error) {
    return error.what();
  }
  return "no error";
}

void ExpectIn(const std::string& part, const std::string& text) {
  EXPECT_NE(text.find(part), std::string::npos) << part << " is not in: " << text;
}

TEST(MechanismFromCad, JoinsBodiesAtAnchorsOfOneName) {
  const CadImport import = MechanismFromCad(BaseAndArm());
  const Mechanism& mechanism = import.mechanism;
  ASSERT_EQ(mechanism.links.size(), 2u);
  EXPECT_EQ(mechanism.links[mechanism.ground].name, "base");
  ASSERT_EQ(mechanism.joints.size(), 1u);
  EXPECT_EQ(mechanism.joints[0].name, "hinge");
  EXPECT_NEAR(mechanism.joints[0].start[0], 0.5, kStart);
  EXPECT_EQ(mechanism.joints[0].first.link, mechanism.ground);
  EXPECT_NEAR(import.joints[0].gap + import.joints[0].skew, 0, 1e-7);
}

TEST(MechanismFromCad, TakesTheWorldForTheAxesOfTheGroundAndTheGroupForThoseOfOthers) {
  const Mechanism mechanism = MechanismFromCad(BaseAndArm()).mechanism;
  EXPECT_NEAR((mechanism.links[0].anchors[0].X_LA.p - Vector3d(1, 0, 0)).norm(), 0, kRoundoff);
  EXPECT_NEAR(mechanism.links[1].anchors[0].X_LA.p.norm(), 0, kRoundoff);
  const Vector3d expected(std::cos(0.5), -std::sin(0.5), 0);  // the bar, seen from the lever
  EXPECT_NEAR((mechanism.links[1].mass_properties.p_LoLcm - expected).norm(), 0, kRoundoff);
}

TEST(MechanismFromCad, TakesTheDensityOfTheUserThenOfTheFileThenTheDefault) {
  CadAssembly assembly = BaseAndArm();
  const auto mass = [&](const CadImportOptions& options) {
    return MechanismFromCad(assembly, options).mechanism.links[1].mass_properties.mass;
  };
  CadImportOptions options;
  EXPECT_NEAR(mass(options), 7.85, kRoundoff);
  options.densities.fallback = 1000;
  EXPECT_NEAR(mass(options), 1, kRoundoff);
  assembly.shapes[1].material.name = "Aluminium";
  EXPECT_NEAR(mass(options), 2.7, kRoundoff);
  assembly.shapes[1].material.density = 2650;
  EXPECT_NEAR(mass(options), 2.65, kRoundoff);
  for (const char* name : {"lever", "bar", "Aluminium"}) {
    options.densities.by_name = {{name, 3000}};
    EXPECT_NEAR(mass(options), 3, kRoundoff) << name;
  }
}

TEST(MechanismFromCad, NamesTheNearestCandidateOfAnAnchorWithoutAPartner) {
  CadAssembly assembly = BaseAndArm();
  assembly.frames[1].name = "anchor_hingo";
  const std::string error = ErrorOf(assembly);
  ExpectIn("anchor 'anchor_hinge' of 'base' has no partner", error);
  ExpectIn("the nearest is 'anchor_hingo' of 'lever', 0 mm and 0 deg away", error);
}

TEST(MechanismFromCad, OverlooksTheNumbersThatFreecadPutsBehindNames) {
  CadAssembly assembly = BaseAndArm();
  assembly.frames[1].name = "anchor_hinge001";
  EXPECT_EQ(MechanismFromCad(assembly).mechanism.joints[0].name, "hinge");
}

TEST(MechanismFromCad, TurnsFramesThatEndInInv) {
  CadAssembly assembly = BaseAndArm();
  for (CadFrame& frame : assembly.frames) frame.name = "dof_hinge_inv";
  const Mechanism mechanism = MechanismFromCad(assembly).mechanism;
  EXPECT_NEAR(mechanism.links[0].anchors[0].X_LA.R(2, 2), -1, kRoundoff);
  EXPECT_NEAR(mechanism.joints[0].start[0], -0.5, kStart);
}

TEST(MechanismFromCad, ReportsHowFarAnchorsAreApart) {
  CadAssembly assembly = BaseAndArm();
  assembly.frames[1].X_WF.p += Vector3d(0.003, 0, 0.004);
  const CadImport import = MechanismFromCad(assembly);
  EXPECT_NEAR(import.joints[0].distance, 0.005, kRoundoff);
  ExpectIn("5 mm and 0 deg", import.FullReport());
  ASSERT_EQ(import.remarks.size(), 1u);
  ExpectIn("the assembly moves the links", import.remarks[0]);
}

TEST(MechanismFromCad, TakesTheTypeFromTheUserThenFromTheFrames) {
  CadAssembly assembly = BaseAndArm();
  assembly.frames[0].name = "anchor_hinge__cylindrical";
  EXPECT_EQ(MechanismFromCad(assembly).mechanism.joints[0].type, JointType::kCylindrical);
  CadImportOptions options;
  options.joint_types = {{"hinge", JointType::kSpherical}};
  EXPECT_EQ(MechanismFromCad(assembly, options).mechanism.joints[0].type, JointType::kSpherical);
  assembly.frames[1].name = "anchor_hinge__weld";
  ExpectIn("joint 'hinge' is cylindrical by frame", ErrorOf(assembly));
}

TEST(MechanismFromCad, MakesFramesInTheFileItselfTheGround) {
  CadAssembly assembly = BaseAndArm();
  assembly.groups[1].name = "block-group";
  assembly.frames[0].group = 0;
  CadImportOptions options;
  options.bodies.ignore = {"block"};
  const Mechanism mechanism = MechanismFromCad(assembly, options).mechanism;
  EXPECT_EQ(mechanism.links[mechanism.ground].name, "ground");
  EXPECT_EQ(mechanism.joints[0].first.link, mechanism.ground);
}

TEST(MechanismFromCad, MakesASubassemblyOneBodyIfAsked) {
  CadAssembly assembly = BaseAndArm();
  assembly.groups.push_back({"inner", 2, At(1, 1, 1)});
  assembly.parts.push_back({"bolt", 0, 3, At(3, 0, 0)});
  assembly.frames.push_back({"frame_tip", 3, At(3, 0, 0)});
  ExpectIn("'inner'", ErrorOf(assembly));  // a body by its frame, but joined to nothing
  CadImportOptions options;
  options.bodies.rigid = {"lever"};
  const Mechanism mechanism = MechanismFromCad(assembly, options).mechanism;
  ASSERT_EQ(mechanism.links.size(), 2u);
  EXPECT_NEAR(mechanism.links[1].mass_properties.mass, 2 * 7.85, kRoundoff);
  EXPECT_EQ(mechanism.links[1].anchors.size(), 2u);
}

struct Wrong {
  const char* name;
  void (*change)(CadAssembly*, CadImportOptions*);
  const char* message;
};

const Wrong kWrong[] = {
    {"third_anchor",
     [](CadAssembly* a, CadImportOptions*) {
       a->frames.push_back({"anchor_hinge", 0, {}});
     },
     "joint 'hinge' has 3 anchors"},
    {"one_body", [](CadAssembly* a, CadImportOptions*) { a->frames[1].group = 1; },
     "has both its anchors on one body"},
    {"two_grasps",
     [](CadAssembly* a, CadImportOptions*) {
       a->frames.push_back({"grasp_a", 2, {}});
       a->frames.push_back({"grasp_a", 2, {}});
     },
     "grasp 'a' is there twice"},
    {"ground", [](CadAssembly*, CadImportOptions* o) { o->ground = "bse"; },
     "there is no body 'bse' to be the ground; did you mean 'base'?"},
    {"ignored", [](CadAssembly*, CadImportOptions* o) { o->bodies.ignore = {"blok"}; },
     "there is no part or subassembly 'blok'; did you mean 'block'?"},
    {"joint_type",
     [](CadAssembly*, CadImportOptions* o) {
       o->joint_types = {{"hing", JointType::kWeld}};
     },
     "there is no joint 'hing' (--joint); did you mean 'hinge'?"},
    {"defect", [](CadAssembly* a, CadImportOptions*) { a->shapes[1].defect = "leaks"; },
     "part 'bar' leaks"},
};

TEST(MechanismFromCad, SaysWhatIsWrong) {
  for (const Wrong& wrong : kWrong) {
    CadAssembly assembly = BaseAndArm();
    CadImportOptions options;
    wrong.change(&assembly, &options);
    const std::string error = ErrorOf(assembly, options);
    ExpectIn(wrong.message, error);
    ExpectIn("arm.step: ", error);
  }
}

TEST(MechanismFromCad, OverlooksDefectsOfTheGround) {
  CadAssembly assembly = BaseAndArm();
  assembly.shapes[0].defect = "leaks";
  const CadImport import = MechanismFromCad(assembly);
  ASSERT_EQ(import.remarks.size(), 1u);
  ExpectIn("leaks", import.remarks[0]);
}

}  // namespace
}  // namespace vmech::mechanism_from_cad_test
