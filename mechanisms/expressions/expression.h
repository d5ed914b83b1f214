#pragma once

#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "vmech/mechanisms/expressions/quantity.h"

namespace vmech {

/// What the names in expressions stand for.
template <typename T>
using NamedQuantities = std::unordered_map<std::string, Quantity<T>>;

/// A formula in numbers, units, names, pi, + - * / ^, parentheses and the functions sqrt sin cos
/// tan asin acos atan2 abs min max. '^' binds closest, and to the right; a unit belongs to the
/// number before it, so that 1/2 mm is one over two millimetres.
class Expression {
 public:
  /// @throws ExpressionError: what is wrong, and what to write instead.
  explicit Expression(std::string_view text);

  const std::string& text() const { return text_; }  ///< as it was given
  /// The names in it, each once, in the order in which they first stand there.
  const std::vector<std::string>& names() const { return names_; }
  /// The name of which it is all, but for a sign; else empty.
  const std::string& lone_name() const { return lone_name_; }

  /// @throws ExpressionError if it has no value. All its names must have one.
  template <typename T>
  Quantity<T> Evaluate(const NamedQuantities<T>& names, const CountingUnits& units) const;

  /// One thing to do with a stack of quantities.
  struct Step {
    /// Which of the following counts.
    enum class Kind { kNumber, kUnit, kName, kNegative, kSum, kProduct, kRatio, kPower, kCall };
    Kind kind = Kind::kNumber;  ///< what is done
    double number = 0;          ///< kNumber
    bool pi = false;            ///< kNumber
    Unit unit;                  ///< kUnit
    std::string name;           ///< kName, kCall
  };

 private:
  std::string text_, lone_name_;
  std::vector<std::string> names_;
  std::vector<Step> steps_;
};

/// What a parameter cannot be called, with the reason; empty if it can: a name begins with a letter
/// and is neither a unit nor a function.
std::string NameDefect(std::string_view name);

}  // namespace vmech
