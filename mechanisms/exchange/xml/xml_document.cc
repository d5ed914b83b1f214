#include "vmech/mechanisms/exchange/xml/xml_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "vmech/mechanisms/files/yaml/characters.h"

namespace vmech {
namespace {

constexpr std::string_view kSpace = " \t\r\n";

bool IsNameCharacter(char c) {
  return std::string_view(" \t\r\n<>/=\"'&;!?").find(c) == std::string_view::npos;
}

/// A character by its number, in UTF-8; empty if XML has none of this number.
std::string Utf8(unsigned long code) {
  const auto tail = [&](int shift) { return static_cast<char>(0x80 | (code >> shift & 0x3F)); };
  const bool control = code < 0x20 && code != '\t' && code != '\n' && code != '\r';
  if (control || code > 0x10FFFF || (code >= 0xD800 && code < 0xE000)) return {};
  if (code < 0x80) return {static_cast<char>(code)};
  if (code < 0x800) return {static_cast<char>(0xC0 | code >> 6), tail(0)};
  if (code < 0x10000) return {static_cast<char>(0xE0 | code >> 12), tail(6), tail(0)};
  return {static_cast<char>(0xF0 | code >> 18), tail(12), tail(6), tail(0)};
}

/// What stands between '&' and ';' as text; empty if it means nothing.
std::string Meaning(std::string_view entity) {
  constexpr std::pair<std::string_view, std::string_view> kEntities[] = {
      {"lt", "<"}, {"gt", ">"}, {"amp", "&"}, {"quot", "\""}, {"apos", "'"}};
  for (const auto& [name, text] : kEntities) {
    if (entity == name) return std::string(text);
  }
  if (entity.size() < 2 || entity[0] != '#') return {};
  const bool hexadecimal = entity[1] == 'x';
  entity.remove_prefix(hexadecimal ? 2 : 1);
  unsigned long code = 0;
  const char* end = entity.data() + entity.size();
  const auto [stop, status] = std::from_chars(entity.data(), end, code, hexadecimal ? 16 : 10);
  return status == std::errc() && stop == end && !entity.empty() ? Utf8(code) : std::string();
}

class Parser {
 public:
  Parser(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  XmlElement Parse() {
    Skip("\xEF\xBB\xBF");
    SkipBetweenElements();
    if (!StartsWith("<")) Fail(AtEnd() ? "the file is empty" : "is not XML: '<' expected");
    XmlElement root = ReadElement(1);
    SkipBetweenElements();
    if (!AtEnd()) Fail(fmt::format("something stands behind the end of <{}>", root.name));
    return root;
  }

 private:
  [[noreturn]] void Fail(std::string message) const {
    const size_t line_head = text_.substr(0, at_).rfind('\n');
    const size_t column = line_head == text_.npos ? at_ + 1 : at_ - line_head;
    throw FileErrors({{file_, line_, static_cast<int>(column), "", std::move(message)}});
  }

  bool AtEnd() const { return at_ == text_.size(); }
  bool StartsWith(std::string_view token) const {
    return text_.compare(at_, token.size(), token) == 0;
  }

  std::string_view Take(size_t size) {
    const std::string_view taken = text_.substr(at_, size);
    line_ += static_cast<int>(std::count(taken.begin(), taken.end(), '\n'));
    at_ += taken.size();
    return taken;
  }

  bool Skip(std::string_view token) {
    if (!StartsWith(token)) return false;
    Take(token.size());
    return true;
  }

  void Expect(std::string_view token, std::string_view where) {
    if (!Skip(token)) Fail(fmt::format("'{}' expected {}", token, where));
  }

  /// All that stands before the token, which is passed over.
  std::string_view TakeUntil(std::string_view token, std::string_view what) {
    const size_t end = text_.find(token, at_);
    if (end == text_.npos) Fail(fmt::format("{} has no end ('{}'): cut off?", what, token));
    const std::string_view taken = Take(end - at_);
    Take(token.size());
    return taken;
  }

  void SkipSpace() { Take(std::min(text_.find_first_not_of(kSpace, at_), text_.size()) - at_); }

  bool SkipComment() {
    const bool comment = Skip("<!--");
    if (comment) TakeUntil("-->", "a comment");
    if (comment || !Skip("<?")) return comment;
    TakeUntil("?>", "an instruction");
    return true;
  }

  void RefuseDeclaration() const {
    if (!StartsWith("<!") || StartsWith("<!--") || StartsWith("<![CDATA[")) return;
    Fail(
        "declarations (<!DOCTYPE>, <!ENTITY>) are not read: take this out, and write what its "
        "entities stand for");
  }

  void SkipBetweenElements() {
    do {
      SkipSpace();
      RefuseDeclaration();
    } while (SkipComment());
  }

  std::string ReadName(std::string_view what) {
    const size_t begin = at_;
    while (!AtEnd() && IsNameCharacter(text_[at_])) ++at_;
    if (at_ == begin) Fail(fmt::format("{} expected", what));
    return std::string(text_.substr(begin, at_ - begin));
  }

  /// A text with its entities replaced, of which only those of XML itself are known.
  std::string Decoded(std::string_view raw) const {
    std::string text;
    for (size_t i = 0; i < raw.size(); ++i) {
      if (raw[i] != '&') {
        text += raw[i];
        continue;
      }
      const size_t end = std::min(raw.find(';', i), raw.size());
      const std::string_view entity = raw.substr(i + 1, end - i - 1);
      const std::string meaning = end < raw.size() ? Meaning(entity) : std::string();
      if (meaning.empty()) {
        Fail(fmt::format("&{}; stands for nothing; '&' itself is written &amp;",
                         entity.substr(0, 20)));
      }
      text += meaning;
      i = end;
    }
    return text;
  }

  XmlElement ReadElement(int depth) {
    if (depth > kMaxNesting) {
      Fail(fmt::format("elements are nested more than {} deep", kMaxNesting));
    }
    if (++count_ > kMaxXmlElements) {
      Fail(fmt::format("there are more than {} elements", kMaxXmlElements));
    }
    XmlElement element;
    element.line = line_;
    Take(1);
    element.name = ReadName("the name of an element");
    while (ReadAttribute(&element)) {
    }
    const bool closed = Skip("/>");
    if (!closed) Expect(">", fmt::format("at the end of the tag <{}", element.name));
    element.tag_end = element.text_end = at_;
    if (!closed) ReadContent(depth, &element);
    return element;
  }

  bool ReadAttribute(XmlElement* element) {
    SkipSpace();
    if (AtEnd() || !IsNameCharacter(text_[at_])) return false;
    const std::string name = ReadName("the name of an attribute");
    if (element->attributes.size() == kMaxXmlAttributes) {
      Fail(fmt::format("<{}> has more than {} attributes", element->name, kMaxXmlAttributes));
    }
    if (element->Attribute(name) != nullptr) {
      Fail(fmt::format("<{}> has two attributes '{}'", element->name, name));
    }
    SkipSpace();
    Expect("=", fmt::format("behind the attribute '{}'", name));
    SkipSpace();
    const std::string quote(StartsWith("'") ? "'" : "\"");
    Expect(quote, fmt::format("before the value of '{}'", name));
    const std::string_view raw = TakeUntil(quote, fmt::format("the value of '{}'", name));
    if (raw.find('<') != raw.npos) Fail(fmt::format("the value of '{}' has '<' in it", name));
    element->attributes.emplace_back(name, Decoded(raw));
    return true;
  }

  void ReadContent(int depth, XmlElement* element) {
    for (;;) {
      if (AtEnd()) {
        Fail(fmt::format("the file ends within <{}> of line {}: cut off?", element->name,
                         element->line));
      }
      RefuseDeclaration();
      if (SkipComment()) continue;
      if (StartsWith("</")) break;
      if (Skip("<![CDATA[")) {
        element->text += TakeUntil("]]>", "CDATA");
      } else if (StartsWith("<")) {
        element->children.push_back(ReadElement(depth + 1));
      } else {
        element->text += Decoded(Take(std::min(text_.find('<', at_), text_.size()) - at_));
      }
    }
    element->text_end = at_;
    ReadEnd(*element);
  }

  void ReadEnd(const XmlElement& element) {
    Take(2);
    const std::string name = ReadName("the name of an element");
    if (name != element.name) {
      Fail(fmt::format("</{}> stands where <{}> of line {} must end first", name, element.name,
                       element.line));
    }
    SkipSpace();
    Expect(">", fmt::format("at the end of </{}", name));
  }

  const std::string_view text_;
  const std::string& file_;
  size_t at_ = 0;
  int line_ = 1, count_ = 0;
};

/// The words of a text, or as many of them.
std::vector<std::string> Words(std::string_view text, size_t most) {
  std::vector<std::string> words;
  for (size_t begin;
       (begin = text.find_first_not_of(kSpace)) != text.npos && words.size() < most;) {
    text.remove_prefix(begin);
    const size_t size = std::min(text.find_first_of(kSpace), text.size());
    words.emplace_back(text.substr(0, size));
    text.remove_prefix(size);
  }
  return words;
}

/// What is wrong with a word as a number, or empty. Unlike ParseNumber, leading zeros and bare
/// points are fine, as other programs write them.
std::string NumberDefect(const std::string& word, double* value) {
  const char* begin = word.data() + (word.starts_with('+') ? 1 : 0);
  const char* end = word.data() + word.size();
  const auto [stop, status] = std::from_chars(begin, end, *value);
  if (word.find("${") != word.npos) return "has to go through xacro first";
  if (stop != end || status == std::errc::invalid_argument) return "is not a number";
  const bool finite = status == std::errc() && std::abs(*value) <= kMaxNumber;
  return finite ? "" : "is not a finite number of reasonable size";
}

}  // namespace

const std::string* XmlElement::Attribute(std::string_view key) const {
  for (const auto& [name, value] : attributes) {
    if (name == key) return &value;
  }
  return nullptr;
}

XmlElement ParseXml(std::string_view text, const std::string& file) {
  RequireCharacters(text, file);
  return Parser(text, file).Parse();
}

void XmlErrors::Add(int line, std::string message) {
  if (!full()) errors_.push_back({file_, line, 1, "", std::move(message)});
}

void XmlErrors::Throw() const {
  if (!errors_.empty()) throw FileErrors(errors_);
}

std::vector<double> XmlErrors::Numbers(std::string_view text, size_t count, int line,
                                       std::string_view what) {
  const std::vector<std::string> words = Words(text, count + 1);
  std::vector<double> numbers(count, 0.0);
  if (words.size() != count) {
    Add(line, fmt::format("{}: {} is not {}", what, Quoted(text),
                          count == 1 ? "a number" : fmt::format("{} numbers", count)));
    return numbers;
  }
  for (size_t i = 0; i < count; ++i) {
    const std::string defect = NumberDefect(words[i], &numbers[i]);
    if (defect.empty()) continue;
    Add(line, fmt::format("{}: {} {}", what, Quoted(words[i]), defect));
    return std::vector<double>(count, 0.0);
  }
  return numbers;
}

double XmlErrors::Number(const XmlElement& element, std::string_view key, double fallback,
                         std::string_view what) {
  const std::string* text = element.Attribute(key);
  if (text == nullptr) return fallback;
  return Numbers(*text, 1, element.line,
                 fmt::format("'{}' of <{}> of {}", key, element.name, what))[0];
}

std::vector<std::string> LeftOut::Texts() const {
  constexpr size_t kMostKinds = 20;
  constexpr size_t kLongest = 60;  // bytes of a name
  std::vector<std::string> texts;
  for (const auto& [what, count] : counts_) {
    if (texts.size() == kMostKinds) {
      texts.push_back(fmt::format("{} more kinds", counts_.size() - kMostKinds));
      break;
    }
    const bool is_long = what.size() > kLongest;
    texts.push_back(fmt::format("{} {}", count, is_long ? Quoted(what) : what));
  }
  return texts;
}

const XmlElement* OnlyChild(const XmlElement& element, std::string_view name, XmlErrors* errors) {
  const XmlElement* only = nullptr;
  for (const XmlElement& child : element.children) {
    if (child.name != name) continue;
    if (only != nullptr) {
      errors->Add(child.line, fmt::format("<{}> has a second <{}>; the first is in line {}",
                                          element.name, name, only->line));
    }
    if (only == nullptr) only = &child;
  }
  return only;
}

}  // namespace vmech
