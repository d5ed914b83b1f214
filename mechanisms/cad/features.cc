#include <BRepAdaptor_Surface.hxx>
#include <BRepBndLib.hxx>
#include <BRepGProp.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <GProp_GProps.hxx>
#include <Poly_Triangulation.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "vmech/mechanisms/cad/shape_analysis.h"
#include "vmech/mechanisms/mechanism.h"

namespace vmech {
namespace {

constexpr double kSameLength = 1e-7;     // [m] between faces of one surface
constexpr double kSameDirection = 1e-6;  // [rad]
constexpr double kLeastTurn = 0.6;       // share of the full turn; fillets have a quarter or a half

Vector3d Metres(const gp_XYZ& v) {
  return kMetresPerMillimetre * Vector3d(v.X(), v.Y(), v.Z());
}

Vector3d Direction(const gp_Dir& d) {
  return {d.X(), d.Y(), d.Z()};
}

/// A part of a cylinder, as one face shows it.
struct CylinderFace {
  CadSurface surface;
  Vector3d point, axis;
  double radius;
  double low, high;  ///< along the axis from `point` [m]
  double area;       ///< [m^2]
};

bool IsReversed(const TopoDS_Face& face, const gp_Ax3& axes) {
  return (face.Orientation() == TopAbs_REVERSED) == axes.Direct();
}

CylinderFace TakeCylinder(const TopoDS_Face& face, const gp_Cylinder& cylinder) {
  double u_low = 0, u_high = 0, v_low = 0, v_high = 0;
  BRepTools::UVBounds(face, u_low, u_high, v_low, v_high);
  CylinderFace taken;
  taken.surface = IsReversed(face, cylinder.Position()) ? CadSurface::kBore : CadSurface::kShaft;
  taken.point = Metres(cylinder.Location().XYZ());
  taken.axis = Direction(cylinder.Axis().Direction());
  taken.radius = kMetresPerMillimetre * cylinder.Radius();
  taken.low = kMetresPerMillimetre * v_low;
  taken.high = kMetresPerMillimetre * v_high;
  taken.area = taken.radius * (u_high - u_low) * (taken.high - taken.low);
  return taken;
}

/// True if `b` continues the cylinder `a`: same surface, and they meet or overlap along the axis.
/// `b` is then expressed on a's axis.
bool Continues(const CylinderFace& a, CylinderFace* b) {
  if (a.surface != b->surface || std::abs(a.radius - b->radius) > kSameLength) return false;
  if (a.axis.cross(b->axis).norm() > kSameDirection) return false;
  const Vector3d offset = b->point - a.point;
  if (offset.cross(a.axis).norm() > kSameLength) return false;
  const double along = offset.dot(a.axis);
  const double sign = a.axis.dot(b->axis) < 0 ? -1 : 1;
  const auto [low, high] = std::minmax(along + sign * b->low, along + sign * b->high);
  if (low > a.high + kSameLength || high < a.low - kSameLength) return false;
  b->point = a.point;
  b->axis = a.axis;
  b->low = low;
  b->high = high;
  return true;
}

/// Joins the faces of one cylinder (CAD systems split it by seams, keyways and oil holes).
std::vector<CylinderFace> Join(std::vector<CylinderFace> faces) {
  std::vector<CylinderFace> joined;
  for (CylinderFace& face : faces) {
    for (auto it = joined.begin(); it != joined.end();) {
      CylinderFace other = *it;
      if (!Continues(face, &other)) {
        ++it;
        continue;
      }
      face.low = std::min(face.low, other.low);
      face.high = std::max(face.high, other.high);
      face.area += other.area;
      it = joined.erase(it);
    }
    joined.push_back(face);
  }
  return joined;
}

Matrix3d AxesWithZ(const Vector3d& z) {
  Vector3d x = Vector3d::Zero();
  int least = 0;
  z.cwiseAbs().minCoeff(&least);
  x[least] = 1;
  return AxesFromZX(z, x);
}

std::vector<CadFeature> WholeCylinders(const std::vector<CylinderFace>& cylinders) {
  std::vector<CadFeature> features;
  for (const CylinderFace& cylinder : cylinders) {
    const double length = cylinder.high - cylinder.low;
    const double whole = 2 * std::numbers::pi * cylinder.radius * length;
    if (!(cylinder.area > kLeastTurn * whole)) continue;
    CadFeature feature;
    feature.surface = cylinder.surface;
    feature.X_PF.R = AxesWithZ(cylinder.axis);
    feature.X_PF.p = cylinder.point + 0.5 * (cylinder.low + cylinder.high) * cylinder.axis;
    feature.radius = cylinder.radius;
    feature.length = length;
    features.push_back(feature);
  }
  return features;
}

CadFeature TakeSphere(const TopoDS_Face& face, const gp_Sphere& sphere) {
  CadFeature feature;
  feature.surface = IsReversed(face, sphere.Position()) ? CadSurface::kSocket : CadSurface::kBall;
  feature.X_PF.p = Metres(sphere.Location().XYZ());
  feature.radius = kMetresPerMillimetre * sphere.Radius();
  return feature;
}

CadFeature TakePlane(const TopoDS_Face& face, const gp_Pln& plane) {
  CadFeature feature;
  const Vector3d normal =
      (IsReversed(face, plane.Position()) ? -1 : 1) * Direction(plane.Axis().Direction());
  feature.X_PF.R = AxesWithZ(normal);
  feature.X_PF.p = Metres(plane.Location().XYZ());

  gp_Trsf to_plane;
  const Vector3d x = feature.X_PF.R.col(0);
  to_plane.SetTransformation(gp_Ax3(plane.Location(), gp_Dir(normal.x(), normal.y(), normal.z()),
                                    gp_Dir(x.x(), x.y(), x.z())));
  Bnd_Box box;
  BRepBndLib::AddOptimal(face.Moved(TopLoc_Location(to_plane)), box, false, false);
  feature.lower = Metres(box.CornerMin().XYZ());
  feature.upper = Metres(box.CornerMax().XYZ());
  return feature;
}

void AddTriangles(const TopoDS_Face& face, CadMesh* mesh) {
  TopLoc_Location place;
  const Handle(Poly_Triangulation) triangulation = BRep_Tool::Triangulation(face, place);
  if (triangulation.IsNull()) return;
  const int first = static_cast<int>(mesh->vertices.size());
  for (int i = 1; i <= triangulation->NbNodes(); ++i) {
    mesh->vertices.push_back(
        Metres(triangulation->Node(i).Transformed(place.Transformation()).XYZ()));
  }
  const bool reversed = face.Orientation() == TopAbs_REVERSED;
  for (int i = 1; i <= triangulation->NbTriangles(); ++i) {
    int a = 0, b = 0, c = 0;
    triangulation->Triangle(i).Get(a, b, c);
    if (reversed) std::swap(b, c);
    mesh->triangles.push_back({first + a - 1, first + b - 1, first + c - 1});
  }
}

}  // namespace

std::vector<CadFeature> FindFeatures(const TopoDS_Shape& shape) {
  std::vector<CadFeature> features;
  std::vector<CylinderFace> cylinders;
  for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next()) {
    const TopoDS_Face& face = TopoDS::Face(it.Current());
    const BRepAdaptor_Surface surface(face);
    if (surface.GetType() == GeomAbs_Cylinder) {
      cylinders.push_back(TakeCylinder(face, surface.Cylinder()));
    } else if (surface.GetType() == GeomAbs_Sphere) {
      features.push_back(TakeSphere(face, surface.Sphere()));
    } else if (surface.GetType() == GeomAbs_Plane) {
      features.push_back(TakePlane(face, surface.Plane()));
    }
  }
  const std::vector<CadFeature> whole = WholeCylinders(Join(std::move(cylinders)));
  features.insert(features.begin(), whole.begin(), whole.end());
  return features;
}

CadMesh MakeMesh(const TopoDS_Shape& shape, double deflection) {
  constexpr double kAngularDeflection = 0.35;  // [rad]: 18 facets around a cylinder
  const BRepMesh_IncrementalMesh mesher(shape, deflection / kMetresPerMillimetre, false,
                                        kAngularDeflection);
  CadMesh mesh;
  for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next()) {
    AddTriangles(TopoDS::Face(it.Current()), &mesh);
  }
  return mesh;
}

}  // namespace vmech
