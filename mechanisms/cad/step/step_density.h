#pragma once

#include <optional>
#include <string>
#include <vector>

class Interface_InterfaceModel;

namespace vmech {

/// The density that a STEP file states of a product.
struct StatedDensity {
  int product = 0;  ///< number of the PRODUCT_DEFINITION in the model
  /// [kg/m^3]; none if its unit is not one of mass per volume, or it is not in 1e-3..1e5.
  std::optional<double> density;
  std::string trouble;  ///< why there is none: "7.85 in a unit that is no mass per volume"
};

/// All densities of a model, in the order of the file. A density is a measure whose item, whose
/// representation or whose property is called one ("density", "density measure", "mass density"),
/// in any unit that the file composes of masses, lengths and volumes: SI with prefixes, units by
/// conversion (pound, inch, litre), derived units (kg/m^3, g/mm^3). What Open CASCADE writes for
/// g/cm^3, which are "gram^3 cm^2", is taken for that.
std::vector<StatedDensity> FindDensities(const Interface_InterfaceModel& model);

}  // namespace vmech
