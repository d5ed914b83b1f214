#include "vmech/mechanisms/files/yaml/explain_yaml.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

namespace vmech {
namespace {

constexpr std::string_view kBlanks = " \t\r";

/// The lines of a text up to the one where the parser stopped.
std::vector<std::string_view> LinesUpTo(std::string_view text, int last) {
  std::vector<std::string_view> lines;
  while (static_cast<int>(lines.size()) < last) {
    const size_t end = text.find('\n');
    lines.push_back(text.substr(0, end));
    if (end == text.npos) break;
    text.remove_prefix(end + 1);
  }
  return lines;
}

/// The place of the first character that is no blank; npos in an empty line or a comment.
size_t Indent(std::string_view line) {
  const size_t first = line.find_first_not_of(kBlanks);
  return first != line.npos && line[first] == '#' ? line.npos : first;
}

bool IsOneOf(char c, std::string_view characters) {
  return characters.find(c) != characters.npos;
}

bool IsSlashes(std::string_view two) {
  return two == "//" || two == "/*";
}

/// Where `//` or `/*` begins outside of quotes and before a comment; npos if it does not.
size_t FindSlashes(std::string_view line) {
  char quote = 0;
  for (size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    const bool begins = i == 0 || IsOneOf(line[i - 1], " \t{[,:");
    if (quote != 0) {
      if (c == quote) quote = 0;
    } else if ((c == '"' || c == '\'') && begins) {
      quote = c;
    } else if (c == '#' && begins) {
      return line.npos;
    } else if (begins && !(i > 0 && line[i - 1] == ':') && IsSlashes(line.substr(i, 2))) {
      return i;
    }
  }
  return line.npos;
}

/// "key:value": where the value begins; npos if the line is not of that form.
size_t FindMissingBlank(std::string_view line) {
  const size_t first = Indent(line);
  if (first == line.npos || IsOneOf(line[first], "\"'{[-")) return line.npos;
  const size_t colon = line.find(':', first);
  const bool missing = colon != line.npos && colon + 1 < line.size() &&
                       !IsOneOf(line[colon + 1], kBlanks) && line.find(": ", first) == line.npos;
  return missing ? colon + 1 : line.npos;
}

bool OpensBlock(std::string_view line) {
  const size_t last = line.substr(0, line.find(" #")).find_last_not_of(kBlanks);
  return last == line.npos || IsOneOf(line[last], ":-{[,|>");
}

/// A level of indentation and a line that has it.
struct Level {
  size_t indent;
  int line;
};

/// The levels that are open above the last line, innermost last.
std::vector<Level> OpenLevels(const std::vector<std::string_view>& lines) {
  std::vector<Level> open;
  for (size_t i = 0; i + 1 < lines.size(); ++i) {
    const size_t indent = Indent(lines[i]);
    if (indent == lines[i].npos) continue;
    while (!open.empty() && open.back().indent >= indent) open.pop_back();
    open.push_back({indent, static_cast<int>(i) + 1});
  }
  return open;
}

std::string Blanks(size_t count) {
  return fmt::format("{} blank{}", count, count == 1 ? "" : "s");
}

/// What is wrong with the indentation of the last line.
std::optional<std::string> ExplainIndent(const std::vector<std::string_view>& lines) {
  const size_t indent = lines.empty() ? std::string_view::npos : Indent(lines.back());
  const std::vector<Level> open = OpenLevels(lines);
  if (indent == std::string_view::npos || open.empty()) return {};
  const Level& above = open.back();
  if (indent > above.indent) {
    if (OpensBlock(lines[above.line - 1])) return {};
    return fmt::format(
        "this line is indented by {}, deeper than line {} ({}), which has its value already; "
        "indent both alike",
        Blanks(indent), above.line, above.indent);
  }
  std::vector<std::string> levels;
  for (const Level& level : open) {
    if (level.indent == indent) return {};
    levels.push_back(fmt::format("{} as line {}", level.indent, level.line));
  }
  return fmt::format("this line is indented by {}, which fits no line above; indent it by {}",
                     Blanks(indent), fmt::join(levels, " or "));
}

/// The last line for which `find` gives a place.
template <typename Find>
std::optional<YamlSlip> LastLine(const std::vector<std::string_view>& lines, Find find,
                                 std::string_view message) {
  for (size_t i = lines.size(); i-- > 0;) {
    const size_t at = find(lines[i]);
    if (at == std::string_view::npos) continue;
    return YamlSlip{static_cast<int>(i) + 1, static_cast<int>(at) + 1, std::string(message)};
  }
  return {};
}

/// Where a tab stands before the first character that is no blank.
size_t FindTab(std::string_view line) {
  const size_t tab = line.find('\t');
  const size_t first = Indent(line);
  return first != line.npos && tab < first ? tab : line.npos;
}

/// The line at which the parser stopped and the line with something in it before.
std::vector<std::string_view> OnlyLastTwo(std::vector<std::string_view> lines) {
  size_t kept = 0;
  for (size_t i = lines.size(); i-- > 0;) {
    if (Indent(lines[i]) == lines[i].npos || kept == 2) {
      lines[i] = {};
    } else {
      ++kept;
    }
  }
  return lines;
}

}  // namespace

std::optional<YamlSlip> ExplainYaml(std::string_view text, int stopped_at) {
  const std::vector<std::string_view> lines = LinesUpTo(text, stopped_at);
  if (auto slip = LastLine(lines, FindSlashes, kSlashComment)) return slip;
  if (auto slip = LastLine(lines, FindTab,
                           "this line is indented with a tab, which YAML does not take; replace "
                           "the tabs at its beginning by blanks")) {
    return slip;
  }
  if (auto slip = LastLine(OnlyLastTwo(lines), FindMissingBlank,
                           "a blank is missing after ':', as in 'key: value'")) {
    return slip;
  }
  const std::optional<std::string> message = ExplainIndent(lines);
  if (!message) return {};
  return YamlSlip{static_cast<int>(lines.size()), static_cast<int>(Indent(lines.back())) + 1,
                  *message};
}

int SlashComment(std::string_view text, int line) {
  const std::vector<std::string_view> lines = LinesUpTo(text, line);
  if (line < 1 || static_cast<int>(lines.size()) < line) return 0;
  const size_t at = FindSlashes(lines.back());
  return at == std::string_view::npos ? 0 : static_cast<int>(at) + 1;
}

}  // namespace vmech
