#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>

#include "vmech/base/lanes4.h"

namespace vmech {

/// Writes values[0..count) of lane l to row + l * stride: a row for each lane.
inline void StoreLanes(const double* values, int count, double* row, ptrdiff_t /*stride*/) {
  std::copy_n(values, count, row);
}

/// Double4 packets at a time, transposed in registers.
inline void StoreLanes(const Lanes4* values, int count, double* row, ptrdiff_t stride) {
  using Lanes = double __attribute__((vector_size(32)));
  for (; count >= 4; count -= 4, values += 4, row += 4) {
    Lanes a, b, c, d;
    std::memcpy(&a, values, sizeof a);
    std::memcpy(&b, values + 1, sizeof b);
    std::memcpy(&c, values + 2, sizeof c);
    std::memcpy(&d, values + 3, sizeof d);
    const Lanes ab02 = __builtin_shufflevector(a, b, 0, 4, 2, 6);
    const Lanes ab13 = __builtin_shufflevector(a, b, 1, 5, 3, 7);
    const Lanes cd02 = __builtin_shufflevector(c, d, 0, 4, 2, 6);
    const Lanes cd13 = __builtin_shufflevector(c, d, 1, 5, 3, 7);
    const Lanes rows[] = {__builtin_shufflevector(ab02, cd02, 0, 1, 4, 5),
                          __builtin_shufflevector(ab13, cd13, 0, 1, 4, 5),
                          __builtin_shufflevector(ab02, cd02, 2, 3, 6, 7),
                          __builtin_shufflevector(ab13, cd13, 2, 3, 6, 7)};
    for (int lane = 0; lane < 4; ++lane) {
      std::memcpy(row + lane * stride, &rows[lane], sizeof(Lanes));
    }
  }
  for (int k = 0; k < count; ++k) {
    for (int lane = 0; lane < Lanes4::kLanes; ++lane) row[lane * stride + k] = values[k][lane];
  }
}

}  // namespace vmech
