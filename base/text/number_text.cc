#include "vmech/base/text/number_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace vmech {

std::string FormatNumber(double value, int decimals) {
  if (!std::isfinite(value)) return "–";
  const std::string digits = fmt::format("{:.{}f}", std::abs(value), decimals);
  const bool zero = digits.find_first_not_of("0.") == std::string::npos;
  const std::size_t whole = std::min(digits.find('.'), digits.size());
  std::string text = value < 0 && !zero ? "−" : "";
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && i < whole && whole > 4 && (whole - i) % 3 == 0) text += "\u202F";
    text += digits[i];
  }
  return text;
}

std::string FormatSignificant(double value, int digits) {
  if (!std::isfinite(value)) return "–";
  if (value == 0) return "0";
  const std::string rounded = fmt::format("{:.{}e}", value, digits - 1);  // "-1.25e-09"
  const std::size_t e = rounded.find('e');
  const int exponent = std::stoi(rounded.substr(e + 1));
  if (exponent >= -4 && exponent < 7)
    return FormatNumber(value, std::max(0, digits - 1 - exponent));
  return FormatNumber(std::stod(rounded.substr(0, e)), digits - 1) + "×" + PowerOfTen(exponent);
}

std::string FormatShort(double value, int digits) {
  std::string text = FormatSignificant(value, digits);
  const std::size_t end = std::min(text.find("×"), text.size());
  const std::size_t point = text.find('.');
  if (point >= end) return text;
  const std::size_t last = text.find_last_not_of('0', end - 1);
  const std::size_t keep = last == point ? point : last + 1;
  return text.erase(keep, end - keep);
}

std::string PowerOfTen(int exponent) {
  constexpr std::array<std::string_view, 10> kDigits = {"⁰", "¹", "²", "³", "⁴",
                                                        "⁵", "⁶", "⁷", "⁸", "⁹"};
  if (exponent == 0) return "1";
  if (exponent == 1) return "10";
  std::string text = exponent < 0 ? "10⁻" : "10";
  for (const char digit : std::to_string(std::abs(exponent))) text += kDigits[digit - '0'];
  return text;
}

}  // namespace vmech
