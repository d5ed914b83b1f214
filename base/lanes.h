#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "vmech/base/eigen.h"

namespace vmech {

// The words by which kernels speak of a number T that may have lanes (Lanes4): here for a single
// number, a lane of its own.

/// `a` where the condition holds, else `b`.
inline double Select(bool condition, double a, double b) {
  return condition ? a : b;
}
/// Sine and cosine of an angle [rad].
inline void SinCos(double angle, double* sine, double* cosine) {
  *sine = std::sin(angle);
  *cosine = std::cos(angle);
}

/// Whether a condition holds in every lane.
inline bool AllLanes(bool condition) {
  return condition;
}

/// How many lanes a number T has.
template <typename T>
inline constexpr int kLanesOf = 1;

/// The number itself, which is its only lane.
inline double Lane(double value, int /*lane*/) {
  return value;
}
/// One lane of a vector or matrix.
template <typename T, int rows, int columns>
Eigen::Matrix<double, rows, columns> Lane(const Eigen::Matrix<T, rows, columns>& value, int lane) {
  Eigen::Matrix<double, rows, columns> one;
  for (int i = 0; i < rows * columns; ++i) one(i) = Lane(value(i), lane);
  return one;
}

/// T made of `number(lane)` for each of its lanes.
template <typename T, typename Number>
T FromLanes(const Number& number) {
  if constexpr (kLanesOf<T> == 1) {
    return number(0);
  } else {
    return T::Of(number);
  }
}

/// Writes values[0..count) of lane l to row + l * stride: a row for each lane.
inline void StoreLanes(const double* values, int count, double* row, ptrdiff_t /*stride*/) {
  std::copy_n(values, count, row);
}

}  // namespace vmech
