#include <fmt/format.h>

#include <BRepGProp.hxx>
#include <BRep_Tool.hxx>
#include <GProp_GProps.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopoDS.hxx>
#include <cmath>
#include <gp_Trsf.hxx>

#include "vmech/mechanisms/cad/shape_analysis.h"

namespace vmech {
namespace {

constexpr double kLeastVolume = 1e-15;  // [m^3]: a cube of 10 um

int Count(const TopoDS_Shape& shape, TopAbs_ShapeEnum kind, TopAbs_ShapeEnum avoid) {
  int count = 0;
  for (TopExp_Explorer it(shape, kind, avoid); it.More(); it.Next()) ++count;
  return count;
}

/// In a closed solid every edge bounds two faces (a seam: one face twice).
struct EdgeCount {
  int free = 0;     ///< edges of one face
  int crowded = 0;  ///< edges of three faces or more
};

EdgeCount CountEdges(const TopoDS_Shape& shape) {
  EdgeCount count;
  for (TopExp_Explorer solid(shape, TopAbs_SOLID); solid.More(); solid.Next()) {
    TopTools_IndexedDataMapOfShapeListOfShape faces;
    TopExp::MapShapesAndAncestors(solid.Current(), TopAbs_EDGE, TopAbs_FACE, faces);
    for (int i = 1; i <= faces.Extent(); ++i) {
      if (BRep_Tool::Degenerated(TopoDS::Edge(faces.FindKey(i)))) continue;
      count.free += faces(i).Extent() < 2;
      count.crowded += faces(i).Extent() > 2;
    }
  }
  return count;
}

}  // namespace

Posed PoseFrom(const gp_Trsf& placement) {
  Posed X;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) X.R(i, j) = placement.HVectorialPart().Value(i + 1, j + 1);
    X.p[i] = kMetresPerMillimetre * placement.TranslationPart().Coord(i + 1);
  }
  return X;
}

bool HasFaces(const TopoDS_Shape& shape) {
  return !shape.IsNull() && TopExp_Explorer(shape, TopAbs_FACE).More();
}

CadVolume MeasureVolume(const TopoDS_Shape& shape) {
  GProp_GProps sum;
  CadVolume result;
  for (TopExp_Explorer it(shape, TopAbs_SOLID); it.More(); it.Next(), ++result.solids) {
    GProp_GProps solid;
    BRepGProp::VolumeProperties(it.Current(), solid);
    sum.Add(solid);
  }
  result.volume = sum.Mass() * std::pow(kMetresPerMillimetre, 3);
  if (!(result.volume > kLeastVolume)) return result;
  const gp_Mat moments = sum.MatrixOfInertia();
  for (int i = 0; i < 3; ++i) {
    result.p_PoPcm[i] = kMetresPerMillimetre * sum.CentreOfMass().Coord(i + 1);
    for (int j = 0; j < 3; ++j) {
      result.moments(i, j) = std::pow(kMetresPerMillimetre, 5) * moments.Value(i + 1, j + 1);
    }
  }
  return result;
}

std::string FindDefect(const TopoDS_Shape& shape, const CadVolume& volume) {
  if (volume.solids == 0) {
    return "has surfaces but no solid, so that it has no volume; close it to a solid";
  }
  if (Count(shape, TopAbs_FACE, TopAbs_SOLID) > 0) {
    return "has surfaces beside its solids; remove them, or close them to a solid";
  }
  const EdgeCount edges = CountEdges(shape);
  if (edges.crowded > 0) {
    return fmt::format(
        "is not manifold: {} edge(s) belong to three faces or more; join or separate the solids "
        "that meet there",
        edges.crowded);
  }
  if (edges.free > 0) {
    return fmt::format("is not closed: {} edge(s) bound one face only; close the gaps", edges.free);
  }
  if (!(volume.volume > kLeastVolume)) {
    return fmt::format("has a volume of {:.3g} mm^3; a solid needs one above zero",
                       1e9 * volume.volume);
  }
  return {};
}

}  // namespace vmech
