#include "vmech/mechanisms/files/flow_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

namespace vmech {
namespace {

constexpr size_t kMaxColumns = 100;
constexpr size_t kMaxAligned = 30;  // columns; a longer name does not push the others aside

bool IsLetter(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_';
}

bool IsPlain(char c) {
  return IsLetter(c) || std::isdigit(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '/';
}

/// Words that YAML, in this version or an older one, takes for a value that is not a text.
bool IsReserved(std::string_view text) {
  static constexpr std::array<std::string_view, 9> kWords{"true", "false", "null", "yes", "no",
                                                          "on",   "off",   "y",    "n"};
  std::string lower(text);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return std::find(kWords.begin(), kWords.end(), lower) != kWords.end();
}

/// An entry that is too long for a line, broken between the items of its lists.
std::string Folded(std::string_view entry, const std::string& margin, size_t* column) {
  std::string text;
  while (*column + entry.size() > kMaxColumns) {
    const size_t room = kMaxColumns - std::min(*column, kMaxColumns - 1);
    const size_t comma = entry.rfind(", ", room - 1);
    if (comma == entry.npos) break;
    text += std::string(entry.substr(0, comma + 1)) + "\n" + margin + "  ";
    entry.remove_prefix(comma + 2);
    *column = margin.size() + 2;
  }
  *column += entry.size();
  return text + std::string(entry);
}

}  // namespace

void FlowMap::Add(std::string_view key, std::string_view value) {
  entries_.push_back(fmt::format("{}: {}", key, value));
}

std::string FlowMap::Text() const {
  return fmt::format("{{{}}}", fmt::join(entries_, ", "));
}

std::string FlowMap::Line(std::string_view head) const {
  std::string text = std::string(head) + "{";
  const std::string margin(text.size(), ' ');
  size_t column = text.size();
  for (size_t i = 0; i < entries_.size(); ++i) {
    const std::string entry = entries_[i] + (i + 1 < entries_.size() ? "," : "}");
    const bool starts_line = i == 0 || column + 1 + entry.size() > kMaxColumns;
    if (i > 0) text += starts_line ? "\n" + margin : " ";
    column = starts_line ? margin.size() : column + 1;
    text += Folded(entry, margin, &column);
  }
  return text + (entries_.empty() ? "}\n" : "\n");
}

std::string YamlWord(std::string_view text) {
  const bool plain = !text.empty() && IsLetter(text[0]) && !IsReserved(text) &&
                     std::all_of(text.begin(), text.end(), IsPlain);
  if (plain) return std::string(text);
  std::string quoted = "\"";
  for (const char c : text) {
    const bool control = static_cast<unsigned char>(c) < 0x20 || c == 0x7F;
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += control ? fmt::format("\\x{:02X}", static_cast<unsigned>(c)) : std::string(1, c);
  }
  return quoted + '"';
}

std::string YamlNumber(double value) {
  std::string text = fmt::format("{}", value);
  const size_t exponent = text.find('e');
  if (exponent != text.npos && text.find('.') == text.npos) text.insert(exponent, ".0");
  return text;
}

std::string AlignedLines(const std::vector<std::pair<std::string, FlowMap>>& maps, int indent) {
  size_t width = 0;
  for (const auto& entry : maps) {
    const size_t size = YamlWord(entry.first).size() + 1;
    if (size <= kMaxAligned) width = std::max(width, size);
  }
  std::string text;
  for (const auto& [name, map] : maps) {
    text += map.Line(fmt::format("{:{}}{:<{}} ", "", indent, YamlWord(name) + ":", width));
  }
  return text;
}

}  // namespace vmech
