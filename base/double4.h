#pragma once

namespace vmech {

/// Four numbers of a column, computed with at once. The alignment is that of plain `new` and of
/// the stack of a program without AVX, which would be another one for each instruction set if it
/// were not stated. Not for template arguments (std::vector<Double4>), where g++ forgets it: put it
/// in a struct.
using Double4 = double __attribute__((vector_size(32), aligned(16)));

/// The size of a column that is filled up to whole registers: the next multiple of four.
constexpr int PaddedSize(int size) {
  return (size + 3) / 4 * 4;
}

}  // namespace vmech
