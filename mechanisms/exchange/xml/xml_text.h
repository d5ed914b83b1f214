#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "vmech/base/pose.h"

namespace vmech {

/// Writes XML, an element a line, indented. Texts and attributes are escaped.
class XmlText {
 public:
  /// Names and values, unescaped.
  using Attributes = std::vector<std::pair<std::string_view, std::string>>;

  /// Writes `<tag attributes>`.
  void Open(std::string_view tag, const Attributes& attributes = {});
  void Close();  ///< closes the innermost open tag
  /// Writes `<tag attributes/>`.
  void Element(std::string_view tag, const Attributes& attributes);
  /// Writes `<tag attributes>text</tag>`.
  void Text(std::string_view tag, std::string_view text, const Attributes& attributes = {});
  void Comment(std::string_view text);  ///< writes `<!-- text -->`

  const std::string& text() const { return text_; }  ///< what was written so far

 private:
  void Begin(std::string_view tag, const Attributes& attributes);

  std::string text_ = "<?xml version=\"1.0\"?>\n";
  std::vector<std::string> open_;
};

/// A text as it may stand in an attribute or between tags.
std::string XmlEscaped(std::string_view text);

/// Numbers as the shortest decimals that read back as the same, "1 0.5 -2e-06".
std::string XmlNumber(double value);
/// Three of them, with blanks between.
std::string XmlNumbers(const Vector3d& v);

}  // namespace vmech
