#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace vmech {

/// Text from files and devices without what moves the cursor of a terminal, hides text or turns its
/// direction. New lines and tabs stay; U+FFFD stands for every other control character (C0, DEL,
/// C1, the overrides and isolates of direction), and for bytes that are no UTF-8.

/// The character at the front of a text, as UTF-8 has it.
struct FrontCharacter {
  size_t bytes = 0;    ///< that it takes; 0 if the text ends amid it
  char32_t code = 0;   ///< of Unicode
  bool valid = false;  ///< the bytes are UTF-8
};

/// The first character of a text, which must not be empty.
inline FrontCharacter FrontCharacterOf(std::string_view text) {
  const auto byte = [&](size_t i) { return static_cast<uint8_t>(text[i]); };
  const uint8_t first = byte(0);
  if (first < 0x80) return {1, first, true};
  const size_t bytes = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4) return {1};
  char32_t code = first & (0xFF >> (bytes + 1));
  for (size_t i = 1; i < bytes; ++i) {
    if (i == text.size()) return {0};
    if ((byte(i) & 0xC0) != 0x80) return {1};
    code = code << 6 | (byte(i) & 0x3F);
  }
  constexpr std::array<char32_t, 5> kLeast{0, 0, 0x80, 0x800, 0x10000};
  const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
  if (code < kLeast[bytes] || code > 0x10FFFF || surrogate) return {1};
  return {bytes, code, true};
}

/// Whether a character steers the terminal, or the direction of the text, in place of being shown.
inline bool IsControl(char32_t c) {
  if (c == '\n' || c == '\t') return false;
  return c < 0x20 || (c >= 0x7F && c <= 0x9F) || (c >= 0x202A && c <= 0x202E) ||
         (c >= 0x2066 && c <= 0x2069);
}

/// Appends the text as it may be shown, and returns how much of it was: all but a character that is
/// cut off at its end.
inline size_t AppendPrintable(std::string_view text, std::string* shown) {
  size_t at = 0;
  while (at < text.size()) {
    const FrontCharacter c = FrontCharacterOf(text.substr(at));
    if (c.bytes == 0) break;
    const bool fit = c.valid && !IsControl(c.code);
    shown->append(fit ? text.substr(at, c.bytes) : "\uFFFD");
    at += c.bytes;
  }
  return at;
}

/// The text as it may be shown.
inline std::string PrintableText(std::string_view text) {
  std::string shown;
  if (AppendPrintable(text, &shown) < text.size()) shown += "\uFFFD";
  return shown;
}

}  // namespace vmech
