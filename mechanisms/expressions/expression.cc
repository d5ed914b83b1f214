#include "vmech/mechanisms/expressions/expression.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <system_error>
#include <utility>

#include "vmech/base/dual.h"

namespace vmech {
namespace {

using Step = Expression::Step;
using Kind = Step::Kind;

constexpr size_t kLongest = 1000;  // characters of an expression
constexpr int kDeepest = 50;       // parentheses and signs in each other

bool IsDigit(char c) {
  return c >= '0' && c <= '9';
}
bool BeginsName(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
bool IsOfName(char c) {
  return BeginsName(c) || IsDigit(c);
}

/// Recursive descent into steps for a stack.
class ExpressionParser {
 public:
  ExpressionParser(std::string_view text, std::vector<Step>* steps) : text_(text), steps_(steps) {}

  void ParseAll() {
    if (text_.size() > kLongest) {
      Fail(fmt::format("longer than {} characters; name its parts as parameters", kLongest));
    }
    ParseSum();
    if (Peek() == ')') Fail("a ')' without its '('");
    if (Peek() == ',') Fail("a ',' outside of the parentheses of a function");
    if (Peek() != '\0') Fail(fmt::format("an operator is missing before '{}'", Rest()));
  }

 private:
  [[noreturn]] static void Fail(const std::string& message) { throw ExpressionError(message); }

  char Peek() {
    while (at_ < text_.size() && text_[at_] == ' ') ++at_;
    return at_ < text_.size() ? text_[at_] : '\0';
  }
  bool Take(char c) {
    if (Peek() != c) return false;
    ++at_;
    return true;
  }
  std::string Rest() const { return std::string(text_.substr(at_, 12)); }

  /// The name that begins here, without taking it.
  std::string_view PeekName() {
    if (!BeginsName(Peek())) return {};
    size_t end = at_;
    while (end < text_.size() && IsOfName(text_[end])) ++end;
    return text_.substr(at_, end - at_);
  }
  bool CallFollows(std::string_view name) const {
    const size_t after = text_.find_first_not_of(' ', at_ + name.size());
    return after != text_.npos && text_[after] == '(';
  }

  void Add(Kind kind) { steps_->push_back({kind, 0, false, {}, {}}); }

  void ParseSum() {
    if (++depth_ > kDeepest) Fail("parentheses are nested too deeply");
    ParseProduct();
    while (Peek() == '+' || Peek() == '-') {
      const bool minus = text_[at_++] == '-';
      ParseProduct();
      if (minus) Add(Kind::kNegative);
      Add(Kind::kSum);
    }
    --depth_;
  }

  void ParseProduct() {
    ParseSigned();
    while (Peek() == '*' || Peek() == '/') {
      const Kind kind = text_[at_++] == '*' ? Kind::kProduct : Kind::kRatio;
      if (Peek() == '*') Fail("'**' is written '^'");
      ParseSigned();
      Add(kind);
    }
  }

  void ParseSigned() {
    if (++depth_ > kDeepest) Fail("too many signs in a row");
    if (Take('-')) {
      ParseSigned();
      Add(Kind::kNegative);
    } else if (Take('+')) {
      ParseSigned();
    } else {
      ParsePower();
    }
    --depth_;
  }

  void ParsePower() {
    ParseOperand();
    while (UnitFollows()) {
      ParseUnitPower();
      Add(Kind::kProduct);
    }
    if (!Take('^')) return;
    ParseSigned();
    Add(Kind::kPower);
  }

  bool UnitFollows() {
    const std::string_view name = PeekName();
    return !name.empty() && FindUnit(name) && !CallFollows(name);
  }

  /// "mm", "mm^2": the power is of the unit alone.
  void ParseUnitPower() {
    const std::string_view name = PeekName();
    steps_->push_back({Kind::kUnit, 0, false, *FindUnit(name), {}});
    at_ += name.size();
    if (!Take('^')) return;
    ParseSigned();
    Add(Kind::kPower);
  }

  void ParseOperand() {
    const char c = Peek();
    if (IsDigit(c) || c == '.') return ParseNumber();
    if (BeginsName(c)) return ParseName();
    if (!Take('(')) {
      Fail(c == '\0' ? "it ends where a number or a name is wanted"
                     : fmt::format("a number or a name is wanted before '{}'", Rest()));
    }
    ParseSum();
    if (!Take(')')) Fail("a ')' is missing");
  }

  void ParseNumber() {
    double value = 0;
    const char* const begin = text_.data() + at_;
    const auto [end, status] = std::from_chars(begin, text_.data() + text_.size(), value);
    const auto length = static_cast<size_t>(end - begin);
    if (status != std::errc()) Fail(fmt::format("'{}' is not a number", Rest()));
    if (length > 1 && begin[0] == '0' && IsDigit(begin[1])) Fail("a number with a leading zero");
    at_ += length;
    if (at_ < text_.size() && IsOfName(text_[at_])) {
      Fail(
          fmt::format("a blank is missing before '{}': a unit is written as in '40 deg', a "
                      "product as in '2*x'",
                      Rest()));
    }
    steps_->push_back({Kind::kNumber, value, false, {}, {}});
  }

  void ParseName() {
    const std::string_view name = PeekName();
    if (CallFollows(name)) return ParseCall(std::string(name));
    if (FindUnit(name)) return ParseUnitPower();
    at_ += name.size();
    if (name == "pi") {
      steps_->push_back({Kind::kNumber, std::numbers::pi, true, {}, {}});
    } else if (ArgumentsOf(name) > 0) {
      Fail(fmt::format("{0} is a function: {0}(..)", name));
    } else {
      steps_->push_back({Kind::kName, 0, false, {}, std::string(name)});
    }
  }

  void ParseCall(const std::string& function) {
    const int wanted = ArgumentsOf(function);
    if (wanted == 0) {
      Fail(
          fmt::format("there is no function '{}'; known are sqrt, sin, cos, tan, asin, acos, "
                      "atan2, abs, min, max",
                      function));
    }
    at_ += function.size();
    Take('(');
    int given = 0;
    do {
      ParseSum();
      ++given;
    } while (Take(','));
    if (!Take(')')) Fail(fmt::format("a ')' is missing behind {}(", function));
    if (given != wanted) {
      Fail(fmt::format("{} takes {}, not {}", function, wanted == 1 ? "one number" : "two numbers",
                       given));
    }
    steps_->push_back({Kind::kCall, 0, false, {}, function});
  }

  std::string_view text_;
  std::vector<Step>* steps_;
  size_t at_ = 0;
  int depth_ = 0;
};

template <typename T>
Quantity<T> TakeLast(std::vector<Quantity<T>>* stack) {
  Quantity<T> last = std::move(stack->back());
  stack->pop_back();
  return last;
}

template <typename T>
Quantity<T> OfOperands(const Step& step, std::vector<Quantity<T>>* stack,
                       const CountingUnits& units) {
  if (step.kind == Kind::kNegative) {
    Quantity<T> q = TakeLast(stack);
    q.figure = -q.figure;
    return q;
  }
  if (step.kind == Kind::kCall && ArgumentsOf(step.name) == 1) {
    return Call<T>(step.name, {TakeLast(stack)}, units);
  }
  const Quantity<T> b = TakeLast(stack), a = TakeLast(stack);
  switch (step.kind) {
    case Kind::kSum:
      return Sum(a, b, units);
    case Kind::kProduct:
      return Product(a, b);
    case Kind::kRatio:
      return Ratio(a, b);
    case Kind::kPower:
      return Power(a, b);
    default:
      return Call<T>(step.name, {a, b}, units);
  }
}

}  // namespace

Expression::Expression(std::string_view text) : text_(text) {
  ExpressionParser(text_, &steps_).ParseAll();
  for (const Step& step : steps_) {
    if (step.kind != Kind::kName) continue;
    if (std::find(names_.begin(), names_.end(), step.name) == names_.end()) {
      names_.push_back(step.name);
    }
  }
  const bool signs = std::all_of(steps_.begin() + 1, steps_.end(),
                                 [](const Step& step) { return step.kind == Kind::kNegative; });
  if (signs && steps_[0].kind == Kind::kName) lone_name_ = steps_[0].name;
}

template <typename T>
Quantity<T> Expression::Evaluate(const NamedQuantities<T>& names,
                                 const CountingUnits& units) const {
  std::vector<Quantity<T>> stack;
  for (const Step& step : steps_) {
    if (step.kind == Kind::kNumber) {
      stack.push_back({T(step.number), {}, true, step.pi});
    } else if (step.kind == Kind::kUnit) {
      stack.push_back({T(1), step.unit, false, false});
    } else if (step.kind == Kind::kName) {
      stack.push_back(names.at(step.name));
    } else {
      stack.push_back(OfOperands(step, &stack, units));
    }
  }
  return stack[0];
}

template Quantity<double> Expression::Evaluate(const NamedQuantities<double>&,
                                               const CountingUnits&) const;
template Quantity<Dual> Expression::Evaluate(const NamedQuantities<Dual>&,
                                             const CountingUnits&) const;

std::string NameDefect(std::string_view name) {
  if (name.empty() || !BeginsName(name[0]) || !std::all_of(name.begin(), name.end(), IsOfName)) {
    return "the name of a parameter is made of letters, digits and '_', and begins with a letter";
  }
  if (FindUnit(name)) return fmt::format("{0} is a unit; give the parameter another name", name);
  if (name == "pi" || ArgumentsOf(name) > 0) {
    return fmt::format("{} has a meaning in expressions; give the parameter another name", name);
  }
  return {};
}

}  // namespace vmech
