#include "vmech/mechanisms/cad/step_reader.h"

#include <fmt/format.h>

#include <Interface_Check.hxx>
#include <Interface_CheckIterator.hxx>
#include <Interface_InterfaceModel.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_Printer.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <STEPControl_Controller.hxx>
#include <Standard_Failure.hxx>
#include <TColStd_SequenceOfAsciiString.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TDF_Label.hxx>
#include <TDF_Tool.hxx>
#include <TDataStd_Name.hxx>
#include <TDataStd_TreeNode.hxx>
#include <TDocStd_Document.hxx>
#include <TopLoc_Location.hxx>
#include <XCAFDoc.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_Material.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <XSControl_WorkSession.hxx>
#include <map>
#include <mutex>

#include "vmech/mechanisms/cad/crash_guard.h"
#include "vmech/mechanisms/cad/shape_analysis.h"
#include "vmech/mechanisms/cad/step_text.h"
#include "vmech/mechanisms/document.h"

namespace vmech {
namespace {

/// Open CASCADE prints to standard output; this keeps it quiet as long as it lives.
class Silence {
 public:
  Silence() : printers_(Message::DefaultMessenger()->Printers()) {
    Message::DefaultMessenger()->ChangePrinters().Clear();
  }
  ~Silence() { Message::DefaultMessenger()->ChangePrinters() = printers_; }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;

 private:
  Message_SequenceOfPrinters printers_;
};

std::string NameOf(const TDF_Label& label) {
  Handle(TDataStd_Name) name;
  if (!label.FindAttribute(TDataStd_Name::GetID(), name)) return {};
  const TCollection_ExtendedString& wide = name->Get();
  std::string text(wide.LengthOfCString(), '\0');
  char* start = text.data();
  wide.ToUTF8CString(start);
  return text;
}

/// Walks the tree of components and copies it into a CadAssembly.
class Walk {
 public:
  Walk(const Handle(TDocStd_Document) & document, const StepReadOptions& options,
       CadAssembly* assembly)
      : tool_(XCAFDoc_DocumentTool::ShapeTool(document->Main())),
        options_(options),
        assembly_(*assembly) {}

  void Run(const std::string& name) {
    TDF_LabelSequence roots;
    tool_->GetFreeShapes(roots);
    assembly_.groups.push_back({name, -1, {}});
    const bool one_tree = roots.Length() == 1 && XCAFDoc_ShapeTool::IsAssembly(roots.First());
    if (one_tree) {
      VisitComponents(roots.First(), TopLoc_Location(), 0);
    } else {
      for (const TDF_Label& root : roots) Visit(root, TopLoc_Location(), 0);
    }
  }

 private:
  void VisitComponents(const TDF_Label& assembly, const TopLoc_Location& place, int group) {
    TDF_LabelSequence components;
    XCAFDoc_ShapeTool::GetComponents(assembly, components);
    for (const TDF_Label& component : components) Visit(component, place, group);
  }

  /// A component, or a root.
  void Visit(const TDF_Label& label, const TopLoc_Location& parent_place, int group) {
    TDF_Label product = label;
    XCAFDoc_ShapeTool::GetReferredShape(label, product);
    const bool is_component = product != label;
    const std::string name = ComponentName(is_component ? NameOf(label) : "", NameOf(product));
    const TopLoc_Location place =
        is_component ? parent_place * XCAFDoc_ShapeTool::GetLocation(label) : parent_place;
    const Posed X_W = PoseFrom(place.Transformation());
    if (XCAFDoc_ShapeTool::IsAssembly(product)) {
      assembly_.groups.push_back({name, group, X_W});
      VisitComponents(product, place, static_cast<int>(assembly_.groups.size()) - 1);
    } else {
      AddLeaf(product, name, group, X_W);
    }
  }

  void AddLeaf(const TDF_Label& product, const std::string& name, int group, const Posed& X_W) {
    const TopoDS_Shape shape = XCAFDoc_ShapeTool::GetShape(product);
    if (HasFaces(shape)) {
      assembly_.parts.push_back({name, ShapeIndex(product, shape), group, X_W});
    } else {
      assembly_.frames.push_back({name, group, X_W});
    }
  }

  int ShapeIndex(const TDF_Label& product, const TopoDS_Shape& shape) {
    TCollection_AsciiString entry;
    TDF_Tool::Entry(product, entry);
    const auto [it, is_new] =
        shape_index_.try_emplace(entry.ToCString(), static_cast<int>(assembly_.shapes.size()));
    if (!is_new) return it->second;
    CadShape read;
    read.name = NameOf(product);
    read.volume = MeasureVolume(shape);
    read.defect = FindDefect(shape, read.volume);
    read.material = MaterialOf(product);
    read.features = FindFeatures(shape);
    if (options_.mesh_deflection > 0) read.mesh = MakeMesh(shape, options_.mesh_deflection);
    assembly_.shapes.push_back(std::move(read));
    return it->second;
  }

