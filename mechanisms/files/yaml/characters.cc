#include "vmech/mechanisms/files/yaml/characters.h"

#include <fmt/format.h>

#include "vmech/mechanisms/files/file_errors.h"

namespace vmech {
namespace {

/// Length of the UTF-8 sequence at the head of the text; 0 if it is not one (RFC 3629).
int Utf8Length(std::string_view text) {
  const auto byte = [&](size_t i) {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u;
  };
  const auto continues = [&](size_t i) { return (byte(i) & 0xC0) == 0x80; };
  const unsigned head = byte(0);
  if (head < 0x80) return 1;
  if (head >= 0xC2 && head < 0xE0) return continues(1) ? 2 : 0;
  if (head >= 0xE0 && head < 0xF0) {
    const bool overlong = head == 0xE0 && byte(1) < 0xA0;
    const bool surrogate = head == 0xED && byte(1) >= 0xA0;
    return !overlong && !surrogate && continues(1) && continues(2) ? 3 : 0;
  }
  if (head >= 0xF0 && head < 0xF5) {
    const bool overlong = head == 0xF0 && byte(1) < 0x90;
    const bool beyond = head == 0xF4 && byte(1) >= 0x90;
    return !overlong && !beyond && continues(1) && continues(2) && continues(3) ? 4 : 0;
  }
  return 0;
}

}  // namespace

void RequireCharacters(std::string_view text, const std::string& file) {
  int line = 1, column = 1;
  for (size_t i = 0; i < text.size();) {
    const auto c = static_cast<unsigned char>(text[i]);
    const int length = Utf8Length(text.substr(i));
    const bool control = (c < 0x20 && c != '\n' && c != '\r' && c != '\t') || c == 0x7F;
    if (length == 0 || control) {
      const char* what = control ? "control character 0x{:02X}"
                                 : "byte that is not UTF-8 text, 0x{:02X}; save the file as UTF-8";
      throw FileErrors({{file, line, column, "", fmt::format(fmt::runtime(what), c)}});
    }
    i += length;
    ++column;
    if (c == '\n') ++line, column = 1;
  }
}

}  // namespace vmech
