#include "vmech/base/check_range.h"

#include <fmt/format.h>

#include <stdexcept>

namespace vmech {

void CheckRange(std::string_view where, std::string_view name, double value, double low,
                double high) {
  if (value >= low && value <= high) return;
  throw std::invalid_argument(
      fmt::format("{}.{} = {}, must be in [{}, {}]", where, name, value, low, high));
}

}  // namespace vmech
