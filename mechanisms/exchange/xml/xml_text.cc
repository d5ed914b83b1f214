#include "vmech/mechanisms/exchange/xml/xml_text.h"

#include <fmt/format.h>

namespace vmech {
std::string XmlEscaped(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      default:
        escaped += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
  }
  return escaped;
}

void XmlText::Begin(std::string_view tag, const Attributes& attributes) {
  text_ += fmt::format("{:{}}<{}", "", 2 * open_.size(), tag);
  for (const auto& [key, value] : attributes) {
    text_ += fmt::format(" {}=\"{}\"", key, XmlEscaped(value));
  }
}

void XmlText::Open(std::string_view tag, const Attributes& attributes) {
  Begin(tag, attributes);
  text_ += ">\n";
  open_.emplace_back(tag);
}

void XmlText::Close() {
  const std::string tag = open_.back();
  open_.pop_back();
  text_ += fmt::format("{:{}}</{}>\n", "", 2 * open_.size(), tag);
}

void XmlText::Element(std::string_view tag, const Attributes& attributes) {
  Begin(tag, attributes);
  text_ += "/>\n";
}

void XmlText::Text(std::string_view tag, std::string_view text, const Attributes& attributes) {
  Begin(tag, attributes);
  text_ += fmt::format(">{}</{}>\n", XmlEscaped(text), tag);
}

void XmlText::Comment(std::string_view text) {
  std::string safe(text);
  for (size_t at; (at = safe.find("--")) != safe.npos;) safe.replace(at, 2, "- ");
  text_ += fmt::format("{:{}}<!-- {} -->\n", "", 2 * open_.size(), safe);
}

std::string XmlNumber(double value) {
  return value == 0 ? "0" : fmt::format("{}", value);
}

std::string XmlNumbers(const Vector3d& v) {
  return fmt::format("{} {} {}", XmlNumber(v[0]), XmlNumber(v[1]), XmlNumber(v[2]));
}

}  // namespace vmech
