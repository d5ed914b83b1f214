#pragma once

#include <string_view>

namespace vmech {

/// Throws std::invalid_argument "<where>.<name> = <value>, must be in [low, high]" unless it is;
/// NaN never is.
void CheckRange(std::string_view where, std::string_view name, double value, double low,
                double high);

}  // namespace vmech
