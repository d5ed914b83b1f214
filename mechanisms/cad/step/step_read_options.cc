#include "vmech/mechanisms/cad/step/step_read_options.h"

#include <fmt/format.h>

#include <stdexcept>

namespace vmech {

void StepReadOptions::Validate() const {
  const bool in_range = mesh_deflection == 0 || (mesh_deflection >= 1e-7 && mesh_deflection <= 1);
  if (!in_range) {
    throw std::invalid_argument(fmt::format(
        "StepReadOptions: mesh_deflection [m] = {} is not 0 or 1e-7..1", mesh_deflection));
  }
}

}  // namespace vmech
