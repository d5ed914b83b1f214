#include "vmech/mechanisms/cad/body_mass.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <stdexcept>
#include <string_view>

#include "vmech/mechanisms/files/document.h"
#include "vmech/mechanisms/mass_properties.h"

namespace vmech {
namespace {

struct Material {
  std::string_view name;
  double density;  ///< [kg/m^3]
};

/// Usual values at room temperature, rounded as tables of machine elements print them.
constexpr std::array<Material, 16> kMaterials{{{"steel", 7850},
                                               {"stainless-steel", 7900},
                                               {"cast-iron", 7200},
                                               {"aluminium", 2700},
                                               {"aluminum", 2700},
                                               {"titanium", 4510},
                                               {"brass", 8500},
                                               {"bronze", 8800},
                                               {"copper", 8960},
                                               {"magnesium", 1740},
                                               {"abs", 1050},
                                               {"pla", 1240},
                                               {"pom", 1410},
                                               {"nylon", 1140},
                                               {"pmma", 1190},
                                               {"wood", 700}}};

const Material* FindMaterial(std::string text) {
  for (char& c : text) {
    c = c == ' ' || c == '_' ? '-' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  const auto it = std::find_if(kMaterials.begin(), kMaterials.end(),
                               [&](const Material& m) { return m.name == text; });
  return it == kMaterials.end() ? nullptr : &*it;
}

void RequireDensity(double density) {
  if (density >= 1e-3 && density <= 1e5) return;
  throw std::invalid_argument(fmt::format("density [kg/m^3] = {} is not in 1e-3..1e5", density));
}

void SetDensity(const CadShape& shape, const std::string& body, const DensityOptions& options,
                BodyMass::Part* part) {
  for (const auto& [name, density] : options.by_name) {
    if (name != part->name && name != shape.name && name != body && name != shape.material.name) {
      continue;
    }
    part->density = density;
    part->source = "given for " + name;
    return;
  }
  const CadMaterial& material = shape.material;
  const Material* known = FindMaterial(material.name);
  if (material.density) {
    part->density = *material.density;
    part->source = fmt::format("in the file{}{}", material.name.empty() ? "" : ", ", material.name);
  } else if (known != nullptr) {
    part->density = known->density;
    part->source = fmt::format("usual for {}, the material in the file", known->name);
  } else {
    part->density = options.fallback.value_or(kUsualDensity);
    part->assumed = !options.fallback;
    part->source = part->assumed ? "assumed" : "given for all";
  }
}

}  // namespace

void DensityOptions::Validate() const {
  if (fallback) RequireDensity(*fallback);
  for (const auto& [name, density] : by_name) RequireDensity(density);
}

double DensityFromText(const std::string& text) {
  if (const Material* material = FindMaterial(text)) return material->density;
  if (const auto number = ParseNumber(text)) {
    RequireDensity(*number);
    return *number;
  }
  std::string names;
  for (const Material& material : kMaterials) names += fmt::format(" {}", material.name);
  throw std::invalid_argument(fmt::format(
      "{} is neither a density in kg/m^3 nor one of the materials:{}", Quoted(text), names));
}

BodyMass WeighBody(const CadAssembly& assembly, const CadBody& body,
                   const DensityOptions& options) {
  BodyMass result;
  MassProperties& sum = result.mass_properties;
  Matrix3d about_origin = Matrix3d::Zero();
  Vector3d first = Vector3d::Zero();
  for (const int p : body.parts) {
    const CadShape& shape = assembly.shapes[assembly.parts[p].shape];
    BodyMass::Part part;
    part.part = p;
    part.name = assembly.parts[p].name;
    part.volume = shape.volume.volume;
    SetDensity(shape, body.name, options, &part);
    if (!shape.defect.empty()) {
      result.defects.push_back(fmt::format("part {} {}", Quoted(part.name), shape.defect));
    }
    const Posed X_LP = body.X_WL.inverse() * assembly.parts[p].X_WP;
    const Vector3d p_LoPcm = X_LP * shape.volume.p_PoPcm;
    const double mass = part.density * part.volume;
    sum.mass += mass;
    first += mass * p_LoPcm;
    about_origin += InertiaAboutPoint(part.density * RotatedInertia(X_LP.R, shape.volume.moments),
                                      mass, p_LoPcm);
    result.parts.push_back(part);
  }
  if (sum.mass > 0) {
    sum.p_LoLcm = first / sum.mass;
    sum.I_Lcm = InertiaAboutCenterOfGravity(about_origin, sum.mass, sum.p_LoLcm);
  }
  return result;
}

}  // namespace vmech
