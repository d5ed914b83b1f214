#include "vmech/mechanisms/cad/step/step_reader.h"

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
#include <StepBasic_SiUnitAndLengthUnit.hxx>
#include <StepShape_SolidModel.hxx>
#include <TColStd_SequenceOfAsciiString.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TDF_Label.hxx>
#include <TDF_Tool.hxx>
#include <TDataStd_Name.hxx>
#include <TDataStd_TreeNode.hxx>
#include <TDocStd_Document.hxx>
#include <TopLoc_Location.hxx>
#include <TransferBRep.hxx>
#include <Transfer_Binder.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XCAFDoc.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_Material.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>
#include <algorithm>
#include <map>
#include <mutex>

#include "vmech/mechanisms/cad/shape_analysis.h"
#include "vmech/mechanisms/cad/step/crash_guard.h"
#include "vmech/mechanisms/cad/step/part_name.h"
#include "vmech/mechanisms/cad/step/step_density.h"
#include "vmech/mechanisms/cad/step/step_text.h"
#include "vmech/mechanisms/files/document.h"

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

std::string EntryOf(const TDF_Label& label) {
  TCollection_AsciiString entry;
  TDF_Tool::Entry(label, entry);
  return entry.ToCString();
}

/// True for what the file names: products. Open CASCADE makes labels of its own for the solids and
/// sketches that one product holds, and gives them no names while auto-naming is off.
bool IsProduct(const TDF_Label& label) {
  return label.IsAttribute(TDataStd_Name::GetID());
}

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
  /// `densities`: by the entries of the labels of products.
  Walk(const Handle(TDocStd_Document) & document, const StepReadOptions& options,
       const std::map<std::string, double>& densities, CadAssembly* assembly)
      : tool_(XCAFDoc_DocumentTool::ShapeTool(document->Main())),
        options_(options),
        densities_(densities),
        assembly_(*assembly) {}

  void Run(const std::string& name) {
    TDF_LabelSequence roots;
    tool_->GetFreeShapes(roots);
    assembly_.groups.push_back({name, -1, {}});
    const bool one_tree = roots.Length() == 1 && HasComponents(roots.First());
    if (one_tree) {
      VisitComponents(roots.First(), TopLoc_Location(), 0);
    } else {
      for (const TDF_Label& root : roots) Visit(root, TopLoc_Location(), 0);
    }
  }

 private:
  static TDF_Label ProductOf(const TDF_Label& component) {
    TDF_Label product = component;
    XCAFDoc_ShapeTool::GetReferredShape(component, product);
    return product;
  }

  /// True for an assembly of products; a product of a solid and a sketch is none.
  static bool HasComponents(const TDF_Label& product) {
    if (!XCAFDoc_ShapeTool::IsAssembly(product)) return false;
    TDF_LabelSequence components;
    XCAFDoc_ShapeTool::GetComponents(product, components);
    return components.IsEmpty() ||
           std::any_of(components.begin(), components.end(),
                       [](const TDF_Label& component) { return IsProduct(ProductOf(component)); });
  }

  void VisitComponents(const TDF_Label& assembly, const TopLoc_Location& place, int group) {
    TDF_LabelSequence components;
    XCAFDoc_ShapeTool::GetComponents(assembly, components);
    for (const TDF_Label& component : components) {
      if (IsProduct(ProductOf(component))) {
        Visit(component, place, group);
      } else {
        AddOwnGeometry(component, assembly, place, group);
      }
    }
  }

  /// A solid that an assembly holds itself, beside its components, becomes a part of its name; its
  /// sketches are passed over.
  void AddOwnGeometry(const TDF_Label& component, const TDF_Label& assembly,
                      const TopLoc_Location& place, int group) {
    const TDF_Label own = ProductOf(component);
    if (!HasFaces(XCAFDoc_ShapeTool::GetShape(own))) return;
    const TopLoc_Location there = place * XCAFDoc_ShapeTool::GetLocation(component);
    AddLeaf(own, NameOf(assembly), group, PoseFrom(there.Transformation()));
  }

  /// A component, or a root.
  void Visit(const TDF_Label& label, const TopLoc_Location& parent_place, int group) {
    const TDF_Label product = ProductOf(label);
    const bool is_component = product != label;
    const std::string name = ComponentName(is_component ? NameOf(label) : "", NameOf(product));
    const TopLoc_Location place =
        is_component ? parent_place * XCAFDoc_ShapeTool::GetLocation(label) : parent_place;
    const Posed X_W = PoseFrom(place.Transformation());
    if (HasComponents(product)) {
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
    const std::string entry = EntryOf(product);
    const auto [it, is_new] =
        shape_index_.try_emplace(entry, static_cast<int>(assembly_.shapes.size()));
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

  /// A product's own, or that of its solid, where it has a sketch beside it.
  CadMaterial MaterialOf(const TDF_Label& product) const {
    CadMaterial material;
    TDF_LabelSequence labels;
    if (XCAFDoc_ShapeTool::IsAssembly(product)) XCAFDoc_ShapeTool::GetComponents(product, labels);
    labels.Prepend(product);
    for (const TDF_Label& label : labels) {
      const TDF_Label own = ProductOf(label);
      if (material.name.empty()) material.name = MaterialName(own);
      const auto stated = densities_.find(EntryOf(own));
      if (!material.density && stated != densities_.end()) material.density = stated->second;
    }
    return material;
  }

  static std::string MaterialName(const TDF_Label& product) {
    Handle(TDataStd_TreeNode) node;
    if (!product.FindAttribute(XCAFDoc::MaterialRefGUID(), node) || !node->HasFather()) return {};
    Handle(XCAFDoc_Material) material;
    if (!node->Father()->Label().FindAttribute(XCAFDoc_Material::GetID(), material)) return {};
    return material->GetName().IsNull() ? "" : CleanName(material->GetName()->ToCString(), "");
  }

  const Handle(XCAFDoc_ShapeTool) tool_;
  const StepReadOptions& options_;
  const std::map<std::string, double>& densities_;
  CadAssembly& assembly_;
  std::map<std::string, int> shape_index_;
};

Handle(Transfer_TransientProcess) TransferOf(STEPCAFControl_Reader* reader) {
  return reader->ChangeReader().WS()->TransferReader()->TransientProcess();
}

/// "#3127, and 1 more": solids of which Open CASCADE made no shape, without a word.
std::string LostSolidsOf(STEPCAFControl_Reader* reader) {
  const Handle(Transfer_TransientProcess) transfer = TransferOf(reader);
  const Handle(Interface_InterfaceModel) model = reader->ChangeReader().Model();
  std::string first;
  int count = 0;
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const Handle(Standard_Transient)& entity = model->Value(i);
    if (!entity->IsKind(STANDARD_TYPE(StepShape_SolidModel))) continue;
    const bool was_tried = !transfer->Find(entity).IsNull();
    if (!was_tried || !TransferBRep::ShapeResult(transfer, entity).IsNull()) continue;
    if (count++ == 0) first = model->StringLabel(entity)->ToCString();
  }
  return count < 2 ? first : fmt::format("{}, and {} more", first, count - 1);
}

