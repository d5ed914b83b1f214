#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace vmech {

/// How the writers lay out YAML: a small map on one line, {key: value, ...}, folded between entries
/// before column 100.
class FlowMap {
 public:
  /// `value` is YAML already: a number, a word of YamlWord, a list or a map.
  void Add(std::string_view key, std::string_view value);
  std::string Text() const;  ///< on one line
  /// `head` and the map, folded; with a line break at the end.
  std::string Line(std::string_view head) const;

 private:
  std::vector<std::string> entries_;
};

/// A text as a YAML scalar that is read as the same text: in quotes where it might be taken for
/// something else.
std::string YamlWord(std::string_view text);

/// The shortest decimal that reads back as the same number, in a form that every reader of YAML
/// takes for one: those of YAML 1.1 take "1e-06" for a text, "1.0e-06" is a number to all.
std::string YamlNumber(double value);

/// Named maps below each other, the maps aligned.
std::string AlignedLines(const std::vector<std::pair<std::string, FlowMap>>& maps, int indent);

}  // namespace vmech
