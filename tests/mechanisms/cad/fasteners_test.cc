#include "vmech/mechanisms/cad/fasteners.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "vmech/mechanisms/cad/mechanism_from_cad.h"
#include "vmech/mechanisms/files/document.h"

namespace vmech::fasteners_test {
namespace {

const Vector3d kZ{0, 0, 1};

/// A solid of revolution about z, of rings one upon the other, with the surfaces that it has.
class Turned {
 public:
  explicit Turned(const std::string& name) { shape_.name = name; }

  /// From z = low to high, between two radii [m]; `inner` 0: full.
  Turned& Ring(double low, double high, double outer, double inner = 0) {
    shape_.volume.solids = 1;
    const double length = high - low, middle = 0.5 * (low + high);
    const double sum = outer * outer + inner * inner;
    const double volume = M_PI * (outer * outer - inner * inner) * length;
    shape_.volume.volume += volume;
    first_ += volume * middle;
    across_ += volume * (sum / 4 + length * length / 12 + middle * middle);
    along_ += volume * sum / 2;
    const double centre = first_ / shape_.volume.volume;
    const double across = across_ - first_ * centre;
    shape_.volume.p_PoPcm.z() = centre;
    shape_.volume.moments = Vector3d(across, across, along_).asDiagonal();
    Add(CadSurface::kShaft, low, high, outer);
    if (inner > 0) Add(CadSurface::kBore, low, high, inner);
    AddPlane(high, kZ, outer);
    AddPlane(low, -kZ, outer);
    return *this;
  }

  /// A plate of a given half side with holes, whose moments are not needed.
  Turned& Plate(double low, double high, double half, const std::vector<Vector3d>& holes,
                double radius) {
    shape_.volume = {
        1, 4 * half * half * (high - low), {0, 0, 0.5 * (low + high)}, Matrix3d::Identity()};
    for (const Vector3d& hole : holes) Add(CadSurface::kBore, low, high, radius, hole);
    AddPlane(high, kZ, half);
    AddPlane(low, -kZ, half);
    return *this;
  }

  const CadShape& shape() const { return shape_; }

 private:
  void Add(CadSurface surface, double low, double high, double radius,
           const Vector3d& aside = Vector3d::Zero()) {
    CadFeature feature;
    feature.surface = surface;
    feature.X_PF.p = aside + 0.5 * (low + high) * kZ;
    feature.radius = radius;
    feature.length = high - low;
    shape_.features.push_back(feature);
  }
  void AddPlane(double z, const Vector3d& normal, double half) {
    CadFeature feature;
    feature.X_PF = {AxesFromZX(normal, {1, 0, 0}), {0, 0, z}};
    feature.lower = {-half, -half, 0};
    feature.upper = {half, half, 0};
    shape_.features.push_back(feature);
  }

