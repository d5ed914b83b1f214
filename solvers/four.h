#pragma once

namespace vmech {

/// Four numbers of a column, computed with at once.
using Four = double __attribute__((vector_size(32)));

/// The size of a column that is filled up to whole registers.
constexpr int PaddedSize(int size) {
  return (size + 3) / 4 * 4;
}

}  // namespace vmech
