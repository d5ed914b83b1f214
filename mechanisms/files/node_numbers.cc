// The numbers of a document: plain ones, and expressions.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <system_error>

#include "vmech/mechanisms/files/document.h"
#include "vmech/mechanisms/files/yaml/scalar_text.h"

namespace vmech {
namespace {

double ValueOf(double x) {
  return x;
}
double ValueOf(const Dual& x) {
  return x.value;
}

const NamedQuantities<double>& NamesOf(const ExpressionScope& scope, double /*kind*/) {
  return scope.values;
}
const NamedQuantities<Dual>& NamesOf(const ExpressionScope& scope, const Dual& /*kind*/) {
  return scope.slopes;
}

}  // namespace

std::optional<double> ParseNumber(std::string_view text) {
  if (!LooksLikeNumber(text)) return {};
  if (text[0] == '+') text.remove_prefix(1);
  double value = 0;
  const auto status = std::from_chars(text.data(), text.data() + text.size(), value).ec;
  if (status != std::errc() || !(std::abs(value) <= kMaxNumber)) return {};
  return value;
}

const Expression& Document::ExpressionOf(const Node& node, const Unit* asked) {
  const auto known = expressions_.find(node.index_);
  if (known != expressions_.end()) return known->second;
  const Expression expression(items_[node.index_].text);
  for (const std::string& name : expression.names()) {
    const bool alone = asked != nullptr && name == expression.lone_name();
    uses_.push_back({name, node.line(), node.path(), alone, alone ? *asked : Unit{}});
  }
  return expressions_.emplace(node.index_, expression).first->second;
}

// Node

bool Node::IsNumber() const {
  if (kind() != Kind::kScalar) return false;
  const DocumentItem& item = document_->items_[index_];
  return item.plain && ParseNumber(item.text).has_value();
}

std::string Node::ScalarText() const {
  return kind() == Kind::kScalar ? document_->items_[index_].text : std::string();
}

/// Says why a scalar that is neither a number nor an expression is none.
void Node::ReportNoNumber() const {
  const DocumentItem& item = document_->items_[index_];
  if (item.plain && IsNotFinite(item.text)) {
    Error("expected a finite number, not " + Quoted(item.text));
  } else if (item.plain && LooksLikeNumber(item.text)) {
    Error(
        fmt::format("{} is beyond the range of numbers here, {:g}", Quoted(item.text), kMaxNumber));
  } else {
    Error("expected a number, not " + Describe(item));
  }
}

/// Have all names in an expression values? What is not declared is reported here, what is declared
/// wrongly was reported there.
template <typename T>
bool Node::HaveValues(const Expression& expression) const {
  const ExpressionScope& scope = *document_->scope_;
  for (const std::string& name : expression.names()) {
    if (NamesOf(scope, T()).contains(name)) continue;
    if (std::find(scope.names.begin(), scope.names.end(), name) == scope.names.end()) {
      Error(fmt::format("expected a number, not {}: there is no parameter {}{}",
                        Quoted(expression.text()), Quoted(name), DidYouMean(name, scope.names)));
    }
    return false;
  }
  return true;
}

template <typename T>
std::optional<Quantity<T>> Node::Value(const Unit* asked) const {
  if (!Expect(Kind::kScalar, "a number")) return {};
  const DocumentItem& item = document_->items_[index_];
  const bool looks = LooksLikeNumber(item.text) || IsNotFinite(item.text);
  if (const std::optional<double> value = ParseNumber(item.text); value && item.plain) {
    return Quantity<T>{T(*value), {}, true, false};
  }
  if (looks || item.text.empty() || !document_->scope_) {
    ReportNoNumber();
    return {};
  }
  try {
    const Expression& expression = document_->ExpressionOf(*this, asked);
    if (!HaveValues<T>(expression)) return {};
    const ExpressionScope& scope = *document_->scope_;
    return expression.template Evaluate<T>(NamesOf(scope, T()), scope.units);
  } catch (const ExpressionError& error) {
    Error(fmt::format("expected a number, not {}: {}", Quoted(item.text), error.what()));
  }
  return {};
}

template <typename T>
T Node::Figure(const Unit& asked, double fallback) const {
  if (IsNumber()) return *ParseNumber(document_->items_[index_].text);
  const std::optional<Quantity<T>> value = Value<T>(&asked);
  if (!value) return fallback;
  const std::string& text = document_->items_[index_].text;
  try {
    const T figure = FigureIn(*value, asked);
    if (std::abs(ValueOf(figure)) <= kMaxNumber) return figure;
    Error(fmt::format("{} is {:g}, beyond the range of numbers here, {:g}", Quoted(text),
                      ValueOf(figure), kMaxNumber));
  } catch (const ExpressionError& error) {
    Error(fmt::format("{}: {}", Quoted(text), error.what()));
  }
  return fallback;
}

template std::optional<Quantity<double>> Node::Value(const Unit*) const;
template std::optional<Quantity<Dual>> Node::Value(const Unit*) const;
template double Node::Figure(const Unit&, double) const;
template Dual Node::Figure(const Unit&, double) const;

double Node::Number(const Unit& asked, double fallback) const {
  return asked.factor * Figure(asked, fallback);
}

double Node::Positive(const Unit& asked, double fallback) const {
  const double value = Figure(asked, fallback);
  if (value > 0) return asked.factor * value;
  Error(fmt::format("must be greater than zero, not {}", value));
  return asked.factor * fallback;
}

double Node::NonNegative(const Unit& asked, double fallback) const {
  const double value = Figure(asked, fallback);
  if (value >= 0) return asked.factor * value;
  Error(fmt::format("must not be negative, but is {}", value));
  return asked.factor * fallback;
}

Vector3d Node::Vector3(const Unit& asked, const Vector3d& fallback) const {
  const std::array<Unit, 3> units{asked, asked, asked};
  const std::vector<double> values = Numbers(units);
  return values.empty() ? Vector3d(asked.factor * fallback)
                        : Vector3d(values[0], values[1], values[2]);
}

std::vector<double> Node::Numbers(int count) const {
  return Numbers(std::vector<Unit>(count));
}

std::vector<double> Node::Numbers(std::span<const Unit> asked) const {
  if (asked.size() == 1 && kind() == Kind::kScalar) return {Number(asked[0])};
  const std::string what =
      asked.size() == 1 ? "a number" : fmt::format("a list of {} numbers", asked.size());
  if (!Expect(Kind::kList, what)) return {};
  const std::vector<Node> entries = List();
  if (entries.size() != asked.size()) {
    const bool split = std::any_of(entries.begin(), entries.end(), [](const Node& entry) {
      return entry.kind() == Kind::kScalar &&
             entry.document_->items_[entry.index_].text.find('(') != std::string::npos;
    });
    Error(fmt::format("expected {}, not {}{}", what, Describe(document_->items_[index_]),
                      split ? "; an expression with a comma is written in quotes" : ""));
    return {};
  }
  std::vector<double> values;
  for (size_t i = 0; i < entries.size(); ++i) values.push_back(entries[i].Number(asked[i]));
  return values;
}

}  // namespace vmech
