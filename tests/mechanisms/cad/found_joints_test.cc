// Assemblies without anchors, with the play, the screws and the names of real ones.

#include <gtest/gtest.h>

#include <algorithm>

#include "closed_forms.h"
#include "samples.h"
#include "support/temp_folder.h"
#include "vmech/kinematics/loops/assembly.h"
#include "vmech/kinematics/loops/mobility.h"
#include "vmech/kinematics/tree/kinematic_tree.h"
#include "vmech/mechanisms/cad/mechanism_from_cad.h"
#include "vmech/mechanisms/cad/step/step_reader.h"

namespace vmech::found_joints_test {
namespace {

using samples::StepWriter;

constexpr double kSteel = 7850, kRelative = 1e-9;
const Vector3d kZ{0, 0, 1}, kX{1, 0, 0}, kInwards{0, -1, 0};

CadImport Import(void (*build)(StepWriter*), const CadImportOptions& options = {}) {
  const TempFolder folder;
  StepWriter step;
  build(&step);
  step.Write(folder / "it.step");
  return MechanismFromCad(ReadStep(folder / "it.step"), options);
}

int MobilityOf(const Mechanism& mechanism) {
  const KinematicTree tree = BuildKinematicTree(mechanism);
  VectorXd q = StartCoordinates(tree);
  EXPECT_TRUE(Assemble(tree, {}, &q).closed) << mechanism.name;
  return AnalyseMobility(tree, q).mobility;
}

std::vector<std::string> TypesOf(const CadImport& import) {
  std::vector<std::string> types;
  for (const Joint& joint : import.mechanism.joints) types.emplace_back(NameOf(joint.type));
  std::sort(types.begin(), types.end());
  return types;
}

JointType TypeOf(const CadImport& import, const std::string& joint) {
  const int index = FindJoint(import.mechanism, joint);
  EXPECT_GE(index, 0) << joint;
  return index < 0 ? JointType::kWeld : import.mechanism.joints[index].type;
}

/// Nominal diameters of the fits of revolute joints [mm], in increasing order.
std::vector<double> Bearings(const CadImport& import) {
  std::vector<double> diameters;
  for (const ImportedJoint& imported : import.joints) {
    if (import.mechanism.joints[imported.joint].type != JointType::kRevolute) continue;
    diameters.push_back(std::round(1e9 * imported.seat.nominal_diameter) / 1e6);
  }
  std::sort(diameters.begin(), diameters.end());
  return diameters;
}

const MassProperties& MassOf(const CadImport& import, const std::string& link) {
  const int index = FindLink(import.mechanism, link);
  EXPECT_GE(index, 0) << link;
  return import.mechanism.links[std::max(index, 0)].mass_properties;
}

void ExpectMass(const CadImport& import, const std::string& link, const Moments& moments) {
  const MassProperties& found = MassOf(import, link);
  const MassProperties expected = vmech::MassOf(moments, kSteel);
  EXPECT_NEAR(found.mass, expected.mass, kRelative * expected.mass) << link;
  EXPECT_LT((found.p_LoLcm - expected.p_LoLcm).norm(), 1e-10) << link;
  const double largest = expected.I_Lcm.cwiseAbs().maxCoeff();
  EXPECT_LT((found.I_Lcm - expected.I_Lcm).cwiseAbs().maxCoeff(), kRelative * largest) << link;
}

TEST(Door, OnTwoHingesWithEightScrewsHasOneFreedom) {
  const CadImport import = Import(samples::BuildDoor);
  EXPECT_EQ(import.merges.size(), 10u) << "eight screws and two pins";
  EXPECT_EQ(import.mechanism.links.size(), 6u) << "frame, door and four leaves";
  EXPECT_EQ(TypesOf(import),
            (std::vector<std::string>{"revolute", "revolute", "weld", "weld", "weld", "weld"}));
  EXPECT_EQ(MobilityOf(import.mechanism), 1);
  EXPECT_EQ(Bearings(import), (std::vector<double>{8, 8}));
  for (const ImportedJoint& imported : import.joints) {
    const Joint& joint = import.mechanism.joints[imported.joint];
    if (joint.type != JointType::kRevolute) continue;
    const Posed& X_LA = import.mechanism.links[joint.first.link].anchors[joint.first.anchor].X_LA;
    const Posed X_WA = import.bodies[joint.first.link].X_WL * X_LA;
    EXPECT_LT(X_WA.R.col(2).cross(kZ).norm(), 1e-12);
    EXPECT_NEAR(X_WA.p.x(), 0, 1e-12);
    EXPECT_NEAR(X_WA.p.y(), 0.0075, 1e-12);
  }
}

TEST(Door, WeighsWithTheScrewsThatSitInIt) {
  Moments door = BoxMoments({2, -40, 5}, {700, 0, 1800});
  for (const double foot : {200.0, 1500.0}) {
    for (const double z : {20.0, 70.0}) {
      door = door - CylinderMoments({25, 0, foot + z}, kInwards, 1.6, 30) +
             CylinderMoments({25, 3, foot + z}, kInwards, 2, 28) +
             CylinderMoments({25, 5.4, foot + z}, kInwards, 3.75, 2.4);
    }
  }
  const CadImport import = Import(samples::BuildDoor);
  ExpectMass(import, "door", door);
  Moments leaf = BoxMoments({7, 0, 0}, {40, 3, 90}) + BoxMoments({-7, 0.5, 30.1}, {7, 14.5, 59.9}) -
                 CylinderMoments({0, 7.5, 30.1}, kZ, 4, 29.8);
  for (const double z : {20.0, 70.0}) leaf = leaf - CylinderMoments({25, 3, z}, kInwards, 2.25, 3);
  ExpectMass(import, "leaf-of-door", leaf);
}

TEST(Door, CanBeMadeOfTwoBodies) {
  CadImportOptions options;
  options.bodies.weld = {{"frame", "leaf-of-frame", "leaf-of-frame-2"},
                         {"door", "leaf-of-door", "leaf-of-door-2"}};
  const CadImport import = Import(samples::BuildDoor, options);
  EXPECT_EQ(import.mechanism.links.size(), 2u);
  EXPECT_EQ(TypesOf(import), std::vector<std::string>{"revolute"});
}

TEST(Pump, WithPlayHasTheJointsOfItsNominalForm) {
  const CadImport import = Import(samples::BuildPump);
  EXPECT_EQ(TypeOf(import, "housing-crank"), JointType::kRevolute);
  EXPECT_EQ(TypeOf(import, "crank-rod"), JointType::kRevolute);
  EXPECT_EQ(TypeOf(import, "rod-piston"), JointType::kRevolute);
  EXPECT_EQ(TypeOf(import, "housing-piston"), JointType::kCylindrical);
  EXPECT_EQ(import.mechanism.joints.size(), 4u);
  EXPECT_EQ(import.mechanism.links[import.mechanism.ground].name, "housing");
  EXPECT_EQ(MobilityOf(import.mechanism), 1);
  EXPECT_EQ(Bearings(import), (std::vector<double>{10, 12, 20}));
}

TEST(Pump, WeighsWithItsPins) {
  const CadImport import = Import(samples::BuildPump);
  ASSERT_EQ(import.merges.size(), 2u);
  EXPECT_EQ(import.merges[0].into, "crank") << "the pin is pressed into it";
  const Moments crank =
      CylinderMoments({0, 0, -50}, kZ, 10, 40) + BoxMoments({-15, -15, -10}, {55, 15, 0}) -
      CylinderMoments({40, 0, -10}, kZ, 6, 10) + CylinderMoments({40, 0, -10}, kZ, 6, 30.3) +
      CylinderMoments({40, 0, 20.3}, kZ, 9, 4);
  ExpectMass(import, "crank", crank);
  const Moments lugs = BoxMoments({-10, -10, -12.15}, {25, 10, -0.15}) +
                       BoxMoments({-10, -10, 20.15}, {25, 10, 32.15}) -
                       CylinderMoments({0, 0, -12.15}, kZ, 5, 12) -
                       CylinderMoments({0, 0, 20.15}, kZ, 5, 12);
  ExpectMass(import, "piston", lugs + CylinderMoments({25, 0, 10}, kX, 30, 25));
}

Moments BarMoments(double length) {
  return BoxMoments({-12, -12, 0}, {length + 12, 12, 10}) + BoxMoments({15, 12, 0}, {25, 30, 10}) -
         CylinderMoments({0, 0, 0}, kZ, 6, 10) - CylinderMoments({length, 0, 0}, kZ, 6, 10);
}

/// The bolt through two layers whose lower one begins at z.
Moments BoltMoments(double x, double z) {
  return CylinderMoments({x, 0, z}, kZ, 5.99, 20) + CylinderMoments({x, 0, z + 20}, kZ, 9, 4);
}

Moments Mirrored(Moments moments) {
  const Matrix3d mirror = Vector3d(1, -1, 1).asDiagonal();
  return {moments.volume, mirror * moments.first, mirror * moments.second * mirror};
}

TEST(Linkage, OfAMirroredBarAndEqualBoltsInNestedGroupsHasOneFreedom) {
  const CadImport import = Import(samples::BuildLinkage);
  EXPECT_EQ(TypesOf(import), std::vector<std::string>(4, "revolute"));
  EXPECT_EQ(MobilityOf(import.mechanism), 1);
  EXPECT_EQ(Bearings(import), std::vector<double>(4, 12));
  std::vector<std::string> names;
  for (const Link& link : import.mechanism.links) names.push_back(link.name);
  const std::vector<std::string> drawn{"Fuß", "Kurbel", "Schwinge gespiegelt", "Koppel ü"};
  EXPECT_EQ(names, drawn);
  ASSERT_EQ(import.merges.size(), 4u);
  EXPECT_EQ(import.merges[0].body, "Bolzen à");
  EXPECT_EQ(import.merges[3].body, "Bolzen à-4");
}

TEST(Linkage, WeighsAsItsMirrorImageDoes) {
  const CadImport import = Import(samples::BuildLinkage);
  for (const BodyMerge& merge : import.merges) {
    EXPECT_TRUE(merge.into != "Koppel ü") << "of two equal fits the first body has the bolt";
  }
  ExpectMass(import, "Koppel ü", BarMoments(180));
  ExpectMass(import, "Kurbel", BarMoments(60) + BoltMoments(60, 0));
  ExpectMass(import, "Schwinge gespiegelt", Mirrored(BarMoments(120)) + BoltMoments(120, 0));
}

TEST(Linkage, TellsShaftsThatMissByALittle) {
  CadImportOptions options;
  options.contacts.tolerance = 5e-6;
  options.contacts.clearance = 1e-3;
  options.bodies.moving = {"Bolzen à", "Bolzen à-2", "Bolzen à-3", "Bolzen à-4"};
  const CadImport import = Import(samples::BuildLinkage, options);
  ASSERT_EQ(import.near_misses.size(), 8u) << "each of four bolts in two bores";
  for (const NearMiss& miss : import.near_misses) {
    EXPECT_EQ(miss.what,
              "shaft of 11.98 mm and bore of 12 mm: play of 0.01 mm on the radius, 0.006 "
              "mm allowed");
  }
  const std::string report = import.FullReport();
  EXPECT_NE(report.find("No fits by a little (--tolerance)\n  Fuß - Bolzen à, shaft"), report.npos)
      << report;
  EXPECT_TRUE(Import(samples::BuildLinkage).near_misses.empty());
}

}  // namespace
}  // namespace vmech::found_joints_test
