#include "vmech/mechanisms/files/document.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <tuple>

#include "vmech/base/printable_text.h"
#include "vmech/mechanisms/files/explain_yaml.h"
#include "vmech/mechanisms/files/parse_yaml.h"

namespace vmech {
namespace {

constexpr size_t kMaxErrors = 50;  // more than anybody reads
constexpr size_t kMaxName = 100;   // bytes

bool IsDigits(std::string_view text) {
  return !text.empty() &&
         std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

/// True for a decimal number as in JSON or YAML 1.2: sign, digits, point, exponent. A leading
/// zero, which some readers take for octal, is not accepted.
bool LooksLikeNumber(std::string_view text) {
  if (!text.empty() && (text[0] == '-' || text[0] == '+')) text.remove_prefix(1);
  if (const size_t e = text.find_first_of("eE"); e != text.npos) {
    std::string_view exponent = text.substr(e + 1);
    if (!exponent.empty() && (exponent[0] == '-' || exponent[0] == '+')) exponent.remove_prefix(1);
    if (!IsDigits(exponent)) return false;
    text = text.substr(0, e);
  }
  const size_t point = std::min(text.find('.'), text.size());
  const std::string_view whole = text.substr(0, point);
  const std::string_view part = point < text.size() ? text.substr(point + 1) : "";
  if (whole.size() > 1 && whole[0] == '0') return false;
  return (IsDigits(whole) || (whole.empty() && IsDigits(part))) && (part.empty() || IsDigits(part));
}

bool IsWordFor(std::string_view text, std::initializer_list<std::string_view> words) {
  return std::find(words.begin(), words.end(), text) != words.end();
}

bool IsBoolean(std::string_view text) {
  return IsWordFor(text, {"true", "True", "TRUE", "false", "False", "FALSE"});
}

bool IsNotFinite(std::string_view text) {
  if (!text.empty() && (text[0] == '-' || text[0] == '+')) text.remove_prefix(1);
  return IsWordFor(
      text, {".inf", ".Inf", ".INF", ".nan", ".NaN", ".NAN", "inf", "Infinity", "nan", "NaN"});
}

/// "a map", "text 'abc'": what a node is, for messages.
std::string Describe(const DocumentItem& item) {
  switch (item.kind) {
    case Node::Kind::kMap:
      return "a map";
    case Node::Kind::kList:
      return fmt::format("a list of {}", item.children.size());
    case Node::Kind::kScalar:
      if (!item.plain) return "text " + Quoted(item.text);
      if (LooksLikeNumber(item.text)) return "the number " + item.text.substr(0, 40);
      return Quoted(item.text);
    default:
      return "nothing";
  }
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

// Document

Document::Document(std::string_view text, std::string name)
    : name_(std::move(name)), text_(text), items_(ParseYaml(text, name_)) {
  CheckDuplicateKeys();
}

void Document::CheckDuplicateKeys() {
  for (const DocumentItem& map : items_) {
    if (map.kind != Node::Kind::kMap) continue;
    std::vector<int> entries = map.children;
    std::stable_sort(entries.begin(), entries.end(),
                     [&](int a, int b) { return items_[a].key < items_[b].key; });
    for (size_t i = 1; i < entries.size(); ++i) {
      const DocumentItem& entry = items_[entries[i]];
      const DocumentItem& earlier = items_[entries[i - 1]];
      if (entry.key != earlier.key) continue;
      Node(this, entries[i])
          .KeyError(fmt::format("this key is already given in line {}", earlier.key_line));
    }
  }
}

void Document::Report(FileError error) {
  if (error.file == name_ && SlashComment(text_, error.line) > 0) {
    error.message += fmt::format("; {}", kSlashComment);
  }
  errors_.push_back(std::move(error));
  if (errors_.size() < kMaxErrors) return;
  errors_.push_back({name_, 0, 0, "", "too many errors; stopped here"});
  ThrowErrors();
}

void Document::ThrowErrors() {
  if (errors_.empty()) return;
  std::stable_sort(errors_.begin(), errors_.end(), [&](const FileError& a, const FileError& b) {
    const auto order = [&](const FileError& e) {  // other files last, a file as a whole after it
      return std::tuple(e.file != name_, e.file, e.line == 0, e.line, e.column);
    };
    return order(a) < order(b);
  });
  throw FileErrors(errors_);
}

// Node

Node::Kind Node::kind() const {
  return index_ < 0 ? Kind::kAbsent : document_->items_[index_].kind;
}

const std::string& Node::key() const {
  static const std::string none;
  return index_ < 0 ? none : document_->items_[index_].key;
}

int Node::line() const {
  return index_ < 0 ? 0 : document_->items_[index_].line;
}

int Node::column() const {
  return index_ < 0 ? 0 : document_->items_[index_].column;
}

std::string Node::path() const {
  std::string path;
  for (int i = index_; i > 0; i = document_->items_[i].parent) {
    const DocumentItem& item = document_->items_[i];
    const bool in_list = document_->items_[item.parent].kind == Kind::kList;
    const std::string step = in_list ? fmt::format("[{}]", item.place) : item.key;
    path.insert(0, path.empty() || path[0] == '[' ? step : step + ".");
  }
  return path;
}

void Node::Error(std::string message) const {
  if (index_ < 0) return;
  document_->Report({document_->name_, line(), column(), path(), std::move(message)});
}

void Node::KeyError(std::string message) const {
  if (index_ < 0) return;
  const DocumentItem& item = document_->items_[index_];
  document_->Report({document_->name_, item.key_line, item.key_column, path(), std::move(message)});
}

bool Node::Expect(Kind expected, std::string_view what) const {
  if (kind() == expected) return true;
  if (*this) Error(fmt::format("expected {}, not {}", what, Describe(document_->items_[index_])));
  return false;
}

Node Node::operator[](std::string_view key) const {
  if (kind() != Kind::kMap) return {};
  for (const int child : document_->items_[index_].children) {
    if (document_->items_[child].key == key) return {document_, child};
  }
  return {};
}

bool Node::CheckKeys(std::initializer_list<std::string_view> required,
                     std::initializer_list<std::string_view> optional) const {
  if (!Expect(Kind::kMap, "a map of keys and values")) return false;
  std::vector<std::string> known(required.begin(), required.end());
  known.insert(known.end(), optional.begin(), optional.end());
  for (const Node& entry : Map()) {
    const std::string& key = entry.key();
    if (key.starts_with("x-") || std::find(known.begin(), known.end(), key) != known.end())
      continue;
    std::string hint = DidYouMean(key, known);
    if (hint.empty()) hint = fmt::format("; known here: {}", fmt::join(known, ", "));
    entry.KeyError("unknown key " + Quoted(key) + hint);
  }
  for (const std::string_view key : required) {
    if (!(*this)[key]) KeyError(fmt::format("the key '{}' is missing", key));
  }
  return true;
}

std::vector<Node> Node::List() const {
  std::vector<Node> nodes;
  if (!Expect(Kind::kList, "a list")) return nodes;
  for (const int child : document_->items_[index_].children) nodes.push_back({document_, child});
  return nodes;
}

std::vector<Node> Node::Map() const {
  std::vector<Node> nodes;
  if (!Expect(Kind::kMap, "a map")) return nodes;
  for (const int child : document_->items_[index_].children) nodes.push_back({document_, child});
  return nodes;
}

void Node::CheckName() const {
  const std::string& name = key();
  const auto misfit = [](char c) {
    return static_cast<unsigned char>(c) < 0x20 || c == 0x7F ||
           std::string_view("/,\"\\").find(c) != std::string_view::npos;
  };
  if (name.empty() || name.size() > kMaxName || name.front() == ' ' || name.back() == ' ') {
    KeyError(fmt::format("a name has 1 to {} characters and no blank at an end", kMaxName));
  } else if (std::any_of(name.begin(), name.end(), misfit)) {
    KeyError("a name has no '/', ',', '\"', '\\' or control character in it");
  }
}

bool Node::IsNumber() const {
  if (kind() != Kind::kScalar) return false;
  const DocumentItem& item = document_->items_[index_];
  return item.plain && ParseNumber(item.text).has_value();
}

double Node::Number(double fallback) const {
  if (!Expect(Kind::kScalar, "a number")) return fallback;
  const DocumentItem& item = document_->items_[index_];
  if (const std::optional<double> value = ParseNumber(item.text); value && item.plain) {
    return *value;
  }
  if (item.plain && IsNotFinite(item.text)) {
    Error("expected a finite number, not " + Quoted(item.text));
  } else if (item.plain && LooksLikeNumber(item.text)) {
    Error(
        fmt::format("{} is beyond the range of numbers here, {:g}", Quoted(item.text), kMaxNumber));
  } else {
    Error("expected a number, not " + Describe(item));
  }
  return fallback;
}

double Node::Positive(double fallback) const {
  const double value = Number(fallback);
  if (value > 0) return value;
  Error(fmt::format("must be greater than zero, not {}", value));
  return fallback;
}

double Node::NonNegative(double fallback) const {
  const double value = Number(fallback);
  if (value >= 0) return value;
  Error(fmt::format("must not be negative, but is {}", value));
  return fallback;
}

int Node::Integer(int fallback, int lowest, int highest) const {
  const double value = Number(fallback);
  if (value == std::floor(value) && value >= lowest && value <= highest) {
    return static_cast<int>(value);
  }
  Error(fmt::format("must be a whole number from {} to {}, not {}", lowest, highest, value));
  return fallback;
}

bool Node::Boolean(bool fallback) const {
  if (!Expect(Kind::kScalar, "true or false")) return fallback;
  const DocumentItem& item = document_->items_[index_];
  if (item.plain && IsBoolean(item.text)) return item.text[0] == 't' || item.text[0] == 'T';
  Error("expected true or false, not " + Describe(item));
  return fallback;
}

std::string Node::Text(std::string fallback) const {
  if (!Expect(Kind::kScalar, "text")) return fallback;
  const DocumentItem& item = document_->items_[index_];
  if (!item.plain || !(LooksLikeNumber(item.text) || IsBoolean(item.text))) return item.text;
  Error(fmt::format("expected text; write it in quotes: \"{}\"", item.text.substr(0, 40)));
  return fallback;
}

Vector3d Node::Vector3(const Vector3d& fallback) const {
  const std::vector<double> values = Numbers(3);
  return values.empty() ? fallback : Vector3d(values[0], values[1], values[2]);
}

std::vector<double> Node::Numbers(int count) const {
  if (count == 1 && kind() == Kind::kScalar) return {Number()};
  const std::string what = count == 1 ? "a number" : fmt::format("a list of {} numbers", count);
  if (!Expect(Kind::kList, what)) return {};
  const std::vector<Node> entries = List();
  if (static_cast<int>(entries.size()) != count) {
    Error(fmt::format("expected {}, not {}", what, Describe(document_->items_[index_])));
    return {};
  }
  std::vector<double> values;
  for (const Node& entry : entries) values.push_back(entry.Number());
  return values;
}

int Node::WordIndex(std::span<const std::string> words) const {
  const std::string word = Text();
  if (word.empty() && kind() != Kind::kScalar) return -1;
  const auto found = std::find(words.begin(), words.end(), word);
  if (found != words.end()) return static_cast<int>(found - words.begin());
  std::string hint = DidYouMean(word, words);
  Error(fmt::format("{} is not one of: {}{}", Quoted(word), fmt::join(words, ", "), hint));
  return -1;
}

}  // namespace vmech
