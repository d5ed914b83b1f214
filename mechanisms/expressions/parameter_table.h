#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vmech/base/dual.h"
#include "vmech/mechanisms/expressions/expression.h"
#include "vmech/mechanisms/files/file_errors.h"

namespace vmech {

/// A parameter's value as it is set from outside of the file that declares it: an expression, as
/// text.
struct ParameterSetting {
  std::string name, text;  ///< of the parameter; the expression
};

/// An expression with the place where it stands and the units in which its bare numbers count.
struct PlacedExpression {
  Expression expression;  ///< as it was read
  CountingUnits units;    ///< of its bare numbers
  FileError place;        ///< without a message
};

/// A value of a parameter that came from elsewhere.
struct PlacedValue {
  Quantity<Dual> value;  ///< with a slope where derivatives are asked for
  FileError place;       ///< without a message
};

/// Named expressions that refer to each other, in any order.
///
/// A parameter whose value is a bare number, and which somewhere stands alone where the file asks
/// for a length, is a length in the unit asked there; it is learned from such uses. One that stands
/// where different dimensions are asked remains a number.
class ParameterTable {
 public:
  /// The index of the parameter; -1 if there is none of this name.
  int Find(std::string_view name) const;
  int size() const { return static_cast<int>(entries_.size()); }  ///< parameters that are declared
  /// The name of the parameter with this index.
  const std::string& name(int parameter) const { return entries_[parameter].name; }
  std::vector<std::string> names() const;  ///< in the order of their declaration
  /// The expression by which it is declared, and the one that holds: that which set it last, if
  /// any did.
  const PlacedExpression& declared(int parameter) const { return entries_[parameter].declared; }
  const PlacedExpression& holding(int parameter) const;  ///< as set last

  void Declare(std::string name, PlacedExpression expression);  ///< its index is size() before
  /// A bare number counts in the unit of the declaration; another dimension is refused.
  void Set(int parameter, PlacedExpression expression);
  /// The same by a value; with a slope where derivatives are asked for. None: as declared or set.
  void Fix(int parameter, std::optional<PlacedValue> value);

  /// Says that a parameter stands alone where a unit is asked for.
  void NoteUse(std::string_view name, const Unit& asked);
  /// Did a parameter become a quantity by the uses since the last Resolve?
  bool learned() const;

  /// The values of all, T double, or Dual with the slopes of those that are fixed. Where some have
  /// no value, what is wrong is added to `errors`, and those are left out.
  template <typename T>
  NamedQuantities<T> Resolve(std::vector<FileError>* errors);

 private:
  struct Entry {
    std::string name;
    PlacedExpression declared;
    std::optional<PlacedExpression> set;
    std::optional<PlacedValue> fixed;
    std::optional<Unit> use;  ///< asked where it stands alone
    bool several_uses = false;
    bool bare = false, unit_from_use = false;  ///< as it was last resolved
  };
  template <typename T>
  class Resolution;

  std::vector<Entry> entries_;
};

}  // namespace vmech
