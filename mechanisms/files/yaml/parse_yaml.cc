#include "vmech/mechanisms/files/yaml/parse_yaml.h"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include <sstream>

#include "vmech/mechanisms/files/file_errors.h"
#include "vmech/mechanisms/files/yaml/characters.h"
#include "vmech/mechanisms/files/yaml/explain_yaml.h"

namespace vmech {
namespace {

using Item = DocumentItem;
using Kind = NodeKind;

/// Builds the items from yaml-cpp's events. Unlike its node tree, the events keep the place of
/// every value, the order of keys and the difference between 1.0 and "1.0".
class ItemBuilder : public YAML::EventHandler {
 public:
  explicit ItemBuilder(const std::string& name) : name_(name) {}
  std::vector<Item> items;

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (!items.empty()) Fail(mark, "a second document begins here; a file holds one");
  }
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    RefuseDecoration(mark, "?", anchor);
    if (AwaitsKey()) Fail(mark, "a key is missing before ':'");
    Add(mark, Kind::kNull);
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    RefuseDecoration(mark, "?", anchor);
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    RefuseDecoration(mark, tag, anchor);
    if (AwaitsKey()) {
      key_ = value;
      key_mark_ = mark;
      has_key_ = true;
      return;
    }
    Item& item = Add(mark, Kind::kScalar);
    item.text = value;
    item.plain = tag == "?";
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    Open(mark, tag, anchor, Kind::kList);
  }
  void OnSequenceEnd() override { open_.pop_back(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    Open(mark, tag, anchor, Kind::kMap);
  }
  void OnMapEnd() override { open_.pop_back(); }

 private:
  [[noreturn]] void Fail(const YAML::Mark& mark, std::string message) const {
    throw FileErrors({{name_, mark.line + 1, mark.column + 1, "", std::move(message)}});
  }

  void RefuseDecoration(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor) {
    if (anchor != YAML::NullAnchor) {
      Fail(mark, "YAML anchors (&) and aliases (*) are not used here; write the value out");
    }
    if (tag != "?" && tag != "!") Fail(mark, "YAML tags (!) are not used here; leave it out");
  }

  bool AwaitsKey() const {
    return !open_.empty() && items[open_.back()].kind == Kind::kMap && !has_key_;
  }

  void Open(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor, Kind kind) {
    RefuseDecoration(mark, tag, anchor);
    if (AwaitsKey()) Fail(mark, "a key must be a word, not a list or a map");
    if (static_cast<int>(open_.size()) == kMaxNesting) {
      Fail(mark, fmt::format("lists and maps are nested more than {} deep", kMaxNesting));
    }
    Add(mark, kind);
    open_.push_back(static_cast<int>(items.size()) - 1);
  }

  Item& Add(const YAML::Mark& mark, Kind kind) {
    const int index = static_cast<int>(items.size());
    Item item;
    item.kind = kind;
    item.line = item.key_line = mark.line + 1;
    item.column = item.key_column = mark.column + 1;
    if (!open_.empty()) {
      Item& parent = items[open_.back()];
      item.parent = open_.back();
      item.place = static_cast<int>(parent.children.size());
      parent.children.push_back(index);
    }
    if (has_key_) {
      item.key = std::move(key_);
      item.key_line = key_mark_.line + 1;
      item.key_column = key_mark_.column + 1;
      if (kind == Kind::kNull) item.line = item.key_line, item.column = item.key_column;
      has_key_ = false;
    }
    return items.emplace_back(std::move(item));
  }

  const std::string& name_;
  std::vector<int> open_;
  std::string key_;
  YAML::Mark key_mark_;
  bool has_key_ = false;
};

/// What stopped yaml-cpp, in its own words only where no other are known.
FileError Explained(const YAML::Exception& error, std::string_view text, const std::string& name) {
  const int line = error.mark.line + 1;
  if (const std::optional<YamlSlip> slip = ExplainYaml(text, line)) {
    return {name, slip->line, slip->column, "", slip->message};
  }
  const bool flow = error.msg.find(" flow") != std::string::npos;
  const char* hint = flow ? "; a bracket is not closed, or a comma is missing, here or before" : "";
  return {name, line, error.mark.column + 1, "", error.msg + hint};
}

}  // namespace

std::vector<Item> ParseYaml(std::string_view text, const std::string& name) {
  if (text.size() > kMaxFileBytes) {
    throw FileErrors(name, fmt::format("larger than {} MB", kMaxFileBytes >> 20));
  }
  RequireCharacters(text, name);
  std::istringstream stream{std::string(text)};
  ItemBuilder builder(name);
  try {
    YAML::Parser parser(stream);
    while (parser.HandleNextDocument(builder)) {
    }
  } catch (const FileErrors& refused) {
    const int line = refused.errors().front().line, column = SlashComment(text, line);
    if (column == 0) throw;
    throw FileErrors({{name, line, column, "", std::string(kSlashComment)}});
  } catch (const YAML::Exception& error) {
    throw FileErrors({Explained(error, text, name)});
  }
  if (builder.items.empty()) throw FileErrors(name, "the file is empty");
  return std::move(builder.items);
}

}  // namespace vmech
