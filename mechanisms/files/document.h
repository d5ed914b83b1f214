#pragma once

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "vmech/base/dual.h"
#include "vmech/base/pose.h"
#include "vmech/mechanisms/expressions/expression.h"
#include "vmech/mechanisms/expressions/quantity.h"
#include "vmech/mechanisms/expressions/unit.h"
#include "vmech/mechanisms/files/file_errors.h"
#include "vmech/mechanisms/files/yaml/document_item.h"

namespace vmech {

/// The layer under every file that vmech reads: YAML as people write it, JSON as programs write it
/// (which is YAML too), as a tree of nodes that know where they stand. A reader takes typed values
/// out of it; whatever is wrong is collected, and thrown in one go by `Document::ThrowErrors`.

constexpr double kMaxNumber = 1e30;  ///< magnitude of a number in a file; beyond it is a slip

/// A decimal number as in JSON or YAML 1.2: sign, digits, point, exponent, nothing after it. None
/// if the text is anything else: with a leading zero (some readers take it for octal), not finite,
/// or beyond kMaxNumber.
std::optional<double> ParseNumber(std::string_view text);

/// What the expressions of a document may name, and the units in which its bare numbers count.
struct ExpressionScope {
  CountingUnits units;             ///< of bare numbers
  std::vector<std::string> names;  ///< those without a value are reported where they are declared
  NamedQuantities<double> values;  ///< of parameters
  NamedQuantities<Dual> slopes;    ///< values with a derivative, where derivatives are asked for
};

/// Where an expression names a parameter.
struct ParameterUse {
  std::string parameter;  ///< its name
  int line = 0;           ///< from 1
  std::string path;       ///< place in the document
  bool alone = false;     ///< the expression is the parameter, but for a sign
  Unit asked;             ///< by the place where it stands alone
};

class Document;

/// A value in a document, or an absent one. Handles are cheap to copy and live as long as their
/// document. The typed getters return the fallback if the node is absent; if it is present but not
/// of the asked kind they report that and return the fallback.
class Node {
 public:
  using Kind = NodeKind;  ///< what stands there

  Node() = default;
  /// Present: it stands in the file.
  explicit operator bool() const { return kind() != Kind::kAbsent; }
  Kind kind() const;  ///< kAbsent if it does not
  /// The key under which the node stands in a map, else empty.
  const std::string& key() const;
  std::string path() const;  ///< "joints.main.start[1]"
  int line() const;          ///< from 1; 0 if absent
  int column() const;        ///< from 1; 0 if absent

  /// The document of a present node.
  Document& document() const { return *document_; }

  /// Reports what is wrong with this value, at the value or at its key.
  void Error(std::string message) const;
  void KeyError(std::string message) const;  ///< at the key of the entry

  /// The value under a key of a map; absent if there is none.
  Node operator[](std::string_view key) const;

  /// True if the node is a map. Reports required keys that are missing and keys that are neither
  /// required nor optional, save those that begin with "x-", which are everybody's own.
  bool CheckKeys(std::initializer_list<std::string_view> required,
                 std::initializer_list<std::string_view> optional = {}) const;

  /// The entries of a list or of a map with free keys, in the order of the file.
  std::vector<Node> List() const;
  std::vector<Node> Map() const;  ///< likewise, of a map alone

  /// Reports a key that cannot name a part: empty, longer than 100 bytes, with a blank at an end,
  /// or with '/', ',', '"', '\' or a control character in it.
  void CheckName() const;

