#pragma once

#include <string>
#include <string_view>

namespace vmech::html {

/// PrintableText with & < > " ' replaced by character references, so that a hostile name can break
/// neither HTML nor XML.
std::string EscapeText(std::string_view text);

/// A piece of well-formed HTML. Plain text becomes Markup only by being escaped (implicitly);
/// finished markup comes from the functions of page.h and from `Raw`, which is the one door to
/// watch.
class Markup {
 public:
  Markup() = default;
  Markup(std::string_view text) : html_(EscapeText(text)) {}           // NOLINT: implicit
  Markup(const std::string& text) : Markup(std::string_view(text)) {}  // NOLINT: implicit
  Markup(const char* text) : Markup(std::string_view(text)) {}         // NOLINT: implicit
  /// Takes markup as it is. Precondition: well-formed, and no text from outside in it.
  static Markup Raw(std::string html);

  const std::string& html() const { return html_; }
  bool empty() const { return html_.empty(); }
  Markup& operator+=(const Markup& more);
  friend Markup operator+(Markup first, const Markup& second) { return first += second; }

 private:
  std::string html_;
};

/// <tag class="css_class">content</tag>; without the attribute if `css_class` is empty.
Markup Element(std::string_view tag, const Markup& content, std::string_view css_class = "");

}  // namespace vmech::html
