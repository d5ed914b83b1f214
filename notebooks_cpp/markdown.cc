#include "markdown.h"

#include <cctype>
#include <string>
#include <vector>

#include "formula.h"
#include "text_lines.h"
#include "vmech/apps/html/page.h"

namespace vmech {
namespace {

using html::Markup;
using Text = std::string_view;

Markup RenderInline(Text text);

/// The text between `mark` at the start of `text` and its next occurrence, without space at its
/// ends; nothing if there is none.
bool TakeEnclosed(Text* text, Text mark, Text* content) {
  if (text->substr(0, mark.size()) != mark) return false;
  const std::size_t end = text->find(mark, mark.size());
  if (end == Text::npos || end == mark.size()) return false;
  *content = text->substr(mark.size(), end - mark.size());
  if (content->front() == ' ' || content->back() == ' ') return false;
  text->remove_prefix(end + mark.size());
  return true;
}

bool TakeLink(Text* text, Markup* link) {
  const std::size_t middle = text->find("](");
  const std::size_t end = text->find(')');
  if (text->front() != '[' || middle == Text::npos || end == Text::npos || end < middle) {
    return false;
  }
  const Markup target = text->substr(middle + 2, end - middle - 2);
  *link = Markup::Raw("<a href=\"" + target.html() + "\">") +
          RenderInline(text->substr(1, middle - 1)) + Markup::Raw("</a>");
  text->remove_prefix(end + 1);
  return true;
}

Markup RenderInline(Text text) {
  Markup line;
  while (!text.empty()) {
    Text content;
    Markup link;
    if (TakeEnclosed(&text, "`", &content)) {
      line += html::Element("code", content);
    } else if (TakeEnclosed(&text, "$", &content)) {
      line += RenderFormula(content, FormulaStyle::kInline);
    } else if (TakeEnclosed(&text, "**", &content)) {
      line += html::Element("strong", RenderInline(content));
    } else if (TakeEnclosed(&text, "*", &content)) {
      line += html::Element("em", RenderInline(content));
    } else if (TakeLink(&text, &link)) {
      line += link;
    } else {
      const std::size_t plain = std::min(text.find_first_of("`$*[", 1), text.size());
      line += text.substr(0, plain);
      text.remove_prefix(plain);
    }
  }
  return line;
}

Text Trimmed(Text text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

std::size_t BulletLength(Text line) {
  if (line.substr(0, 2) == "- ") return 2;
  std::size_t digits = 0;
  while (digits < line.size() && std::isdigit(static_cast<unsigned char>(line[digits]))) ++digits;
  return digits > 0 && line.substr(digits, 2) == ". " ? digits + 2 : 0;
}

std::vector<Text> TableCells(Text row) {
  row = Trimmed(row);
  row.remove_prefix(1);
  std::vector<Text> cells;
  while (!row.empty()) {
    const std::size_t end = std::min(row.find('|'), row.size());
    cells.push_back(Trimmed(row.substr(0, end)));
    row.remove_prefix(std::min(end + 1, row.size()));
  }
  return cells;
}

/// Takes blocks off the front of a list of lines.
class BlockReader {
 public:
  explicit BlockReader(Text text) : lines_(Lines(text)) {}

  Markup Read() {
    Markup blocks;
    while (at_ < lines_.size()) {
      if (Trimmed(lines_[at_]).empty()) {
        ++at_;
      } else {
        blocks += Block();
      }
    }
    return blocks;
  }

 private:
  Markup Block() {
    const Text line = lines_[at_];
    if (line.front() == '#') return Heading();
    if (line.substr(0, 3) == "```") return Code();
    if (Trimmed(line) == "$$") return Display();
    if (line.front() == '|') return TableBlock();
    if (BulletLength(line) > 0) return List();
    return html::Paragraph(RenderInline(Join()));
  }

  bool InParagraph() const {
    if (at_ >= lines_.size()) return false;
    const Text line = lines_[at_];
    return !Trimmed(line).empty() && line.front() != '#' && line.front() != '|' &&
           line.substr(0, 3) != "```" && Trimmed(line) != "$$" && BulletLength(line) == 0;
  }

  /// This line and those that continue it.
  std::string Join() {
    std::string text(Trimmed(lines_[at_++]));
    while (InParagraph()) text.append(" ").append(Trimmed(lines_[at_++]));
    return text;
  }

  Markup Heading() {
    const Text line = lines_[at_++];
    const std::size_t level = std::min(line.find_first_not_of('#'), line.size());
    return html::Heading(static_cast<int>(level), RenderInline(Trimmed(line.substr(level))));
  }

  /// The lines up to the one that is `end`.
  std::string Until(Text end) {
    std::string text;
    for (++at_; at_ < lines_.size() && Trimmed(lines_[at_]) != end; ++at_) {
      text.append(lines_[at_]).append("\n");
    }
    ++at_;
    return text;
  }

  Markup Code() { return html::Element("pre", html::Element("code", Until("```"))); }

  Markup Display() {
    return html::Element("div", RenderFormula(Until("$$"), FormulaStyle::kDisplay), "formula");
  }

  Markup List() {
    const bool bullets = lines_[at_].front() == '-';
    Markup items;
    while (at_ < lines_.size() && BulletLength(lines_[at_]) > 0) {
      lines_[at_].remove_prefix(BulletLength(lines_[at_]));
      items += html::Element("li", RenderInline(Join()));
    }
    return html::Element(bullets ? "ul" : "ol", items);
  }

  Markup TableBlock() {
    html::Table table;
    for (const Text header : TableCells(lines_[at_])) {
      table.columns.push_back({RenderInline(header)});
    }
    ++at_;
    for (; at_ < lines_.size() && lines_[at_].substr(0, 1) == "|"; ++at_) {
      const std::vector<Text> cells = TableCells(lines_[at_]);
      if (table.rows.empty() && lines_[at_].find("--") != Text::npos) {
        MarkNumericColumns(cells, &table);
        continue;
      }
      table.rows.emplace_back();
      for (const Text cell : cells) table.rows.back().push_back(RenderInline(cell));
    }
    return html::RenderTable(table);
  }

  /// The rule below the header: `--:` stands below a column of numbers.
  static void MarkNumericColumns(const std::vector<Text>& rule, html::Table* table) {
    for (std::size_t i = 0; i < rule.size() && i < table->columns.size(); ++i) {
      table->columns[i].numeric = !rule[i].empty() && rule[i].back() == ':';
    }
  }

  std::vector<Text> lines_;
  std::size_t at_ = 0;
};

}  // namespace

Markup RenderMarkdown(std::string_view text) {
  return BlockReader(text).Read();
}

}  // namespace vmech
