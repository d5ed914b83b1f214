#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string_view>

namespace vmech {

/// @throws std::invalid_argument "simulated master: period = 3, must lie in [1e-05, 0.1]" unless
/// lower <= value <= upper; not-a-number lies nowhere.
inline void CheckRange(std::string_view subject, std::string_view name, double value, double lower,
                       double upper) {
  if (value >= lower && value <= upper) return;
  throw std::invalid_argument(
      fmt::format("{}: {} = {}, must lie in [{}, {}]", subject, name, value, lower, upper));
}

}  // namespace vmech
