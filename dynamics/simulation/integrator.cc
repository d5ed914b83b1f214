#include "vmech/dynamics/simulation/integrator.h"

#include <stdexcept>

#include "vmech/base/late_library.h"

namespace vmech {
namespace {

IntegratorMaker MakerIn(const LateLibrary& library) {
  if (!library.loaded()) {
    throw std::runtime_error(library.error() +
                             "; it is there if vmech is built where libsundials-dev is installed");
  }
  return library.Variable<IntegratorMaker>("vmech_make_integrator");
}

}  // namespace

std::unique_ptr<Integrator> MakeIntegrator(const InitialValueProblem& problem,
                                           SimulationMethod method) {
  if (method == SimulationMethod::kIdas) {
    static const LateLibrary idas("idas");
    return MakerIn(idas)(problem, method);
  }
  static const LateLibrary cvodes("cvodes");
  return MakerIn(cvodes)(problem, method);
}

}  // namespace vmech