  static CadMaterial MaterialOf(const TDF_Label& product) {
    CadMaterial material;
    Handle(TDataStd_TreeNode) node;
    if (!product.FindAttribute(XCAFDoc::MaterialRefGUID(), node) || !node->HasFather()) {
      return material;
    }
    Handle(XCAFDoc_Material) attribute;
    if (!node->Father()->Label().FindAttribute(XCAFDoc_Material::GetID(), attribute)) {
      return material;
    }
    if (!attribute->GetName().IsNull()) material.name = attribute->GetName()->ToCString();
    constexpr double kFromGramsPerCubicCentimetre = 1000;
    if (attribute->GetDensity() > 0) {
      material.density = kFromGramsPerCubicCentimetre * attribute->GetDensity();
    }
    return material;
  }

  const Handle(XCAFDoc_ShapeTool) tool_;
  const StepReadOptions& options_;
  CadAssembly& assembly_;
  std::map<std::string, int> shape_index_;
};

std::string UnitOf(STEPCAFControl_Reader* reader) {
  TColStd_SequenceOfAsciiString lengths, angles, solid_angles;
  reader->ChangeReader().FileUnits(lengths, angles, solid_angles);
  return lengths.IsEmpty() ? "" : lengths.First().ToCString();
}

/// What is wrong with the entities of a file, in words: "#374: ...", the first of them.
std::string FaultsOf(STEPCAFControl_Reader* reader) {
  Interface_CheckIterator checks = reader->ChangeReader().WS()->ModelCheckList(false);
  const Handle(Interface_InterfaceModel) model = reader->ChangeReader().Model();
  std::string first;
  int count = 0;
  for (checks.Start(); checks.More(); checks.Next()) {
    if (!checks.Value()->HasFailed() || checks.Number() == 0) continue;
    if (count++ > 0) continue;
    const TCollection_HAsciiString label(*model->StringLabel(model->Value(checks.Number())));
    first = fmt::format("{}: {}", label.ToCString(), checks.Value()->CFail(1));
  }
  if (count < 2) return first;
  return fmt::format("{}, and {} more", first, count - 1);
}

void Read(const std::filesystem::path& path, const StepReadOptions& options,
          CadAssembly* assembly) {
  const auto fail = [&](const std::string& why) { throw FileErrors(path.string(), why); };
  STEPControl_Controller::Init();  // makes the settings; the reader's constructor reads them
  Interface_Static::SetCVal("xstep.cascade.unit", "MM");
  STEPCAFControl_Reader reader;
  reader.SetNameMode(true);
  reader.SetMatMode(true);
  if (reader.ReadFile(path.c_str()) != IFSelect_RetDone) {
    fail("cannot be understood as STEP; export it again from the CAD system");
  }
  if (const std::string faults = FaultsOf(&reader); !faults.empty()) {
    if (!options.tolerate_faults) {
      fail(
          fmt::format("has faulty entities ({}), so that parts or places may be lost; export it "
                      "again, or read what can be read (--tolerate-faults)",
                      faults));
    }
    assembly->remarks.push_back(fmt::format("faulty entities, which may be missing: {}", faults));
  }
  assembly->unit = UnitOf(&reader);
  Handle(TDocStd_Document) document = new TDocStd_Document("MDTV-XCAF");
  if (!reader.Transfer(document)) fail("has no shapes that can be read");
  Walk(document, options, assembly).Run(path.stem().string());
}

}  // namespace

bool HasStepReader() {
  return true;
}

CadAssembly ReadStep(const std::filesystem::path& path, const StepReadOptions& options) {
  options.Validate();
  RequireWholeStepFile(path);
  static std::mutex one_at_a_time;  // Open CASCADE keeps units and translators in statics
  const std::lock_guard<std::mutex> lock(one_at_a_time);
  const Silence silence;
  CadAssembly assembly;
  assembly.file = path.string();
  try {
    if (!Survives([&] { Read(path, options, &assembly); })) {
      throw FileErrors(
          path.string(),
          "is damaged in a way that brings Open CASCADE down; export or copy it again");
    }
    Read(path, options, &assembly);
  } catch (const Standard_Failure& failure) {
    throw FileErrors(path.string(), fmt::format("cannot be read; Open CASCADE says: {}",
                                                Quoted(failure.GetMessageString())));
  }
  FinishAssembly(&assembly);
  return assembly;
}

}  // namespace vmech
