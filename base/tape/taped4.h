#pragma once

#include "vmech/base/lanes4.h"
#include "vmech/base/tape/tape.h"

namespace vmech {

/// Four numbers that are computed with at once, on a tape.
using Taped4 = TapedOf<Lanes4>;

inline bool AllZero(const Lanes4& number) {
  return AllLanes(abs(number) <= Lanes4(0));
}

}  // namespace vmech

// As those of Lanes4.
template <int size>
struct Eigen::internal::compute_default_alignment<vmech::Taped4, size> {
  enum { value = 0 };
};
template <>
struct Eigen::internal::compute_default_alignment<vmech::Taped4, Eigen::Dynamic> {
  enum { value = EIGEN_MAX_ALIGN_BYTES };
};
