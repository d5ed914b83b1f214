#pragma once

#include <cmath>
#include <cstddef>
#include <cstring>

#include "vmech/base/eigen.h"
#include "vmech/base/lanes.h"

namespace vmech {

/// Four numbers that are computed with at once. As the scalar T of the kernels it takes four
/// poses through the same lines in the time of about one. Lane k of every result depends on lane k
/// of the operands alone. What decides by value does so lane by lane, with Select.
///
/// How they are passed depends on the instruction set: code that includes this header must be
/// compiled for the same one as the library (VMECH_ARCH).
class Lanes4 {
  using Lanes = double __attribute__((vector_size(32)));

 public:
  static constexpr int kLanes = 4;
  /// Per lane all ones or zero: what a comparison gives.
  using Mask = long __attribute__((vector_size(32)));

  Lanes4() = default;
  Lanes4(double value) : lanes_{value, value, value, value} {}  // NOLINT: numbers mix with packets
  /// `number(lane)` in each lane.
  template <typename Number>
  static Lanes4 Of(const Number& number) {
    return Lanes4(Lanes{number(0), number(1), number(2), number(3)});
  }

  double operator[](int lane) const { return lanes_[lane]; }

  Lanes4 operator-() const { return Lanes4(-lanes_); }
  Lanes4& operator+=(const Lanes4& b) { return *this = *this + b; }
  Lanes4& operator-=(const Lanes4& b) { return *this = *this - b; }
  Lanes4& operator*=(const Lanes4& b) { return *this = *this * b; }
  Lanes4& operator/=(const Lanes4& b) { return *this = *this / b; }
  friend Lanes4 operator+(const Lanes4& a, const Lanes4& b) { return Lanes4(a.lanes_ + b.lanes_); }
  friend Lanes4 operator-(const Lanes4& a, const Lanes4& b) { return Lanes4(a.lanes_ - b.lanes_); }
  friend Lanes4 operator*(const Lanes4& a, const Lanes4& b) { return Lanes4(a.lanes_ * b.lanes_); }
  friend Lanes4 operator/(const Lanes4& a, const Lanes4& b) { return Lanes4(a.lanes_ / b.lanes_); }
  friend Mask operator<(const Lanes4& a, const Lanes4& b) { return a.lanes_ < b.lanes_; }
  friend Mask operator>(const Lanes4& a, const Lanes4& b) { return a.lanes_ > b.lanes_; }
  friend Mask operator<=(const Lanes4& a, const Lanes4& b) { return a.lanes_ <= b.lanes_; }

  /// a where the mask is set, b elsewhere.
  friend Lanes4 Select(const Mask& mask, const Lanes4& a, const Lanes4& b) {
    return Lanes4(mask ? a.lanes_ : b.lanes_);
  }
  friend Lanes4 abs(const Lanes4& a) {
    constexpr long kAllButSign = 0x7fffffffffffffff;
    return Lanes4(Lanes(Mask(a.lanes_) & kAllButSign));
  }
  friend Lanes4 min(const Lanes4& a, const Lanes4& b) { return Select(b < a, b, a); }
  friend Lanes4 max(const Lanes4& a, const Lanes4& b) { return Select(a < b, b, a); }
  friend Lanes4 sqrt(const Lanes4& a) {
    return Of([&](int lane) { return std::sqrt(a[lane]); });
  }
  friend Lanes4 round(const Lanes4& a) {
    return Of([&](int lane) { return std::round(a[lane]); });
  }
  /// The lanes moved up by one: (first, a[0], a[1], a[2]).
  friend Lanes4 ShiftIn(double first, const Lanes4& a) {
    return Of([&](int lane) { return lane == 0 ? first : a[lane - 1]; });
  }

 private:
  explicit Lanes4(const Lanes& lanes) : lanes_(lanes) {}

  Lanes lanes_;
};

/// Within 1e-16 of sine and cosine up to 1e5 rad; beyond, those of the standard library.
void SinCos(const Lanes4& angle, Lanes4* sine, Lanes4* cosine);
/// The angle of (x, y), -pi to pi, within 5e-16; 0 for (0, 0).
Lanes4 atan2(const Lanes4& y, const Lanes4& x);

inline bool AllLanes(const Lanes4::Mask& mask) {
  return (mask[0] & mask[1] & mask[2] & mask[3]) != 0;
}
template <>
inline constexpr int kLanesOf<Lanes4> = Lanes4::kLanes;
inline double Lane(const Lanes4& value, int lane) {
  return value[lane];
}

/// Four packets at a time, transposed in registers.
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

template <>
struct Eigen::NumTraits<vmech::Lanes4> : Eigen::GenericNumTraits<vmech::Lanes4> {
  using Real = vmech::Lanes4;
  using NonInteger = vmech::Lanes4;
  using Nested = vmech::Lanes4;
  using Literal = double;
  enum {
    IsInteger = 0,
    IsSigned = 1,
    IsComplex = 0,
    RequireInitialization = 0,
    ReadCost = 1,
    AddCost = 1,
    MulCost = 1,
  };
};

// Lanes4 bring their alignment with them; Eigen would ask for the less that numbers need.
template <int size>
struct Eigen::internal::compute_default_alignment<vmech::Lanes4, size> {
  enum { value = 0 };
};
template <>
struct Eigen::internal::compute_default_alignment<vmech::Lanes4, Eigen::Dynamic> {
  enum { value = EIGEN_MAX_ALIGN_BYTES };
};

// Numbers mix with packets in expressions.
template <typename Operation>
struct Eigen::ScalarBinaryOpTraits<double, vmech::Lanes4, Operation> {
  using ReturnType = vmech::Lanes4;
};
template <typename Operation>
struct Eigen::ScalarBinaryOpTraits<vmech::Lanes4, double, Operation> {
  using ReturnType = vmech::Lanes4;
};
