#pragma once

#include <TDocStd_Document.hxx>
#include <TopoDS_Shape.hxx>
#include <filesystem>
#include <string>

#include "vmech/base/pose.h"

class TDF_Label;

namespace vmech::samples {

/// Builds an assembly and writes it as STEP, as a CAD system would. Lengths in millimetres.
class StepWriter {
 public:
  /// A product or a group, for use in the calls below.
  struct Id {
    std::string entry;
  };

  StepWriter();
  /// The assembly that stands for the file.
  Id root() const { return root_; }

  /// A new, empty group (subassembly) in its place in another.
  Id AddGroup(const Id& parent, const std::string& name, const Posed& X = {});
  /// A shape that can be placed often.
  Id AddProduct(const std::string& name, const TopoDS_Shape& shape);
  void Place(const Id& parent, const Id& product, const std::string& name, const Posed& X = {});
  /// A product placed once.
  void AddPart(const Id& parent, const std::string& name, const TopoDS_Shape& shape,
               const Posed& X = {});
  /// A named coordinate system: a component without a shape.
  void AddFrame(const Id& parent, const std::string& name, const Posed& X = {});
  /// Of a product, by name and density [kg/m^3].
  void SetMaterial(const Id& product, const std::string& material, double density);

  /// `unit` is that of the file: "MM", "M", "INCH". @throws std::runtime_error
  void Write(const std::filesystem::path& path, const std::string& unit = "MM");

 private:
  TDF_Label LabelOf(const Id& id) const;

  Handle(TDocStd_Document) document_;
  Id root_;
};

/// A pose from millimetres: origin p, z axis and x axis (made square to z).
Posed At(const Vector3d& p_mm, const Vector3d& z = {0, 0, 1}, const Vector3d& x = {1, 0, 0});

/// A box from corner to corner; a cylinder of a given height from the middle of its foot; solids
/// joined and cut. Millimetres.
TopoDS_Shape Box(const Vector3d& low, const Vector3d& high);
TopoDS_Shape Cylinder(const Vector3d& foot, const Vector3d& direction, double radius,
                      double height);
TopoDS_Shape Ball(const Vector3d& center, double radius);
TopoDS_Shape Join(const TopoDS_Shape& a, const TopoDS_Shape& b);
TopoDS_Shape Cut(const TopoDS_Shape& a, const TopoDS_Shape& b);
/// The shape as a mirror in the plane y = 0 shows it.
TopoDS_Shape Mirrored(const TopoDS_Shape& shape);
/// The shape with other coordinates: drawn in B, in the axes of A.
TopoDS_Shape Drawn(const Posed& X_AB, const TopoDS_Shape& shape);

}  // namespace vmech::samples
