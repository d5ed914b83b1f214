#pragma once

#include <cmath>
#include <cstddef>
#include <type_traits>
#include <utility>
#include <vector>

#include "vmech/base/eigen.h"
#include "vmech/base/lanes.h"

namespace vmech {

/// Whether it is zero in every lane.
inline bool AllZero(double number) {
  return number == 0;
}

/// What was computed, operation by operation, with the derivative of each by its operands: swept
/// backwards it gives the derivatives of one result by every number that it came of, in the time
/// of a few evaluations [Griewank & Walther 2008, ch. 3]. N is double, or Lanes4 (lanes4.h).
template <typename N>
class TapeOf {
 public:
  /// Numbers on the tape; entry 0 stands for all that are constants.
  int size() const { return size_; }
  /// A variable, which comes of nothing.
  int AddVariable() { return Add(0, N(0), 0, N(0)); }
  /// What came of a and b, with its derivatives by them; 0 if it does not depend on them.
  int Record(int a, const N& by_a, int b, const N& by_b) {
    if (paused_) return 0;
    if (a != 0 && AllZero(by_a)) a = 0;
    if (b != 0 && AllZero(by_b)) b = 0;
    return a == 0 && b == 0 ? 0 : Add(a, by_a, b, by_b);
  }
  /// While it pauses all results are constants.
  void Pause(bool pauses) { paused_ = pauses; }
  /// Forgets all behind the first `size` numbers.
  void Rewind(int size) { size_ = size; }

  /// Adds to the derivative of a result by a number. Where a Sweep begins: of the result itself 1.
  void Seed(int index, const N& by) {
    MakeRoom();
    adjoints_[static_cast<size_t>(index)] += by;
  }
  /// The derivative of the result by a number, which is zero again; of a constant it is zero.
  N Take(int index) {
    return index == 0 ? N(0) : std::exchange(adjoints_[static_cast<size_t>(index)], N(0));
  }
  /// Takes the derivatives by all numbers from `first` on to those that they came of.
  void Sweep(int first) {
    MakeRoom();
    N* const adjoints = adjoints_.data();
    for (size_t i = static_cast<size_t>(size_); i-- > static_cast<size_t>(first);) {
      const N by = adjoints[i];
      adjoints[i] = N(0);
      adjoints[operands_[i].a] += Product(slopes_[i].by_a, by);
      adjoints[operands_[i].b] += Product(slopes_[i].by_b, by);
    }
  }

 private:
  struct Operands {
    int a = 0, b = 0;
  };
  struct Slopes {
    N by_a, by_b;
  };

  void MakeRoom() {
    if (adjoints_.size() < operands_.size()) adjoints_.resize(operands_.size(), N(0));
  }
  /// Of what was not selected the slope may be infinite, which is no matter.
  static N Product(const N& slope, const N& by) {
    using std::abs;
    return Select(abs(by) <= N(0), N(0), N(slope * by));
  }
  int Add(int a, const N& by_a, int b, const N& by_b) {
    const auto index = static_cast<size_t>(size_);
    if (index == operands_.size()) {
      operands_.resize(2 * index);
      slopes_.resize(2 * index);
    }
    operands_[index] = {a, b};
    slopes_[index] = {by_a, by_b};
    return size_++;
  }

  std::vector<Operands> operands_ = std::vector<Operands>(1024);
  std::vector<Slopes> slopes_ = std::vector<Slopes>(1024);
  std::vector<N> adjoints_;
  int size_ = 1;
  bool paused_ = false;
};

/// A number whose operations are put on a tape. As the number T of the kernels it takes them
/// through the same lines as the value. Comparisons look at the values.
template <typename N>
struct TapedOf {
  N value = 0;                ///< of the function
  TapeOf<N>* tape = nullptr;  ///< must outlive it; null for a constant
  int index = 0;              ///< on the tape; 0 for a constant

