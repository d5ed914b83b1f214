#include "vmech/mechanisms/cad/step/step_reader.h"

#include <gtest/gtest.h>

#include "samples.h"
#include "support/temp_folder.h"

namespace vmech::step_reader_test {
namespace {

using samples::At;
using samples::Box;
using samples::Cylinder;
using samples::StepWriter;

constexpr double kDigits = 1e-12;  // [m]: STEP files have 15 digits

double Difference(const Posed& a, const Posed& b) {
  return (a.R - b.R).norm() + (a.p - b.p).norm();
}

CadAssembly WriteAndRead(StepWriter* step, const std::string& unit = "MM",
                         const StepReadOptions& options = {}) {
  const TempFolder folder;
  step->Write(folder / "it.step", unit);
  return ReadStep(folder / "it.step", options);
}

TEST(StepReader, MultipliesThePlacesOfNestedAssemblies) {
  const Posed X_WA = At({100, 20, 3}, {0, 1, 1}), X_AB = At({-7, 0, 50}, {1, 0, 0}, {0, 1, 0});
  const Posed X_BP = At({1, 2, 3}, {1, 1, 1}, {1, -1, 0}), X_BF = At({9, 8, 7}, {-1, 0, 2});
  StepWriter step;
  const StepWriter::Id outer = step.AddGroup(step.root(), "outer", X_WA);
  const StepWriter::Id inner = step.AddGroup(outer, "inner", X_AB);
  step.AddPart(inner, "block", Box({0, 0, 0}, {1, 2, 3}), X_BP);
  step.AddFrame(inner, "anchor_a", X_BF);

  const CadAssembly read = WriteAndRead(&step);
  ASSERT_EQ(read.parts.size(), 1u);
  ASSERT_EQ(read.frames.size(), 1u);
  ASSERT_EQ(read.groups.size(), 3u);
  EXPECT_EQ(read.groups[read.parts[0].group].name, "inner");
  EXPECT_EQ(read.groups[2].parent, 1);
  EXPECT_LT(Difference(read.groups[2].X_WG, X_WA * X_AB), kDigits);
  EXPECT_LT(Difference(read.parts[0].X_WP, X_WA * X_AB * X_BP), kDigits);
  EXPECT_EQ(read.frames[0].name, "anchor_a");
  EXPECT_LT(Difference(read.frames[0].X_WF, X_WA * X_AB * X_BF), kDigits);
}

TEST(StepReader, SharesTheShapeOfRepeatedComponentsAndTellsThemApart) {
  StepWriter step;
  const StepWriter::Id bolt = step.AddProduct("bolt", Cylinder({0, 0, 0}, {0, 0, 1}, 3, 20));
  step.Place(step.root(), bolt, "bolt", At({10, 0, 0}));
  step.Place(step.root(), bolt, "bolt", At({20, 0, 0}));
  step.Place(step.root(), bolt, "bolt", At({30, 0, 0}));
  const CadAssembly read = WriteAndRead(&step);
  EXPECT_EQ(read.shapes.size(), 1u);
  ASSERT_EQ(read.parts.size(), 3u);
  EXPECT_EQ(read.parts[0].name, "bolt");
  EXPECT_EQ(read.parts[2].name, "bolt-3");
  EXPECT_NEAR(read.parts[2].X_WP.p.x(), 0.030, kDigits);
  EXPECT_EQ(read.remarks.size(), 2u);
}

TEST(StepReader, NamesAComponentAfterItsProductIfTheWriterMadeItsNameUp) {
  StepWriter step;
  const StepWriter::Id block = step.AddProduct("block", Box({0, 0, 0}, {1, 2, 3}));
  step.Place(step.root(), block, "NAUO1");
  step.Place(step.root(), block, "left block");
  const CadAssembly read = WriteAndRead(&step);
  ASSERT_EQ(read.parts.size(), 2u);
  EXPECT_EQ(read.parts[0].name, "block");
  EXPECT_EQ(read.parts[1].name, "left block");
}

TEST(StepReader, TurnsEveryUnitOfLengthIntoMetres) {
  for (const auto& [unit, name] :
       {std::pair{"MM", "millimetre"}, std::pair{"INCH", "INCH"}, std::pair{"M", "metre"}}) {
    StepWriter step;
    step.AddPart(step.root(), "block", Box({0, 0, 0}, {25.4, 50.8, 10}), At({254, 0, 0}));
    const CadAssembly read = WriteAndRead(&step, unit);
    EXPECT_EQ(read.unit, name);
    EXPECT_NEAR(read.shapes[0].volume.volume, 0.0254 * 0.0508 * 0.01, 1e-9 * 1.3e-5) << unit;
    EXPECT_NEAR(read.parts[0].X_WP.p.x(), 0.254, kDigits) << unit;
  }
}

TEST(StepReader, TakesMaterialAndDensityFromTheFile) {
  StepWriter step;
  const StepWriter::Id block = step.AddProduct("block", Box({0, 0, 0}, {1, 2, 3}));
  step.SetMaterial(block, "tungsten", 19300);
  step.Place(step.root(), block, "block");
  const CadAssembly read = WriteAndRead(&step);
  EXPECT_EQ(read.shapes[0].material.name, "tungsten");
  ASSERT_TRUE(read.shapes[0].material.density.has_value());
  EXPECT_NEAR(*read.shapes[0].material.density, 19300, 1e-6);
}

TEST(StepReader, FindsShaftsBoresAndPlanesWithTheirMeasures) {
  StepWriter step;
  step.AddPart(
      step.root(), "tube",
      samples::Cut(Cylinder({1, 2, 3}, {1, 0, 0}, 20, 50), Cylinder({1, 2, 3}, {1, 0, 0}, 15, 50)));
  const CadAssembly read = WriteAndRead(&step);
  const std::vector<CadFeature>& features = read.shapes[0].features;
  ASSERT_EQ(features.size(), 4u);
  for (int i = 0; i < 2; ++i) {
    const CadFeature& cylinder = features[i];
    EXPECT_EQ(cylinder.surface, cylinder.radius > 0.0175 ? CadSurface::kShaft : CadSurface::kBore);
    EXPECT_NEAR(cylinder.length, 0.050, kDigits);
    EXPECT_LT((cylinder.X_PF.p - Vector3d(0.026, 0.002, 0.003)).norm(), kDigits);
  }
  for (int i = 2; i < 4; ++i) {
    const double side = features[i].X_PF.p.x() > 0.01 ? 1 : -1;
    EXPECT_EQ(features[i].surface, CadSurface::kPlane);
    EXPECT_NEAR(features[i].X_PF.R(0, 2), side, kDigits) << "the normal points out of the material";
  }
}

TEST(StepReader, LeavesFilletsOut) {
  StepWriter step;
  const TopoDS_Shape corner =
      samples::Cut(Box({0, 0, 0}, {10, 10, 20}), Cylinder({0, 0, 0}, {0, 0, 1}, 8, 20));
  step.AddPart(step.root(), "corner", corner);
  const CadAssembly read = WriteAndRead(&step);
  for (const CadFeature& feature : read.shapes[0].features) {
    EXPECT_EQ(feature.surface, CadSurface::kPlane);
  }
}

/// The volume inside a closed surface of triangles: sum of a.(b x c) / 6.
double VolumeOf(const CadMesh& mesh) {
  double volume = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    volume += mesh.vertices[a].dot(mesh.vertices[b].cross(mesh.vertices[c])) / 6;
  }
  return volume;
}

TEST(StepReader, MakesMeshesThatEncloseTheVolume) {
  StepWriter step;
  step.AddPart(
      step.root(), "tube",
      samples::Cut(Cylinder({1, 2, 3}, {1, 0, 0}, 20, 50), Cylinder({1, 2, 3}, {1, 0, 0}, 10, 50)));
  StepReadOptions options;
  options.mesh_deflection = 1e-5;
  const CadAssembly read = WriteAndRead(&step, "MM", options);
  const double volume = read.shapes[0].volume.volume;
  EXPECT_NEAR(VolumeOf(read.shapes[0].mesh), volume, 2e-3 * volume);
  EXPECT_TRUE(WriteAndRead(&step).shapes[0].mesh.triangles.empty());
}

}  // namespace
}  // namespace vmech::step_reader_test
