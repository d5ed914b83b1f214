#include "vmech/mechanisms/expressions/parameter_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <type_traits>
#include <utility>

namespace vmech {
namespace {

Quantity<double> Converted(const Quantity<Dual>& q, double /*kind*/) {
  return {q.figure.value, q.unit, q.bare, q.radians};
}
Quantity<Dual> Converted(const Quantity<Dual>& q, const Dual& /*kind*/) {
  return q;
}

}  // namespace

int ParameterTable::Find(std::string_view name) const {
  for (size_t i = 0; i < entries_.size(); ++i) {
    if (entries_[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

std::vector<std::string> ParameterTable::names() const {
  std::vector<std::string> names;
  for (const Entry& entry : entries_) names.push_back(entry.name);
  return names;
}

const PlacedExpression& ParameterTable::holding(int parameter) const {
  const Entry& entry = entries_[parameter];
  return entry.set ? *entry.set : entry.declared;
}

void ParameterTable::Declare(std::string name, PlacedExpression expression) {
  entries_.push_back({std::move(name), std::move(expression), {}, {}, {}});
}

void ParameterTable::Set(int parameter, PlacedExpression expression) {
  entries_[parameter].set = std::move(expression);
}

void ParameterTable::Fix(int parameter, std::optional<PlacedValue> value) {
  entries_[parameter].fixed = std::move(value);
}

void ParameterTable::NoteUse(std::string_view name, const Unit& asked) {
  const int parameter = Find(name);
  if (parameter < 0) return;
  Entry& entry = entries_[parameter];
  entry.several_uses |= entry.use && !(entry.use->dimension == asked.dimension);
  if (!entry.use) entry.use = asked;
}

bool ParameterTable::learned() const {
  return std::any_of(entries_.begin(), entries_.end(), [](const Entry& entry) {
    const bool quantity =
        entry.bare && entry.use && !entry.several_uses && !entry.use->dimension.none();
    return quantity != entry.unit_from_use;
  });
}

/// A walk through the expressions, each after those that it needs.
template <typename T>
class ParameterTable::Resolution {
 public:
  /// Without `settings` as declared: the units in which settings count.
  Resolution(ParameterTable* table, const NamedQuantities<T>* declared,
             std::vector<FileError>* errors)
      : table_(table), declared_(declared), errors_(errors), states_(table->entries_.size()) {}

  NamedQuantities<T> Run() {
    for (int i = 0; i < table_->size(); ++i) Visit(i);
    return std::move(values_);
  }

 private:
  enum class State { kNew, kOpen, kDone };

  void Report(const FileError& place, std::string message) {
    FileError error = place;
    error.message = std::move(message);
    errors_->push_back(std::move(error));
  }

  const PlacedExpression& ExpressionOf(int i) const {
    return declared_ != nullptr ? table_->holding(i) : table_->declared(i);
  }

  void Visit(int i) {
    if (states_[i] != State::kNew) return;
    states_[i] = State::kOpen;
    path_.push_back(i);
    const Entry& entry = table_->entries_[i];
    const bool fixed = declared_ != nullptr && entry.fixed;
    if (fixed || NeedsHaveValues(ExpressionOf(i))) Evaluate(i, fixed);
    path_.pop_back();
    states_[i] = State::kDone;
  }

  /// Visits what an expression needs. False if something has no value, which is reported there.
  bool NeedsHaveValues(const PlacedExpression& needing) {
    bool all = true;
    for (const std::string& name : needing.expression.names()) {
      const int need = table_->Find(name);
      if (need < 0) {
        Report(needing.place, fmt::format("there is no parameter {}{}", Quoted(name),
                                          DidYouMean(name, table_->names())));
      } else if (states_[need] == State::kOpen) {
        Report(needing.place, "the parameter needs its own value: " + Circle(need));
      } else {
        Visit(need);
      }
      all &= values_.contains(name);
    }
    return all;
  }

  /// "a -> b -> a".
  std::string Circle(int begin) const {
    std::string words;
    const auto first = std::find(path_.begin(), path_.end(), begin);
    for (auto i = first; i != path_.end(); ++i) words += table_->name(*i) + " -> ";
    return words + table_->name(begin);
  }

  void Evaluate(int i, bool fixed) {
    Entry& entry = table_->entries_[i];
    const PlacedExpression& source = ExpressionOf(i);
    try {
      Quantity<T> value = fixed ? Converted(entry.fixed->value, T())
                                : source.expression.template Evaluate<T>(values_, source.units);
      if (fixed || (declared_ != nullptr && entry.set)) TakeDeclaredUnit(entry.name, &value);
      TakeUnitOfUse(&entry, &value);
      FigureIn(value, value.unit);
      values_.emplace(entry.name, value);
    } catch (const ExpressionError& error) {
      if (fixed) return Report(entry.fixed->place, error.what());
      Report(source.place, fmt::format("{}: {}", Quoted(source.expression.text()), error.what()));
    }
  }

  void TakeDeclaredUnit(const std::string& name, Quantity<T>* value) const {
    const auto declared = declared_->find(name);
    if (declared == declared_->end() || declared->second.bare) return;
    const Unit& unit = declared->second.unit;
    if (!value->bare && !(value->unit.dimension == unit.dimension)) {
      throw ExpressionError(fmt::format("{}, and {} is {}", OneOf(value->unit.dimension), name,
                                        OneOf(unit.dimension)));
    }
    if (value->bare) *value = {FigureIn(*value, unit), unit, false, false};
  }

  static void TakeUnitOfUse(Entry* entry, Quantity<T>* value) {
    entry->bare = value->bare;
    entry->unit_from_use =
        value->bare && entry->use && !entry->several_uses && !entry->use->dimension.none();
    if (entry->unit_from_use) {
      *value = {FigureIn(*value, *entry->use), *entry->use, false, false};
    }
  }

  ParameterTable* table_;
  const NamedQuantities<T>* declared_;
  std::vector<FileError>* errors_;
  std::vector<State> states_;
  std::vector<int> path_;
  NamedQuantities<T> values_;
};

template <typename T>
NamedQuantities<T> ParameterTable::Resolve(std::vector<FileError>* errors) {
  const bool set = std::any_of(entries_.begin(), entries_.end(),
                               [](const Entry& entry) { return entry.set || entry.fixed; });
  for (Entry& entry : entries_) entry.bare = entry.unit_from_use = false;
  const size_t before = errors->size();
  const NamedQuantities<T> declared = Resolution<T>(this, nullptr, errors).Run();
  if (!set || errors->size() > before) return declared;
  return Resolution<T>(this, &declared, errors).Run();
}

template NamedQuantities<double> ParameterTable::Resolve(std::vector<FileError>*);
template NamedQuantities<Dual> ParameterTable::Resolve(std::vector<FileError>*);

}  // namespace vmech