  TapedOf() = default;
  /// A constant.
  TapedOf(double constant) : value(constant) {}  // NOLINT: numbers mix with taped ones
  /// A number on the tape.
  TapedOf(const N& value, TapeOf<N>* tape, int index) : value(value), tape(tape), index(index) {}
  /// A constant of a number with lanes.
  template <typename M>
  requires(std::is_same_v<M, N> && !std::is_same_v<M, double>) explicit TapedOf(const M& constant)
      : value(constant) {}

  /// A constant, `number(lane)` in each lane.
  template <typename Number>
  static TapedOf Of(const Number& number) {
    return TapedOf(N::Of(number));
  }
  /// A new variable of the tape.
  static TapedOf Variable(const N& value, TapeOf<N>* tape) {
    return {value, tape, tape->AddVariable()};
  }

  TapedOf operator-() const { return Recorded(-value, *this, N(-1)); }  ///< recorded
  TapedOf& operator+=(const TapedOf& b) { return *this = *this + b; }   ///< recorded
  TapedOf& operator-=(const TapedOf& b) { return *this = *this - b; }   ///< recorded
  TapedOf& operator*=(const TapedOf& b) { return *this = *this * b; }   ///< recorded
  TapedOf& operator/=(const TapedOf& b) { return *this = *this / b; }   ///< recorded
  /// Recorded, unless one of them is a constant: then it has the derivatives of the other.
  friend TapedOf operator+(const TapedOf& a, const TapedOf& b) {
    if (b.index == 0) return {a.value + b.value, a.tape, a.index};
    if (a.index == 0) return {a.value + b.value, b.tape, b.index};
    return Recorded(a.value + b.value, a, N(1), b, N(1));
  }
  /// Recorded, unless a constant is subtracted.
  friend TapedOf operator-(const TapedOf& a, const TapedOf& b) {
    if (b.index == 0) return {a.value - b.value, a.tape, a.index};
    return Recorded(a.value - b.value, a, N(1), b, N(-1));
  }
  /// The product rule.
  friend TapedOf operator*(const TapedOf& a, const TapedOf& b) {
    return Recorded(a.value * b.value, a, b.value, b, a.value);
  }
  /// The quotient rule; infinite or NaN where b's value is zero.
  friend TapedOf operator/(const TapedOf& a, const TapedOf& b) {
    const N ratio = a.value / b.value;
    return Recorded(ratio, a, N(1) / b.value, b, -ratio / b.value);
  }
  /// Of values and places: where Eigen looks for a factor of zero or one.
  friend bool operator==(const TapedOf& a, const TapedOf& b) {
    return a.index == b.index && a.value == b.value;
  }
  /// Of values alone.
  friend auto operator<(const TapedOf& a, const TapedOf& b) { return a.value < b.value; }
  /// Of values alone.
  friend auto operator>(const TapedOf& a, const TapedOf& b) { return a.value > b.value; }
  /// Of values alone.
  friend auto operator<=(const TapedOf& a, const TapedOf& b) { return a.value <= b.value; }

