#include "vmech/mechanisms/cad/step/part_name.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <string_view>

namespace vmech {
namespace {

constexpr size_t kLongestName = 80;  // leaves room for numbers behind it

/// The bytes of the character at the start of a text [RFC 3629]; 0 if it is no UTF-8.
size_t CharacterLength(std::string_view text) {
  const auto byte = [&](size_t i) { return static_cast<unsigned char>(text[i]); };
  if (byte(0) < 0x80) return 1;
  const auto length = static_cast<size_t>(std::countl_one(byte(0)));
  if (length < 2 || length > 4 || text.size() < length) return 0;
  for (size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return 0;
  }
  // What is longer than it need be, surrogates, and what lies beyond U+10FFFF.
  const bool overlong =
      byte(0) < 0xC2 || (byte(0) == 0xE0 && byte(1) < 0xA0) || (byte(0) == 0xF0 && byte(1) < 0x90);
  const bool outside =
      (byte(0) == 0xED && byte(1) > 0x9F) || byte(0) > 0xF4 || (byte(0) == 0xF4 && byte(1) > 0x8F);
  return overlong || outside ? 0 : length;
}

/// What files cannot hold (Node::CheckName), and the control characters U+0080..U+009F.
bool IsRefused(std::string_view character) {
  const auto first = static_cast<unsigned char>(character[0]);
  if (character.size() == 1) {
    return first < 0x20 || first == 0x7F ||
           std::string_view("/,\"\\").find(character[0]) != std::string_view::npos;
  }
  return first == 0xC2 && static_cast<unsigned char>(character[1]) < 0xA0;
}

std::string WithoutBlanksAtTheEnds(const std::string& text) {
  const size_t first = text.find_first_not_of(' ');
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(' ') - first + 1);
}

}  // namespace

std::string CleanName(const std::string& name, const std::string& fallback) {
  std::string clean;
  for (std::string_view rest = name; !rest.empty();) {
    const size_t length = CharacterLength(rest);
    const std::string_view character = rest.substr(0, std::max(length, size_t{1}));
    rest.remove_prefix(character.size());
    const bool is_good = length > 0 && !IsRefused(character);
    if (clean.size() + (is_good ? length : 1) > kLongestName) break;
    clean += is_good ? character : std::string_view("_");
  }
  clean = WithoutBlanksAtTheEnds(clean);
  return clean.empty() ? fallback : clean;
}

bool IsUtf8(std::string_view text) {
  while (!text.empty()) {
    const size_t length = CharacterLength(text);
    if (length == 0) return false;
    text.remove_prefix(length);
  }
  return true;
}

}  // namespace vmech
