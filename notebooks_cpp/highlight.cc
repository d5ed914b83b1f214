#include "highlight.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>

namespace vmech {
namespace {

constexpr std::array<std::string_view, 36> kKeywords = {
    "auto",      "bool",     "break",   "case",      "catch",    "char",    "class",  "const",
    "constexpr", "continue", "default", "do",        "double",   "else",    "enum",   "false",
    "for",       "if",       "int",     "namespace", "nullptr",  "private", "public", "return",
    "size_t",    "static",   "struct",  "switch",    "template", "throw",   "true",   "try",
    "typename",  "using",    "void",    "while"};

bool IsWordCharacter(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
}

/// Length of the run of characters at the start of `text` for which `inside` holds.
template <typename Predicate>
std::size_t RunLength(std::string_view text, Predicate inside) {
  return static_cast<std::size_t>(std::find_if_not(text.begin(), text.end(), inside) -
                                  text.begin());
}

std::size_t QuotedLength(std::string_view text) {
  for (std::size_t i = 1; i < text.size(); ++i) {
    if (text[i] == '\\') {
      ++i;
    } else if (text[i] == text[0]) {
      return i + 1;
    }
  }
  return text.size();
}

std::string_view ClassOfWord(std::string_view word) {
  if (std::find(kKeywords.begin(), kKeywords.end(), word) != kKeywords.end()) return "k";
  const bool upper = std::isupper(static_cast<unsigned char>(word.front()));
  return upper && word.find_first_of("abcdefghijklmnopqrstuvwxyz") != std::string_view::npos &&
                 word.find('_') == std::string_view::npos
             ? "t"
             : "";
}

struct Token {
  std::size_t length;
  std::string_view css;
};

Token NextToken(std::string_view text, bool line_start) {
  const char c = text.front();
  const std::size_t to_line_end = std::min(text.find('\n'), text.size());
  if (c == '#' && line_start) return {to_line_end, "p"};
  if (text.substr(0, 2) == "//") return {to_line_end, "c"};
  if (c == '"' || c == '\'') return {QuotedLength(text), "s"};
  if (std::isdigit(static_cast<unsigned char>(c))) {
    return {RunLength(text, [](char d) { return IsWordCharacter(d) || d == '.' || d == '\''; }),
            "n"};
  }
  if (IsWordCharacter(c)) {
    const std::size_t length = RunLength(text, IsWordCharacter);
    return {length, ClassOfWord(text.substr(0, length))};
  }
  return {1, ""};
}

}  // namespace

html::Markup HighlightCpp(std::string_view source) {
  html::Markup code;
  bool line_start = true;
  while (!source.empty()) {
    const Token token = NextToken(source, line_start);
    const std::string_view text = source.substr(0, token.length);
    code += token.css.empty() ? html::Markup(text) : html::Element("span", text, token.css);
    line_start = text.back() == '\n' || (line_start && text == " ");
    source.remove_prefix(token.length);
  }
  return code;
}

}  // namespace vmech