  /// Of `a` where the condition holds, else of `b`.
  template <typename Condition>
  friend TapedOf Select(const Condition& condition, const TapedOf& a, const TapedOf& b) {
    const N one(1), zero(0);
    return Recorded(Select(condition, a.value, b.value), a, Select(condition, one, zero), b,
                    Select(condition, zero, one));
  }
  /// Slope as of a at zero.
  friend TapedOf abs(const TapedOf& a) {
    const N sign = Select(a.value < N(0), N(-1), N(1));
    return Recorded(sign * a.value, a, sign);
  }
  /// With the slope of the lesser; a's if equal.
  friend TapedOf min(const TapedOf& a, const TapedOf& b) { return Select(b < a, b, a); }
  /// With the slope of the greater; a's if equal.
  friend TapedOf max(const TapedOf& a, const TapedOf& b) { return Select(a < b, b, a); }
  /// Slope 0 at zero, where there is none.
  friend TapedOf sqrt(const TapedOf& a) {
    using std::sqrt;
    const N root = sqrt(a.value), zero(0);
    return Recorded(root, a, Select(root > zero, N(N(0.5) / root), zero));
  }
  /// The exponent is a constant.
  friend TapedOf pow(const TapedOf& a, double exponent) {
    using std::pow;
    return Recorded(pow(a.value, exponent), a, exponent * pow(a.value, exponent - 1));
  }
  /// A constant: steps are not differentiated.
  friend TapedOf round(const TapedOf& a) {
    using std::round;
    return {round(a.value), nullptr, 0};
  }
  /// In (-pi, pi]. Slope 0 at the origin, where there is none.
  friend TapedOf atan2(const TapedOf& y, const TapedOf& x) {
    using std::atan2;
    const N square = x.value * x.value + y.value * y.value, zero(0);
    const N share = Select(square > zero, N(N(1) / square), zero);
    return Recorded(atan2(y.value, x.value), y, x.value * share, x, -y.value * share);
  }
  /// Both at once; `angle` in radians.
  friend void SinCos(const TapedOf& angle, TapedOf* sine, TapedOf* cosine) {
    N s, c;
    SinCos(angle.value, &s, &c);
    *sine = Recorded(s, angle, c);
    *cosine = Recorded(c, angle, -s);
  }

 private:
  static TapedOf Recorded(const N& value, const TapedOf& a, const N& by_a, const TapedOf& b,
                          const N& by_b) {
    TapeOf<N>* const tape = a.index != 0 ? a.tape : b.tape;
    if (a.index == 0 && b.index == 0) return {value, nullptr, 0};
    return {value, tape, tape->Record(a.index, by_a, b.index, by_b)};
  }
  static TapedOf Recorded(const N& value, const TapedOf& a, const N& by_a) {
    if (a.index == 0) return {value, nullptr, 0};
    return {value, a.tape, a.tape->Record(a.index, by_a, 0, N(0))};
  }
};

/// A number on a tape.
using Taped = TapedOf<double>;

/// Whether T is a number on a tape.
template <typename T>
inline constexpr bool kIsTaped = false;
/// It is.
template <typename N>
inline constexpr bool kIsTaped<TapedOf<N>> = true;

/// As many as its value has.
template <typename N>
inline constexpr int kLanesOf<TapedOf<N>> = kLanesOf<N>;
/// The value alone, of one lane.
template <typename N>
double Lane(const TapedOf<N>& number, int lane) {
  return Lane(number.value, lane);
}
/// The value alone, which is not recorded: to look at, not to compute with.
template <typename N>
TapedOf<N> Constant(const TapedOf<N>& number) {
  return {number.value, nullptr, 0};
}

/// Any other number as it is.
template <typename T>
const T& Constant(const T& number) {
  return number;
}

}  // namespace vmech

/// @cond
template <typename N>
struct Eigen::NumTraits<vmech::TapedOf<N>> : Eigen::GenericNumTraits<vmech::TapedOf<N>> {
  using Real = vmech::TapedOf<N>;
  using NonInteger = vmech::TapedOf<N>;
  using Nested = vmech::TapedOf<N>;
  using Literal = double;
  enum {
    IsInteger = 0,
    IsSigned = 1,
    IsComplex = 0,
    RequireInitialization = 1,
    ReadCost = 2,
    AddCost = 4,
    MulCost = 4,
  };
};

// Numbers mix with taped ones in expressions.
template <typename N, typename Operation>
struct Eigen::ScalarBinaryOpTraits<double, vmech::TapedOf<N>, Operation> {
  using ReturnType = vmech::TapedOf<N>;
};
template <typename N, typename Operation>
struct Eigen::ScalarBinaryOpTraits<vmech::TapedOf<N>, double, Operation> {
  using ReturnType = vmech::TapedOf<N>;
};
/// @endcond