  /// True for a scalar without quotes that reads as a number.
  bool IsNumber() const;
  /// A number, or an expression where the document has a scope for them, as a figure in the unit
  /// that is asked for here; T is double, or Dual for a derivative by a parameter.
  template <typename T = double>
  T Figure(const Unit& asked, double fallback = 0) const;
  /// The value of a number or an expression with its unit, for a place that asks for the one given
  /// or for any; none if it has none, as reported.
  template <typename T>
  std::optional<Quantity<T>> Value(const Unit* asked = nullptr) const;
  /// A figure in SI; the fallback is a figure.
  double Number(const Unit& asked, double fallback = 0) const;
  double Positive(const Unit& asked, double fallback = 1) const;     ///< > 0
  double NonNegative(const Unit& asked, double fallback = 0) const;  ///< >= 0
  /// A list of three figures in SI.
  Vector3d Vector3(const Unit& asked, const Vector3d& fallback = Vector3d::Zero()) const;
  /// A list of exactly as many numbers as there are units, each in its own; for one a bare number
  /// will do. Empty if absent or wrong.
  std::vector<double> Numbers(std::span<const Unit> asked) const;
  /// Numbers without a dimension.
  double Number(double fallback = 0) const { return Number(Unit{}, fallback); }
  double Positive(double fallback = 1) const { return Positive(Unit{}, fallback); }        ///< > 0
  double NonNegative(double fallback = 0) const { return NonNegative(Unit{}, fallback); }  ///< >= 0
  /// The text of a scalar, whatever it reads as; else empty.
  std::string ScalarText() const;
  int Integer(int fallback, int lowest, int highest) const;  ///< within the two, inclusive
  bool Boolean(bool fallback) const;                         ///< true or false
  std::string Text(std::string fallback = {}) const;         ///< a scalar in quotes or without
  /// A list of three numbers without a dimension.
  Vector3d Vector3(const Vector3d& fallback = Vector3d::Zero()) const {
    return Vector3(Unit{}, fallback);
  }
  std::vector<double> Numbers(int count) const;  ///< a list of that many
  /// One of a set of words.
  template <typename Enum>
  Enum Word(std::initializer_list<std::pair<std::string_view, Enum>> words, Enum fallback) const {
    std::vector<std::string> names;
    for (const auto& word : words) names.emplace_back(word.first);
    const int index = WordIndex(names);
    return index < 0 ? fallback : words.begin()[index].second;
  }

 private:
  friend class Document;
  Node(Document* document, int index) : document_(document), index_(index) {}
  int WordIndex(std::span<const std::string> words) const;
  void ReportNoNumber() const;
  template <typename T>
  bool HaveValues(const Expression& expression) const;
  bool Expect(Kind expected, std::string_view what) const;

  Document* document_ = nullptr;
  int index_ = -1;
};

/// A text in YAML or JSON, parsed, with the places of its nodes for messages.
class Document {
 public:
  /// Parses a text; `name` stands for it in messages. Not accepted: text that is not UTF-8 or has
  /// control characters, YAML's anchors, aliases and tags, keys that are not words, duplicate keys,
  /// more than kMaxNesting levels, more than one document. @throws FileErrors
  Document(std::string_view text, std::string name);
  Document(const Document&) = delete;
  Document& operator=(const Document&) = delete;

  Node root() { return {this, 0}; }                  ///< the whole text
  const std::string& name() const { return name_; }  ///< as messages name it

  /// Adds to what is wrong. @throws FileErrors when that becomes too much to read.
  void Report(FileError error);
  /// The same unless it is reported already: a file may be used several times.
  void ReportOnce(const FileError& error);
  bool ok() const { return errors_.empty(); }            ///< nothing was reported
  size_t error_count() const { return errors_.size(); }  ///< reported so far
  /// Keeps the first `count` errors and forgets the others.
  void ForgetErrorsAfter(size_t count) { errors_.resize(std::min(count, errors_.size())); }
  /// @throws FileErrors with everything reported so far, in the order of the lines; or returns.
  void ThrowErrors();

  /// Lets numbers be expressions.
  void SetScope(ExpressionScope scope) { scope_ = std::move(scope); }
  /// The parameters in those expressions that were asked for their values, each place once.
  const std::vector<ParameterUse>& uses() const { return uses_; }

  /// A file that the document names, with a digest of the bytes that were read.
  struct NamedFile {
    std::filesystem::path path;  ///< absolute
    std::string digest;          ///< of its bytes, as Sha256
  };
  /// Notes a file that was read because the document names it.
  void NoteNamedFile(NamedFile file) { named_files_.push_back(std::move(file)); }
  /// The files that were noted, in the order in which they were read.
  const std::vector<NamedFile>& named_files() const { return named_files_; }

 private:
  friend class Node;
  void CheckDuplicateKeys();
  const Expression& ExpressionOf(const Node& node, const Unit* asked);

  std::string name_, text_;
  std::vector<DocumentItem> items_;
  std::vector<FileError> errors_;
  std::vector<NamedFile> named_files_;
  std::optional<ExpressionScope> scope_;
  std::unordered_map<int, Expression> expressions_;  ///< by the index of their node
  std::vector<ParameterUse> uses_;
};

}  // namespace vmech