  CadShape shape_;
  double first_ = 0, across_ = 0, along_ = 0;  ///< moments about the origin
};

/// Parts directly in the file, each of a shape of its own.
struct Assembly : CadAssembly {
  Assembly() {
    file = "plates.step";
    unit = "millimetre";
    groups = {{"plates", -1, {}}};
  }
  Assembly& Add(const Turned& turned, const Vector3d& p = Vector3d::Zero()) {
    shapes.push_back(turned.shape());
    parts.push_back({turned.shape().name, static_cast<int>(shapes.size()) - 1, 0, {}});
    parts.back().X_WP.p = p;
    return *this;
  }
};

constexpr double kHole = 0.00225, kCore = 0.0016, kShank = 0.002;  // [m], radii

Turned Screw() {
  return Turned("screw").Ring(-0.018, 0.002, kShank).Ring(0.002, 0.005, 0.0035);
}

/// Two plates one upon the other, and screws through the upper into the lower one.
Assembly Screwed(const std::vector<Vector3d>& places) {
  Assembly assembly;
  assembly.Add(Turned("lower").Plate(-0.02, 0, 0.05, places, kCore));
  assembly.Add(Turned("upper").Plate(0, 0.002, 0.03, places, kHole));
  for (const Vector3d& place : places) assembly.Add(Screw(), place);
  for (size_t i = 3; i < assembly.parts.size(); ++i) {
    assembly.parts[i].name = "screw-" + std::to_string(i - 1);
  }
  return assembly;
}

const std::vector<Vector3d> kTwoPlaces{{0.02, 0, 0}, {-0.02, 0, 0}};

TEST(Fasteners, ScrewsBelongToWhatTheySitInAndWeldWhatTheyHold) {
  const CadImport import = MechanismFromCad(Screwed(kTwoPlaces));
  ASSERT_EQ(import.merges.size(), 2u);
  for (const BodyMerge& merge : import.merges) {
    EXPECT_EQ(merge.into, "lower") << "the core hole is tighter than the clearance hole";
    EXPECT_EQ(merge.why, "fastener: shaft of 4 mm in a bore of 3.2 mm");
    EXPECT_TRUE(merge.is_guess);
  }
  ASSERT_EQ(import.mechanism.links.size(), 2u);
  ASSERT_EQ(import.mechanism.joints.size(), 1u);
  EXPECT_EQ(import.mechanism.joints[0].type, JointType::kWeld);
}

TEST(Fasteners, WhatScrewsHoldIsWeldedBesideNamedJoints) {
  Assembly assembly = Screwed(kTwoPlaces);
  assembly.Add(Turned("bar").Ring(1, 1.1, 0.01));
  assembly.groups.push_back({"arm", 0, {}});
  assembly.groups.push_back({"body", 0, {}});
  assembly.parts.back().group = 1;
  assembly.parts.front().group = 2;
  assembly.frames = {{"anchor_hinge", 1, {}}, {"anchor_hinge", 2, {}}};
  const CadImport import = MechanismFromCad(assembly);
  ASSERT_EQ(import.mechanism.joints.size(), 2u);
  EXPECT_EQ(import.mechanism.joints[0].name, "hinge");
  EXPECT_EQ(import.mechanism.joints[1].type, JointType::kWeld);
  EXPECT_EQ(import.merges.size(), 2u);
}

TEST(Fasteners, APivotOfOneScrewRemainsAHinge) {
  const CadImport import = MechanismFromCad(Screwed({{0, 0, 0}}));
  ASSERT_EQ(import.mechanism.joints.size(), 1u);
  EXPECT_EQ(import.mechanism.joints[0].type, JointType::kRevolute);
}

TEST(Fasteners, AHingePinBecomesPartOfOneLeaf) {
  Assembly assembly;
  assembly.Add(Turned("left").Plate(0, 0.01, 0.04, {{0, 0, 0}}, 0.005));
  assembly.Add(Turned("right").Plate(0.01, 0.02, 0.04, {{0, 0, 0}}, 0.00502));
  assembly.Add(Turned("pin").Ring(0, 0.02, 0.00499));
  const CadImport import = MechanismFromCad(assembly);
  ASSERT_EQ(import.merges.size(), 1u);
  EXPECT_EQ(import.merges[0].into, "left") << "the tighter fit";
  ASSERT_EQ(import.mechanism.joints.size(), 1u);
  EXPECT_EQ(import.mechanism.joints[0].type, JointType::kRevolute);
  EXPECT_NEAR(import.joints[0].seat.nominal_diameter, 0.010, 1e-12);
}

TEST(Fasteners, NutsAndWashersGoWithTheScrew) {
  Assembly assembly = Screwed(kTwoPlaces);
  // A third screw through both, with washer and nut below.
  for (CadFeature& feature : assembly.shapes[0].features) {
    if (feature.surface == CadSurface::kBore) feature.radius = kHole;
  }
  for (size_t i = 2; i < 4; ++i) {
    assembly.shapes[i] =
        Turned("bolt").Ring(-0.03, 0.002, kShank).Ring(0.002, 0.005, 0.0035).shape();
  }
  for (const Vector3d& place : kTwoPlaces) {
    assembly.Add(Turned("washer").Ring(-0.0208, -0.02, 0.0045, 0.00215), place);
    assembly.Add(Turned("nut").Ring(-0.024, -0.0208, 0.0037, 0.002), place);
  }
  for (size_t i = 4; i < 8; ++i) assembly.parts[i].name += std::to_string(i);
  const CadImport import = MechanismFromCad(assembly);
  EXPECT_EQ(import.merges.size(), 6u);
  ASSERT_EQ(import.mechanism.links.size(), 2u);
  EXPECT_EQ(import.mechanism.joints[0].type, JointType::kWeld);
  EXPECT_EQ(import.bodies[0].mass.parts.size() + import.bodies[1].mass.parts.size(), 8u);
}

/// A housing with two bores of which one holds a shaft, and a lid to leave something that moves.
Assembly HousingWith(const Turned& shaft) {
  Assembly assembly = Screwed(kTwoPlaces);
  const CadShape bored = Turned("").Plate(-0.02, 0, 0.05, {{0, 0.04, 0}}, 0.005).shape();
  assembly.shapes[0].features.push_back(bored.features.front());
  return assembly.Add(shaft, {0, 0.04, 0});
}

bool IsMerged(const CadImport& import, const std::string& name) {
  return std::any_of(import.merges.begin(), import.merges.end(),
                     [&](const BodyMerge& merge) { return merge.body == name; });
}

TEST(Fasteners, WhatMovesIsNone) {
  const Turned wheel = Turned("wheel").Ring(-0.02, 0, 0.005).Ring(0, 0.01, 0.009);
  EXPECT_FALSE(IsMerged(
      MechanismFromCad(HousingWith(Turned("wheel").Ring(-0.02, 0, 0.005).Ring(0, 0.01, 0.025))),
      "wheel"))
      << "its rim is far out";
  Turned lever = Turned("lever").Ring(-0.02, 0.01, 0.005);
  CadShape off_centre = lever.shape();
  off_centre.volume.p_PoPcm.x() = 0.002;
  Assembly assembly = HousingWith(lever);
  assembly.shapes.back() = off_centre;
  CadImportOptions options;
  options.propose = true;
  EXPECT_FALSE(IsMerged(MechanismFromCad(assembly, options), "lever")) << "its mass is aside";
  const Turned plunger = Turned("plunger").Ring(-0.03, 0.015, 0.00498);
  EXPECT_FALSE(IsMerged(MechanismFromCad(HousingWith(plunger)), "plunger"))
      << "in one body and stopped by nothing, it slides";
  EXPECT_TRUE(IsMerged(MechanismFromCad(HousingWith(wheel)), "wheel")) << "a stud with a collar";
}

TEST(Fasteners, MovingKeepsAPartAndFramesKeepABody) {
  const Turned stud = Turned("stud").Ring(-0.02, 0, 0.005).Ring(0, 0.01, 0.009);
  CadImportOptions options;
  options.bodies.moving = {"stud"};
  const CadImport import = MechanismFromCad(HousingWith(stud), options);
  EXPECT_FALSE(IsMerged(import, "stud"));
  EXPECT_EQ(import.mechanism.links.size(), 3u);
}

TEST(Fasteners, TheOnlyShaftInAHousingTurns) {
  Assembly assembly;
  assembly.Add(Turned("housing").Plate(-0.02, 0, 0.05, {{0, 0, 0}}, 0.005));
  assembly.Add(Turned("shaft").Ring(-0.02, 0, 0.00499).Ring(0, 0.01, 0.008));
  const CadImport import = MechanismFromCad(assembly);
  EXPECT_TRUE(import.merges.empty());
  ASSERT_EQ(import.mechanism.joints.size(), 1u);
  EXPECT_EQ(import.mechanism.joints[0].type, JointType::kRevolute);
}

TEST(Fasteners, WeldMakesOneBodyOfSeveralAndTheGroundStaysIt) {
  CadImportOptions options;
  options.bodies.weld = {{"upper", "lower"}};
  options.bodies.moving = {"screw", "screw-2"};
  options.ground = "lower";
  const CadImport import = MechanismFromCad(Screwed(kTwoPlaces), options);
  ASSERT_EQ(import.merges.size(), 1u);
  EXPECT_EQ(import.merges[0].body, "upper");
  EXPECT_EQ(import.merges[0].into, "lower");
  EXPECT_EQ(import.mechanism.links.size(), 3u);
  EXPECT_EQ(import.bodies[0].mass.parts.size(), 2u);
}

TEST(Fasteners, RigidTakesPartsAndSaysWhereTheyGo) {
  CadImportOptions options;
  options.bodies.moving = {"screw-2"};
  options.bodies.rigid = {"upper"};
  const CadImport import = MechanismFromCad(Screwed(kTwoPlaces), options);
  ASSERT_FALSE(import.merges.empty());
  EXPECT_EQ(import.merges[0].body, "upper");
  EXPECT_NE(import.merges[0].why.find("asked for (--rigid)"), std::string::npos);
}

std::string ErrorOf(const Assembly& assembly, const CadImportOptions& options) {
  try {
    MechanismFromCad(assembly, options);
  } catch (const FileErrors& error) {
    return error.what();
  }
  return "no error";
}

TEST(Fasteners, SaysWhatCannotBeJoined) {
  Assembly assembly = Screwed(kTwoPlaces);
  assembly.Add(Turned("alone").Ring(1, 1.1, 0.01));
  CadImportOptions options;
  options.bodies.rigid = {"alone"};
  EXPECT_NE(ErrorOf(assembly, options).find("part 'alone' (--rigid) touches no other"),
            std::string::npos);
  options.bodies = {};
  options.bodies.weld = {{"lower", "uper"}};
  EXPECT_NE(ErrorOf(assembly, options).find("no part or subassembly 'uper'; did you mean 'upper'?"),
            std::string::npos);
  options.bodies.weld = {{"lower", "alone"}};
  options.bodies.ignore = {"alone"};
  EXPECT_NE(ErrorOf(assembly, options).find("'alone' (--weld) is no body"), std::string::npos);
}

}  // namespace
}  // namespace vmech::fasteners_test
