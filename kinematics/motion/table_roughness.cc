#include "vmech/kinematics/motion/table_roughness.h"

#include <array>
#include <cmath>

namespace vmech {
namespace {

/// Row i less the cubic through its four neighbours, as a factor of each of the five rows
/// (Lagrange).
std::array<double, 5> OffCubic(const double* t) {
  std::array<double, 5> weights{0, 0, 1, 0, 0};
  for (int j : {0, 1, 3, 4}) {
    double w = 1;
    for (int k : {0, 1, 3, 4}) {
      if (k != j) w *= (t[2] - t[k]) / (t[j] - t[k]);
    }
    weights[j] = -w;
  }
  return weights;
}

/// The second derivative of the parabola through three rows, as a factor of each of them.
std::array<double, 3> SecondDifference(const double* t) {
  const double before = t[1] - t[0], after = t[2] - t[1], both = t[2] - t[0];
  return {2 / (before * both), -2 / (before * after), 2 / (after * both)};
}

template <size_t size>
double Dot(const std::array<double, size>& weights, const double* x) {
  double sum = 0;
  for (size_t k = 0; k < size; ++k) sum += weights[k] * x[k];
  return sum;
}

template <size_t size>
double Squares(const std::array<double, size>& weights) {
  return Dot(weights, weights.data());
}

}  // namespace

TableRoughness FindRoughness(const std::vector<double>& times, const std::vector<double>& values) {
  constexpr size_t kFewest = 8;
  const size_t rows = times.size();
  if (rows < kFewest) return {};
  double scatter = 0, acceleration = 0, gain = 0;
  for (size_t i = 2; i + 2 < rows; ++i) {
    const auto off = OffCubic(&times[i - 2]);
    const auto second = SecondDifference(&times[i - 1]);
    const double residual = Dot(off, &values[i - 2]), a = Dot(second, &values[i - 1]);
    scatter += residual * residual / Squares(off);
    acceleration += a * a;
    gain += Squares(second);
  }
  const double windows = static_cast<double>(rows - 4);
  return {std::sqrt(acceleration / windows), std::sqrt(scatter / windows * gain / windows)};
}

}  // namespace vmech