/// By the entry of the product's label. Where a product has several densities, the last stands.
std::map<std::string, double> DensitiesOf(STEPCAFControl_Reader* reader,
                                          std::vector<std::string>* remarks) {
  const Handle(Transfer_TransientProcess) transfer = TransferOf(reader);
  const Handle(Interface_InterfaceModel) model = reader->ChangeReader().Model();
  std::map<std::string, double> densities;
  for (const StatedDensity& stated : FindDensities(*model)) {
    const TopoDS_Shape shape = TransferBRep::ShapeResult(transfer, model->Value(stated.product));
    TDF_Label label;
    if (shape.IsNull() || !reader->GetShapeLabelMap().Find(shape, label)) continue;
    const std::string product = Quoted(NameOf(label));
    if (!stated.density) {
      remarks->push_back(
          fmt::format("the density of {} is passed over: it is {}", product, stated.trouble));
      continue;
    }
    const auto [it, is_new] = densities.try_emplace(EntryOf(label), *stated.density);
    if (!is_new && it->second != *stated.density) {
      remarks->push_back(
          fmt::format("{} has two densities in the file, {:g} and {:g} kg/m^3; the "
                      "second is taken",
                      product, it->second, *stated.density));
      it->second = *stated.density;
    }
  }
  return densities;
}

