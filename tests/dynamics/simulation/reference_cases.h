#pragma once

#include <functional>
#include <string>
#include <vector>

#include "vmech/dynamics/simulation/simulate.h"

namespace vmech {

/// What is known of a simulation better than by simulating it.
struct ReferenceValue {
  std::string what;
  size_t row = 0;  ///< of the result
  double expected = 0;
  double allowed = 0;  ///< error
  std::function<double(const SimulationResult& result, size_t row)> value;
};

/// A problem with a solution that was published, or found by other means.
struct ReferenceCase {
  std::string name;
  std::string source;
  Simulation simulation;
  double tolerance = 1e-10;  ///< of the integrator, relative and absolute
  double energy_error = 0;   ///< allowed, over the largest energy
  std::vector<ReferenceValue> values;
  SimulationMethod ends_by = SimulationMethod::kAdams;  ///< BDF where it proves stiff
};

std::vector<ReferenceCase> ReferenceCases();

/// The torque of 0.033 N m, the end at 30 ms.
Simulation AndrewsSqueezer();

/// N windows that fall from the upright, pushed by 1 rad/s.
Simulation FallingWindows(int count, const std::vector<double>& times);

/// A four-bar with a motor, a spring, a damper, friction and a force from outside, 0.8 s.
Simulation LoadedFourBar();

}  // namespace vmech
