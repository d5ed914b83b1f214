#include "vmech/mechanisms/cad/step/step_density.h"

#include <fmt/format.h>

#include <Interface_InterfaceModel.hxx>
#include <StepBasic_ConversionBasedUnit.hxx>
#include <StepBasic_DerivedUnit.hxx>
#include <StepBasic_DerivedUnitElement.hxx>
#include <StepBasic_MeasureWithUnit.hxx>
#include <StepBasic_ProductDefinition.hxx>
#include <StepBasic_SiUnit.hxx>
#include <StepBasic_SiUnitAndAreaUnit.hxx>
#include <StepBasic_SiUnitAndVolumeUnit.hxx>
#include <StepBasic_Unit.hxx>
#include <StepRepr_CharacterizedDefinition.hxx>
#include <StepRepr_MeasureRepresentationItem.hxx>
#include <StepRepr_PropertyDefinition.hxx>
#include <StepRepr_PropertyDefinitionRepresentation.hxx>
#include <StepRepr_Representation.hxx>
#include <StepRepr_RepresentationItem.hxx>
#include <StepRepr_RepresentedDefinition.hxx>
#include <TCollection_HAsciiString.hxx>
#include <cctype>
#include <cmath>

namespace vmech {
namespace {

constexpr double kLeastDensity = 1e-3, kGreatestDensity = 1e5;  // [kg/m^3], as for DensityOptions
constexpr int kDeepest = 8;  // units defined by other units; a file may define them in a circle

/// factor * kg^mass * m^length.
struct Dimension {
  double factor = 1, mass = 0, length = 0;
};

std::optional<Dimension> Power(const std::optional<Dimension>& unit, double exponent) {
  if (!unit) return std::nullopt;
  return Dimension{std::pow(unit->factor, exponent), unit->mass * exponent,
                   unit->length * exponent};
}

double FactorOf(StepBasic_SiPrefix prefix) {
  constexpr double kFactors[] = {1e18, 1e15, 1e12, 1e9,  1e6,  1e3,   1e2,   1e1,
                                 1e-1, 1e-2, 1e-3, 1e-6, 1e-9, 1e-12, 1e-15, 1e-18};
  return kFactors[prefix];
}

std::optional<Dimension> DimensionOf(const StepBasic_SiUnit& unit) {
  const double prefix = unit.HasPrefix() ? FactorOf(unit.Prefix()) : 1;
  if (unit.Name() == StepBasic_sunGram) return Dimension{1e-3 * prefix, 1, 0};
  if (unit.Name() != StepBasic_sunMetre) return std::nullopt;
  // Some programs write a volume as SI_UNIT(.MILLI.,.METRE.) and VOLUME_UNIT().
  const double exponent = unit.IsKind(STANDARD_TYPE(StepBasic_SiUnitAndVolumeUnit)) ? 3
                          : unit.IsKind(STANDARD_TYPE(StepBasic_SiUnitAndAreaUnit)) ? 2
                                                                                    : 1;
  return Power(Dimension{prefix, 0, 1}, exponent);
}

std::optional<Dimension> DimensionOf(const StepBasic_Unit& unit, int depth);

std::optional<Dimension> DimensionOf(const Handle(StepBasic_NamedUnit) & unit, int depth) {
  if (const auto* si = dynamic_cast<const StepBasic_SiUnit*>(unit.get())) return DimensionOf(*si);
  const auto* converted = dynamic_cast<const StepBasic_ConversionBasedUnit*>(unit.get());
  if (converted == nullptr || converted->ConversionFactor().IsNull() || depth > kDeepest) {
    return std::nullopt;
  }
  const Handle(StepBasic_MeasureWithUnit) measure = converted->ConversionFactor();
  auto base = DimensionOf(measure->UnitComponent(), depth + 1);
  if (base) base->factor *= measure->ValueComponent();
  return base;
}

/// "gram^3 cm^2" is how Open CASCADE writes g/cm^3.
bool IsOpenCascadesSlip(const StepBasic_DerivedUnit& unit) {
  if (unit.NbElements() != 2) return false;
  const auto is = [&](int number, StepBasic_SiUnitName name, double exponent) {
    const Handle(StepBasic_DerivedUnitElement) element = unit.ElementsValue(number);
    if (element.IsNull()) return false;
    const auto* si = dynamic_cast<const StepBasic_SiUnit*>(element->Unit().get());
    return si != nullptr && si->Name() == name && element->Exponent() == exponent;
  };
  return is(1, StepBasic_sunGram, 3) && is(2, StepBasic_sunMetre, 2);
}

std::optional<Dimension> DimensionOf(const StepBasic_DerivedUnit& unit, int depth) {
  if (IsOpenCascadesSlip(unit)) return Dimension{1000, 1, -3};
  Dimension product;
  for (int i = 1; i <= unit.NbElements(); ++i) {
    const Handle(StepBasic_DerivedUnitElement) element = unit.ElementsValue(i);
    if (element.IsNull()) return std::nullopt;
    const auto factor = Power(DimensionOf(element->Unit(), depth), element->Exponent());
    if (!factor) return std::nullopt;
    product.factor *= factor->factor;
    product.mass += factor->mass;
    product.length += factor->length;
  }
  return product;
}

std::optional<Dimension> DimensionOf(const StepBasic_Unit& unit, int depth) {
  if (const Handle(StepBasic_DerivedUnit) derived = unit.DerivedUnit(); !derived.IsNull()) {
    return DimensionOf(*derived, depth);
  }
  return DimensionOf(unit.NamedUnit(), depth);
}

bool SaysDensity(const Handle(TCollection_HAsciiString) & name) {
  if (name.IsNull()) return false;
  std::string text = name->ToCString();
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text.find("density") != std::string::npos;
}

StatedDensity Evaluate(int product, const StepBasic_MeasureWithUnit& measure) {
  const double value = measure.ValueComponent();
  const auto unit = DimensionOf(measure.UnitComponent(), 0);
  if (!unit || unit->mass != 1 || unit->length != -3) {
    return {product, {}, fmt::format("{:g} in a unit that is no mass per volume", value)};
  }
  const double density = unit->factor * value;
  if (density >= kLeastDensity && density <= kGreatestDensity) return {product, density, {}};
  return {product, {}, fmt::format("{:g} kg/m^3, which nothing weighs", density)};
}

/// The densities of a representation of a property of a product.
void AddDensities(const Interface_InterfaceModel& model,
                  const StepRepr_PropertyDefinitionRepresentation& stated_by,
                  std::vector<StatedDensity>* found) {
  const Handle(StepRepr_PropertyDefinition) property = stated_by.Definition().PropertyDefinition();
  const Handle(StepRepr_Representation) representation = stated_by.UsedRepresentation();
  if (property.IsNull() || representation.IsNull() || representation->Items().IsNull()) return;
  const int product = model.Number(property->Definition().ProductDefinition());
  if (product == 0) return;
  const bool is_named = SaysDensity(property->Name()) || SaysDensity(property->Description()) ||
                        SaysDensity(representation->Name());
  for (int i = 1; i <= representation->NbItems(); ++i) {
    const Handle(StepRepr_RepresentationItem) item = representation->ItemsValue(i);
    const auto* measure = dynamic_cast<const StepRepr_MeasureRepresentationItem*>(item.get());
    if (measure == nullptr || measure->Measure().IsNull()) continue;
    if (!is_named && !SaysDensity(item->Name())) continue;
    found->push_back(Evaluate(product, *measure->Measure()));
  }
}

}  // namespace

std::vector<StatedDensity> FindDensities(const Interface_InterfaceModel& model) {
  std::vector<StatedDensity> found;
  for (int i = 1; i <= model.NbEntities(); ++i) {
    const Handle(Standard_Transient)& entity = model.Value(i);
    const auto* stated_by =
        dynamic_cast<const StepRepr_PropertyDefinitionRepresentation*>(entity.get());
    if (stated_by != nullptr) AddDensities(model, *stated_by, &found);
  }
  return found;
}

}  // namespace vmech
