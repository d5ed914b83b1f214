#include "vmech/mechanisms/files/yaml/scalar_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>

#include "vmech/mechanisms/files/file_errors.h"

namespace vmech {
namespace {

bool IsDigits(std::string_view text) {
  return !text.empty() &&
         std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

bool IsWordFor(std::string_view text, std::initializer_list<std::string_view> words) {
  return std::find(words.begin(), words.end(), text) != words.end();
}

}  // namespace

bool LooksLikeNumber(std::string_view text) {
  if (!text.empty() && (text[0] == '-' || text[0] == '+')) text.remove_prefix(1);
  if (const size_t e = text.find_first_of("eE"); e != text.npos) {
    std::string_view exponent = text.substr(e + 1);
    if (!exponent.empty() && (exponent[0] == '-' || exponent[0] == '+')) exponent.remove_prefix(1);
    if (!IsDigits(exponent)) return false;
    text = text.substr(0, e);
  }
  const size_t point = std::min(text.find('.'), text.size());
  const std::string_view whole = text.substr(0, point);
  const std::string_view part = point < text.size() ? text.substr(point + 1) : "";
  if (whole.size() > 1 && whole[0] == '0') return false;
  return (IsDigits(whole) || (whole.empty() && IsDigits(part))) && (part.empty() || IsDigits(part));
}

bool IsBoolean(std::string_view text) {
  return IsWordFor(text, {"true", "True", "TRUE", "false", "False", "FALSE"});
}

bool IsNotFinite(std::string_view text) {
  if (!text.empty() && (text[0] == '-' || text[0] == '+')) text.remove_prefix(1);
  return IsWordFor(
      text, {".inf", ".Inf", ".INF", ".nan", ".NaN", ".NAN", "inf", "Infinity", "nan", "NaN"});
}

std::string Describe(const DocumentItem& item) {
  switch (item.kind) {
    case NodeKind::kMap:
      return "a map";
    case NodeKind::kList:
      return fmt::format("a list of {}", item.children.size());
    case NodeKind::kScalar:
      if (!item.plain) return "text " + Quoted(item.text);
      if (LooksLikeNumber(item.text)) return "the number " + item.text.substr(0, 40);
      return Quoted(item.text);
    default:
      return "nothing";
  }
}

}  // namespace vmech
