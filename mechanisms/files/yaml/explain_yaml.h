#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace vmech {

/// A slip that people make in YAML, where it is and what to do.
struct YamlSlip {
  int line = 0, column = 0;  ///< from 1
  std::string message;       ///< what is wrong and what to do
};

/// What is likely to have made a YAML parser stop at a line (from 1): a comment with `//`, a tab in
/// the indentation, an indentation that fits no line above, no blank after ':'. None if it is
/// something else.
std::optional<YamlSlip> ExplainYaml(std::string_view text, int stopped_at);

/// The column, from 1, of a comment that begins with `//` or `/*` in a line (from 1); 0 if there is
/// none.
int SlashComment(std::string_view text, int line);

/// What to say of such a comment.
inline constexpr std::string_view kSlashComment = "a comment begins with #, not with //";

}  // namespace vmech
