#include "samples.h"

#include <gtest/gtest.h>

#include <numbers>

#include "closed_forms.h"
#include "support/temp_folder.h"
#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/load_study.h"
#include "vmech/dynamics/loads/run_load_study.h"
#include "vmech/kinematics/loops/assembly.h"
#include "vmech/kinematics/loops/mobility.h"
#include "vmech/kinematics/tree/kinematic_tree.h"
#include "vmech/mechanisms/cad/mechanism_from_cad.h"
#include "vmech/mechanisms/cad/step/step_reader.h"
#include "vmech/mechanisms/files/reader.h"

namespace vmech::samples_test {
namespace {

using samples::StepWriter;

constexpr double kDigits = 1e-12;  // [m]: STEP files have 15 digits

struct Sample {
  const char* name;
  void (*build)(StepWriter*);
  int mobility;
};

const Sample kSamples[] = {{"slider-crank", samples::BuildSliderCrank, 1},
                           {"four-bar", samples::BuildFourBar, 1},
                           {"rssr", samples::BuildRssr, 2},  // the rod spins about its own axis
                           {"arm", samples::BuildArm, 4}};

std::filesystem::path Kept(const std::string& name) {
  return std::filesystem::path(VMECH_CAD_SAMPLES) / (name + ".step");
}

CadImport Import(const std::string& name, const CadImportOptions& options = {}) {
  return MechanismFromCad(ReadStep(Kept(name)), options);
}

Mobility MobilityOf(const Mechanism& mechanism) {
  const KinematicTree tree = BuildKinematicTree(mechanism);
  VectorXd q = StartCoordinates(tree);
  EXPECT_TRUE(Assemble(tree, {}, &q).closed) << mechanism.name;
  return AnalyseMobility(tree, q);
}

double Difference(const Posed& a, const Posed& b) {
  return (a.R - b.R).norm() + (a.p - b.p).norm();
}

TEST(CadSamples, AreWhatTheProgramBesideThemWrites) {
  for (const Sample& sample : kSamples) {
    const TempFolder folder;
    StepWriter step;
    sample.build(&step);
    step.Write(folder / "new.step");
    const CadAssembly kept = ReadStep(Kept(sample.name)), written = ReadStep(folder / "new.step");
    ASSERT_EQ(kept.parts.size(), written.parts.size()) << sample.name;
    ASSERT_EQ(kept.frames.size(), written.frames.size()) << sample.name;
    for (size_t i = 0; i < kept.parts.size(); ++i) {
      EXPECT_EQ(kept.parts[i].name, written.parts[i].name);
      EXPECT_LT(Difference(kept.parts[i].X_WP, written.parts[i].X_WP), kDigits);
      const double volume = written.shapes[written.parts[i].shape].volume.volume;
      EXPECT_NEAR(kept.shapes[kept.parts[i].shape].volume.volume, volume, kDigits * volume);
    }
    for (size_t i = 0; i < kept.frames.size(); ++i) {
      EXPECT_EQ(kept.frames[i].name, written.frames[i].name);
      EXPECT_LT(Difference(kept.frames[i].X_WF, written.frames[i].X_WF), kDigits);
    }
  }
}

TEST(CadSamples, CloseAsDrawnAndHaveTheMobilityTheyShould) {
  for (const Sample& sample : kSamples) {
    const CadImport import = Import(sample.name);
    EXPECT_EQ(MobilityOf(import.mechanism).mobility, sample.mobility) << sample.name;
    for (const ImportedJoint& joint : import.joints) {
      EXPECT_LT(joint.gap + joint.skew, 1e-7) << sample.name;
    }
    EXPECT_TRUE(import.hints.empty() || std::string(sample.name) == "rssr") << sample.name;
  }
}

TEST(CadSamples, AreFoundByTheirGeometryAlone) {
  for (const Sample& sample : kSamples) {
    CadAssembly assembly = ReadStep(Kept(sample.name));
    assembly.frames.clear();
    CadImportOptions options;
    options.propose = true;
    for (size_t g = 1; g < assembly.groups.size(); ++g) {
      options.bodies.rigid.push_back(assembly.groups[g].name);
    }
    const CadImport import = MechanismFromCad(assembly, options);
    EXPECT_EQ(import.mechanism.joints.size(), 4u) << sample.name;
    EXPECT_EQ(MobilityOf(import.mechanism).mobility, sample.mobility) << sample.name;
  }
}

TEST(CadSamples, TellTheDiametersOfTheirShafts) {
  const CadImport import = Import("slider-crank");
  const auto diameter = [&](const char* joint) {
    for (const ImportedJoint& imported : import.joints) {
      if (import.mechanism.joints[imported.joint].name == joint)
        return imported.seat.shaft_diameter;
    }
    return 0.0;
  };
  EXPECT_NEAR(diameter("main"), 0.020, kDigits);
  EXPECT_NEAR(diameter("pin"), 0.017, kDigits);
  EXPECT_NEAR(diameter("wrist"), 0.012, kDigits);
  EXPECT_EQ(diameter("guide"), 0) << "a slide has no bearing";
}

// The slider-crank by hand: what slider_crank.cc draws, as sums of boxes and cylinders [mm].

constexpr double kSteel = 7850, kAluminium = 2700;
const Vector3d kX{1, 0, 0}, kZ{0, 0, 1};

MassProperties CrankByHand() {
  return MassOf(CylinderMoments({0, 0, -50}, kZ, 10, 40) +
                    BoxMoments({-15, -15, -10}, {65, 15, 0}) +
                    CylinderMoments({50, 0, 0}, kZ, 8.5, 20),
                kSteel);
}

MassProperties RodByHand() {
  return MassOf(
      BoxMoments({-20, -20, -10}, {20, 20, 10}) - CylinderMoments({0, 0, -10}, kZ, 8.5, 20) +
          BoxMoments({20, -8, -6}, {135, 8, 6}) + BoxMoments({135, -15, -10}, {165, 15, 10}) -
          CylinderMoments({150, 0, -10}, kZ, 6, 20),
      kSteel);
}

MassProperties PistonByHand() {
  const Moments lugs =
      BoxMoments({-12, -12, -22}, {25, 12, -10}) + BoxMoments({-12, -12, 10}, {25, 12, 22});
  const Moments bores =
      CylinderMoments({0, 0, -22}, kZ, 6, 12) + CylinderMoments({0, 0, 10}, kZ, 6, 12);
  const Moments body = lugs - bores + CylinderMoments({25, 0, 0}, kX, 30, 20);
  const Moments pin = CylinderMoments({0, 0, -22}, kZ, 6, 44);
  return MassOf(body * (kAluminium / kSteel) + pin, kSteel);
}

constexpr const char* kSliderCrankByHand = R"(
vmech: "1.0"
units: {length: mm, angle: deg}
gravity: [0, -9.81, 0]
ground: frame
links:
  frame:
    anchors:
      main:  {origin: [0, 0, -27.5]}
      guide: {origin: [0, 0, 10], z: [1, 0, 0], x: [0, 1, 0]}
  crank:
    mass: 1
    anchors: {main: {origin: [0, 0, -27.5]}, pin: {origin: [50, 0, 10]}}
  rod:
    mass: 1
    anchors: {pin: {origin: [0, 0, 0]}, wrist: {origin: [150, 0, 0]}}
  piston:
    mass: 1
    anchors:
      wrist: {origin: [0, 0, 0]}
      guide: {origin: [0, 0, 0], z: [1, 0, 0], x: [0, 1, 0]}
joints:
  main:  {type: revolute, connects: [frame/main, crank/main], start: 40}
  guide: {type: prismatic, connects: [frame/guide, piston/guide], start: 184.81863837639722}
  pin:   {type: revolute, connects: [crank/pin, rod/pin], start: -52.372265552638154}
  wrist: {type: revolute, connects: [rod/wrist, piston/wrist], start: 12.372265552638162}
)";

Mechanism SliderCrankByHand() {
  Mechanism mechanism = ParseMechanism(kSliderCrankByHand, "by hand");
  mechanism.links[1].mass_properties = CrankByHand();
  mechanism.links[2].mass_properties = RodByHand();
  mechanism.links[3].mass_properties = PistonByHand();
  return mechanism;
}

LoadStudy At1500Rpm(const Mechanism& mechanism, ReactionRule rule) {
  const int main = FindJoint(mechanism, "main");
  LoadStudy study;
  study.mechanism = mechanism;
  study.rule = rule;
  study.norm_length = 0.05;
  study.drives = {
      {main, 0, MotionLaw::Uniform(mechanism.joints[main].start[0], 50 * std::numbers::pi)}};
  for (int i = 0; i < 36; ++i) study.times.push_back(0.04 * i / 36);
  study.cycle = 0.04;
  return study;
}

TEST(CadSamples, SliderCrankHasTheJointLoadsOfTheOneWrittenByHand) {
  CadImportOptions options;
  options.gravity_W = Vector3d(0, -9.81, 0);
  options.densities.by_name = {{"piston-body", kAluminium}};
  const Mechanism from_cad = Import("slider-crank", options).mechanism;
  const Mechanism by_hand = SliderCrankByHand();
  constexpr double kRelative = 1e-8;  // of the largest load; asked for is 1e-6
  for (const ReactionRule rule : {ReactionRule::kStiffness, ReactionRule::kMinimumNorm}) {
    const LoadStudyResult one = RunLoadStudy(At1500Rpm(from_cad, rule));
    const LoadStudyResult other = RunLoadStudy(At1500Rpm(by_hand, rule));
    double largest = 0, difference = 0;
    for (size_t i = 0; i < other.poses.size(); ++i) {
      for (const Joint& joint : by_hand.joints) {
        const auto& a = one.poses[i].joints[FindJoint(from_cad, joint.name)];
        const auto& b = other.poses[i].joints[FindJoint(by_hand, joint.name)];
        largest = std::max(largest, b.Stacked().cwiseAbs().maxCoeff());
        difference = std::max(difference, (a.Stacked() - b.Stacked()).cwiseAbs().maxCoeff());
      }
    }
    EXPECT_GT(largest, 100);
    EXPECT_LT(difference, kRelative * largest);
  }
}

}  // namespace
}  // namespace vmech::samples_test
