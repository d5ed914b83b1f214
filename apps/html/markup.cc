#include "vmech/apps/html/markup.h"

#include <utility>

#include "vmech/base/text/printable_text.h"

namespace vmech::html {
namespace {

std::string_view ReferenceFor(char c) {
  switch (c) {
    case '&':
      return "&amp;";
    case '<':
      return "&lt;";
    case '>':
      return "&gt;";
    case '"':
      return "&quot;";
    case '\'':
      return "&#39;";
    default:
      return {};
  }
}

}  // namespace

std::string EscapeText(std::string_view text) {
  std::string escaped;
  escaped.reserve(text.size() + 16);
  for (const char c : PrintableText(text)) {
    const std::string_view reference = ReferenceFor(c);
    if (reference.empty()) {
      escaped += c;
    } else {
      escaped += reference;
    }
  }
  return escaped;
}

Markup Markup::Raw(std::string html) {
  Markup markup;
  markup.html_ = std::move(html);
  return markup;
}

Markup& Markup::operator+=(const Markup& more) {
  html_ += more.html_;
  return *this;
}

Markup Element(std::string_view tag, const Markup& content, std::string_view css_class) {
  std::string html;
  html.reserve(content.html().size() + 2 * tag.size() + css_class.size() + 16);
  html.append("<").append(tag);
  if (!css_class.empty()) html.append(" class=\"").append(EscapeText(css_class)).append("\"");
  html.append(">").append(content.html()).append("</").append(tag).append(">");
  return Markup::Raw(std::move(html));
}

}  // namespace vmech::html
