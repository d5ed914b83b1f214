#include "vmech/mechanisms/files/document.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "vmech/base/text/printable_text.h"
#include "vmech/mechanisms/files/yaml/explain_yaml.h"
#include "vmech/mechanisms/files/yaml/parse_yaml.h"
#include "vmech/mechanisms/files/yaml/scalar_text.h"

namespace vmech {
namespace {

constexpr size_t kMaxErrors = 50;  // more than anybody reads
constexpr size_t kMaxName = 100;   // bytes

}  // namespace

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

void Document::ReportOnce(const FileError& error) {
  const std::string text = ToString(error);
  const bool known = std::any_of(errors_.begin(), errors_.end(),
                                 [&](const FileError& e) { return ToString(e) == text; });
  if (!known) Report(error);
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

int Node::WordIndex(std::span<const std::string> words) const {
  const size_t errors_before = document_ ? document_->error_count() : 0;
  const std::string word = Text();
  if (kind() != Kind::kScalar || document_->error_count() > errors_before) return -1;
  const auto found = std::find(words.begin(), words.end(), word);
  if (found != words.end()) return static_cast<int>(found - words.begin());
  std::string hint = DidYouMean(word, words);
  Error(fmt::format("{} is not one of: {}{}", Quoted(word), fmt::join(words, ", "), hint));
  return -1;
}

}  // namespace vmech
