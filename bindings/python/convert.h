#pragma once

#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <optional>
#include <string>

#include "vmech/base/pose.h"
#include "vmech/bindings/shared/number_array.h"

namespace vmech::python {

namespace py = pybind11;

/// Numbers of Python's, converted and in one piece.
using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// @throws std::invalid_argument if there are not so many numbers.
void RequireCount(const char* name, const Numbers& numbers, py::ssize_t count);

inline Vector3d VectorOf(const char* name, const Numbers& numbers) {
  RequireCount(name, numbers, 3);
  return Eigen::Map<const Vector3d>(numbers.data());
}

inline Vector6d Vector6Of(const char* name, const Numbers& numbers) {
  RequireCount(name, numbers, 6);
  return Eigen::Map<const Vector6d>(numbers.data());
}

/// A pose from a position (3,) and a rotation (3, 3), the identity where there is none.
Posed PoseOf(const Numbers& position, const std::optional<Numbers>& rotation);

/// The numbers where they lie, read-only; `owner` is kept alive. None where there are none.
py::object ViewOf(const NumberArray& numbers, const py::object& owner);

/// A copy.
inline py::array_t<double> CopyOf(const Vector6d& numbers) {
  return py::array_t<double>(6, numbers.data());
}

/// The mechanism in a hand: Tick and the session with a master of Python's.
void BindHaptic(py::module_* module);

}  // namespace vmech::python
