#include "step_writer.h"

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRep_Builder.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_Printer.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <STEPControl_Controller.hxx>
#include <ShapeUpgrade_UnifySameDomain.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TDF_Label.hxx>
#include <TDF_Tool.hxx>
#include <TDataStd_Name.hxx>
#include <TopoDS_Compound.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_MaterialTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <stdexcept>

#include "vmech/mechanisms/mechanism.h"

namespace vmech::samples {
namespace {

gp_Pnt Point(const Vector3d& p) {
  return {p.x(), p.y(), p.z()};
}

gp_Dir Direction(const Vector3d& d) {
  return {d.x(), d.y(), d.z()};
}

gp_Trsf Placement(const Posed& X) {
  gp_Trsf placement;
  placement.SetTransformation(
      gp_Ax3(Point(1e3 * X.p), Direction(X.R.col(2)), Direction(X.R.col(0))), gp_Ax3());
  return placement;
}

StepWriter::Id IdOf(const TDF_Label& label) {
  TCollection_AsciiString entry;
  TDF_Tool::Entry(label, entry);
  return {entry.ToCString()};
}

void SetName(const TDF_Label& label, const std::string& name) {
  TDataStd_Name::Set(label, TCollection_ExtendedString(name.c_str(), true));
}

Handle(XCAFDoc_ShapeTool) Tool(const Handle(TDocStd_Document) & document) {
  return XCAFDoc_DocumentTool::ShapeTool(document->Main());
}

}  // namespace

StepWriter::StepWriter() : document_(new TDocStd_Document("MDTV-XCAF")) {
  const TDF_Label label = Tool(document_)->NewShape();
  SetName(label, "assembly");
  root_ = IdOf(label);
}

TDF_Label StepWriter::LabelOf(const Id& id) const {
  TDF_Label label;
  TDF_Tool::Label(document_->GetData(), id.entry.c_str(), label);
  return label;
}

StepWriter::Id StepWriter::AddGroup(const Id& parent, const std::string& name, const Posed& X) {
  const TDF_Label label = Tool(document_)->NewShape();
  SetName(label, name);
  const Id id = IdOf(label);
  Place(parent, id, name, X);
  return id;
}

StepWriter::Id StepWriter::AddProduct(const std::string& name, const TopoDS_Shape& shape) {
  const TDF_Label label = Tool(document_)->AddShape(shape, false);
  SetName(label, name);
  return IdOf(label);
}

void StepWriter::Place(const Id& parent, const Id& product, const std::string& name,
                       const Posed& X) {
  const TDF_Label component = Tool(document_)->AddComponent(LabelOf(parent), LabelOf(product),
                                                            TopLoc_Location(Placement(X)));
  SetName(component, name);
}

void StepWriter::AddPart(const Id& parent, const std::string& name, const TopoDS_Shape& shape,
                         const Posed& X) {
  Place(parent, AddProduct(name, shape), name, X);
}

void StepWriter::AddFrame(const Id& parent, const std::string& name, const Posed& X) {
  TopoDS_Compound nothing;
  BRep_Builder().MakeCompound(nothing);
  AddPart(parent, name, nothing, X);
}

void StepWriter::SetMaterial(const Id& product, const std::string& material, double density) {
  const auto text = [](const std::string& s) { return new TCollection_HAsciiString(s.c_str()); };
  XCAFDoc_DocumentTool::MaterialTool(document_->Main())
      ->SetMaterial(LabelOf(product), text(material), text(material), 1e-3 * density,
                    text("density measure"), text("POSITIVE_RATIO_MEASURE"));
}

void StepWriter::Write(const std::filesystem::path& path, const std::string& unit) {
  Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_Printer));
  Tool(document_)->UpdateAssemblies();
  STEPControl_Controller::Init();  // makes the settings; the writer's constructor reads them
  Interface_Static::SetCVal("write.step.schema", "AP214IS");
  Interface_Static::SetCVal("write.step.unit", unit.c_str());
  STEPCAFControl_Writer writer;
  writer.SetNameMode(true);
  writer.SetMaterialMode(true);
  if (!writer.Transfer(document_, STEPControl_AsIs) ||
      writer.Write(path.c_str()) != IFSelect_RetDone) {
    throw std::runtime_error(path.string() + ": cannot be written");
  }
}

Posed At(const Vector3d& p_mm, const Vector3d& z, const Vector3d& x) {
  return {AxesFromZX(z, x), 1e-3 * p_mm};
}

TopoDS_Shape Box(const Vector3d& low, const Vector3d& high) {
  return BRepPrimAPI_MakeBox(Point(low), Point(high)).Shape();
}

TopoDS_Shape Cylinder(const Vector3d& foot, const Vector3d& direction, double radius,
                      double height) {
  return BRepPrimAPI_MakeCylinder(gp_Ax2(Point(foot), Direction(direction)), radius, height)
      .Shape();
}

TopoDS_Shape Ball(const Vector3d& center, double radius) {
  return BRepPrimAPI_MakeSphere(Point(center), radius).Shape();
}

TopoDS_Shape Join(const TopoDS_Shape& a, const TopoDS_Shape& b) {
  ShapeUpgrade_UnifySameDomain unify(BRepAlgoAPI_Fuse(a, b).Shape());
  unify.Build();
  return unify.Shape();
}

TopoDS_Shape Cut(const TopoDS_Shape& a, const TopoDS_Shape& b) {
  return BRepAlgoAPI_Cut(a, b).Shape();
}

TopoDS_Shape Mirrored(const TopoDS_Shape& shape) {
  gp_Trsf mirror;
  mirror.SetMirror(gp_Ax2(gp_Pnt(0, 0, 0), gp_Dir(0, 1, 0)));
  return BRepBuilderAPI_Transform(shape, mirror, true).Shape();
}

TopoDS_Shape Drawn(const Posed& X_AB, const TopoDS_Shape& shape) {
  return BRepBuilderAPI_Transform(shape, Placement(X_AB), true).Shape();
}

}  // namespace vmech::samples
