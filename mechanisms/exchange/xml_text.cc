#include "vmech/mechanisms/exchange/xml_text.h"

#include <fmt/format.h>

#include "vmech/mechanisms/document.h"

namespace vmech {
namespace {

std::string Escaped(std::string_view text) {
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

}  // namespace

void XmlText::Begin(std::string_view tag, const Attributes& attributes) {
  text_ += fmt::format("{:{}}<{}", "", 2 * open_.size(), tag);
  for (const auto& [key, value] : attributes) {
    text_ += fmt::format(" {}=\"{}\"", key, Escaped(value));
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
  text_ += fmt::format(">{}</{}>\n", Escaped(text), tag);
}

void XmlText::Comment(std::string_view text) {
  std::string safe(text);
  for (size_t at; (at = safe.find("--")) != safe.npos;) safe.replace(at, 2, "- ");
  text_ += fmt::format("{:{}}<!-- {} -->\n", "", 2 * open_.size(), safe);
}

void RequireShallowXml(std::string_view text, const std::string& file) {
  int depth = 0;
  for (size_t at = text.find('<'); at != text.npos; at = text.find('<', at + 1)) {
    const size_t end = text.find('>', at);
    if (end == text.npos) return;  // the parser's business
    const char next = text[at + 1];
    if (next == '/') {
      --depth;
    } else if (next != '!' && next != '?' && text[end - 1] != '/') {
      ++depth;
    }
    if (depth <= kMaxNesting) continue;
    throw FileErrors(file, fmt::format("elements are nested more than {} deep", kMaxNesting));
  }
}

std::string XmlNumber(double value) {
  return value == 0 ? "0" : fmt::format("{}", value);
}

std::string XmlNumbers(const Vector3d& v) {
  return fmt::format("{} {} {}", XmlNumber(v[0]), XmlNumber(v[1]), XmlNumber(v[2]));
}

}  // namespace vmech
