#pragma once

#include <array>
#include <cstddef>

namespace vmech {

/// Numbers that lie in somebody else's memory, as numpy and C describe them.
struct NumberArray {
  static constexpr size_t kMaxRank = 4;

  const double* data = nullptr;  ///< null where there is no such array
  size_t rank = 0;
  std::array<size_t, kMaxRank> shape{};
  std::array<ptrdiff_t, kMaxRank> strides{};  ///< [bytes] from one to the next along each index
};

}  // namespace vmech