std::string UnitOf(STEPCAFControl_Reader* reader) {
  TColStd_SequenceOfAsciiString lengths, angles, solid_angles;
  reader->ChangeReader().FileUnits(lengths, angles, solid_angles);
  return lengths.IsEmpty() ? "" : lengths.First().ToCString();
}

/// The label of a unit of length that is none, "#36": Open CASCADE reads millimetres there.
std::string WrongUnitOf(STEPCAFControl_Reader* reader) {
  const Handle(Interface_InterfaceModel) model = reader->ChangeReader().Model();
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const Handle(Standard_Transient)& entity = model->Value(i);
    const auto* unit = dynamic_cast<const StepBasic_SiUnitAndLengthUnit*>(entity.get());
    if (unit != nullptr && unit->Name() != StepBasic_sunMetre) {
      return model->StringLabel(entity)->ToCString();
    }
  }
  return {};
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

void Read(const std::filesystem::path& path, const StepReadOptions& options, bool is_utf8,
          CadAssembly* assembly) {
  const auto fail = [&](const std::string& why) { throw FileErrors(path.string(), why); };
  const auto tolerate = [&](const char* what, const std::string& which) {
    if (which.empty()) return;
    if (!options.tolerate_faults) {
      fail(
          fmt::format("has {} ({}), so that parts or places may be lost; export it again, or read "
                      "what can be read (--tolerate-faults)",
                      what, which));
    }
    assembly->remarks.push_back(fmt::format("{}, which may be missing: {}", what, which));
  };
  STEPControl_Controller::Init();  // makes the settings; the reader's constructor reads them
  Interface_Static::SetCVal("xstep.cascade.unit", "MM");
  Interface_Static::SetCVal("read.step.codepage", is_utf8 ? "UTF8" : "iso8859-1");
  XCAFDoc_ShapeTool::SetAutoNaming(false);  // IsProduct
  STEPCAFControl_Reader reader;
  reader.SetNameMode(true);
  reader.SetMatMode(true);
  if (reader.ReadFile(path.c_str()) != IFSelect_RetDone) {
    fail("cannot be understood as STEP; export it again from the CAD system");
  }
  tolerate("faulty entities", FaultsOf(&reader));
  assembly->unit = UnitOf(&reader);
  if (const std::string unit = WrongUnitOf(&reader); !unit.empty()) {
    fail(fmt::format("gives lengths in a unit that is no length ({}); export it again", unit));
  }
  Handle(TDocStd_Document) document = new TDocStd_Document("MDTV-XCAF");
  if (!reader.Transfer(document)) fail("has no shapes that can be read");
  tolerate("solids that cannot be built", LostSolidsOf(&reader));
  const auto densities = DensitiesOf(&reader, &assembly->remarks);
  Walk(document, options, densities, assembly).Run(path.stem().string());
}

}  // namespace

bool HasStepReader() {
  return true;
}

CadAssembly ReadStep(const std::filesystem::path& path, const StepReadOptions& options) {
  options.Validate();
  const bool is_utf8 = RequireWholeStepFile(path);
  static std::mutex one_at_a_time;  // Open CASCADE keeps units and translators in statics
  const std::lock_guard<std::mutex> lock(one_at_a_time);
  const Silence silence;
  CadAssembly assembly;
  assembly.file = path.string();
  try {
    if (!Survives([&] { Read(path, options, is_utf8, &assembly); })) {
      throw FileErrors(
          path.string(),
          "is damaged in a way that brings Open CASCADE down; export or copy it again");
    }
    Read(path, options, is_utf8, &assembly);
  } catch (const Standard_Failure& failure) {
    throw FileErrors(path.string(), fmt::format("cannot be read; Open CASCADE says: {}",
                                                Quoted(failure.GetMessageString())));
  }
  FinishAssembly(&assembly);
  return assembly;
}

}  // namespace vmech
