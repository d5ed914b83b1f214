#pragma once

#include <vector>

namespace vmech {

/// What the accelerations of a table of motion are made of, root mean squares over its rows.
struct TableRoughness {
  double acceleration = 0;  ///< by second differences of the values [unit of the values/s^2]
  double noise = 0;         ///< of it, what the figures' scatter alone would give [the same]
};

/// The scatter of the figures is how far each is off the cubic through the two rows before and the
/// two behind it: rounding, or kinks. A motion that is sampled densely enough for a spline has
/// none. Zero for tables of fewer than 8 rows. Times increase.
TableRoughness FindRoughness(const std::vector<double>& times, const std::vector<double>& values);

}  // namespace vmech
