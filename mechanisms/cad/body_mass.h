#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "vmech/mechanisms/cad/bodies.h"
#include "vmech/mechanisms/mechanism.h"

namespace vmech {

/// The density of a part whose material nobody names.
constexpr double kUsualDensity = 7850;  ///< [kg/m^3]: steel

/// Where densities come from, in this order: the user's word for a part, a product, a body or a
/// material; the density in the file; the table of materials by the name in the file; the default.
struct DensityOptions {
  /// Name (of a part, product, body or material) and density [kg/m^3], 1e-3..1e5.
  std::vector<std::pair<std::string, double>> by_name;
  /// The density of everything else [kg/m^3], 1e-3..1e5; none: kUsualDensity, reported as assumed.
  std::optional<double> fallback;

  /// @throws std::invalid_argument naming the density that is out of its range.
  void Validate() const;
};

/// A density from a number or from the name of a material ("steel", "aluminium", "pla"...).
/// @throws std::invalid_argument naming the materials that are known.
double DensityFromText(const std::string& text);

/// Mass properties of a body in its axes L, and where they come from, part by part.
struct BodyMass {
  MassProperties mass_properties;  ///< in the body's axes L
  /// A part's share of the mass of a body.
  struct Part {
    int part = -1;         ///< index in CadAssembly
    std::string name;      ///< as the file calls it
    double volume = 0;     ///< [m^3]
    double density = 0;    ///< [kg/m^3]
    std::string source;    ///< of the density
    bool assumed = false;  ///< nobody stated the density
  };
  std::vector<Part> parts;           ///< in the order of the assembly
  std::vector<std::string> defects;  ///< of its parts, in words
};

/// I_L = sum over the parts of density (R moments R' + volume (p.p 1 - p p')), p from the common
/// centre of gravity to that of the part.
BodyMass WeighBody(const CadAssembly& assembly, const CadBody& body, const DensityOptions& options);

}  // namespace vmech
