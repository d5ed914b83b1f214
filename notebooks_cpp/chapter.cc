#include "chapter.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <stdexcept>

#include "highlight.h"
#include "markdown.h"
#include "text_lines.h"
#include "vmech/apps/html/page.h"

namespace vmech {
namespace {

using html::Markup;

constexpr std::string_view kMarker = "//%%";

/// Text of a comment line: after the slashes and one space.
std::string_view CommentText(std::string_view line) {
  line.remove_prefix(std::min(line.find_first_not_of(' '), line.size()));
  if (line.substr(0, 2) == "//") line.remove_prefix(2);
  if (!line.empty() && line.front() == ' ') line.remove_prefix(1);
  return line;
}

std::string WithoutCommonIndentation(const std::vector<std::string_view>& lines) {
  std::size_t common = std::string_view::npos;
  for (const std::string_view line : lines) {
    common = std::min(common, line.find_first_not_of(' '));
  }
  std::string text;
  for (const std::string_view line : lines) {
    text.append(line.substr(std::min(common, line.size()))).append("\n");
  }
  return text;
}

std::string CellText(bool markdown, std::vector<std::string_view> lines) {
  const auto blank = [](std::string_view line) {
    return line.find_first_not_of(' ') == std::string_view::npos;
  };
  while (!lines.empty() && blank(lines.back())) lines.pop_back();
  while (!lines.empty() && blank(lines.front())) lines.erase(lines.begin());
  if (!markdown) return WithoutCommonIndentation(lines);
  std::string text;
  for (const std::string_view line : lines) text.append(CommentText(line)).append("\n");
  return text;
}

Markup RenderOutput(const Output& output) {
  if (output.kind == "html") return Markup::Raw(output.content);
  if (output.kind == "text") return html::Element("pre", output.content, "output");
  const bool holds = output.kind == "holds";
  return html::Element(
      "p",
      html::Badge(holds ? "holds" : "fails", holds ? html::Tone::kGood : html::Tone::kBad) + " " +
          Markup(output.content),
      "check");
}

}  // namespace

std::vector<Cell> SplitIntoCells(std::string_view source) {
  std::vector<Cell> cells;
  std::vector<std::string_view> lines;
  int number = 0;
  const auto finish = [&] {
    if (!cells.empty()) cells.back().text = CellText(cells.back().markdown, lines);
    lines.clear();
  };
  for (const std::string_view line : Lines(source)) {
    ++number;
    const std::string_view trimmed =
        line.substr(std::min(line.find_first_not_of(' '), line.size()));
    if (trimmed.substr(0, kMarker.size()) != kMarker) {
      lines.push_back(line);
      continue;
    }
    finish();
    cells.push_back({trimmed.find("[markdown]") != std::string_view::npos,
                     trimmed.find("\"remove-cell\"") != std::string_view::npos, number, ""});
  }
  finish();
  return cells;
}

std::vector<Output> ParseOutputs(std::string_view records) {
  std::vector<Output> outputs;
  while (!records.empty()) {
    const std::string_view header = records.substr(0, records.find('\n'));
    const std::size_t first = header.find(' '), second = header.rfind(' ');
    Output output;
    std::size_t size = records.size();
    if (first < second && second < header.size()) {
      std::from_chars(header.data(), header.data() + first, output.line);
      std::from_chars(header.data() + second + 1, header.data() + header.size(), size);
    }
    if (output.line <= 0 || header.size() + size + 2 > records.size()) {
      throw std::runtime_error(fmt::format("damaged result record '{}'", header));
    }
    output.kind = header.substr(first + 1, second - first - 1);
    output.content = records.substr(header.size() + 1, size);
    records.remove_prefix(header.size() + size + 2);
    outputs.push_back(std::move(output));
  }
  return outputs;
}

std::string TitleOf(const std::vector<Cell>& cells) {
  for (const Cell& cell : cells) {
    if (cell.markdown && cell.text.rfind("# ", 0) == 0) {
      return cell.text.substr(2, cell.text.find('\n') - 2);
    }
  }
  throw std::runtime_error("the chapter's first text cell has no heading '# ...'");
}

Markup RenderChapter(const std::vector<Cell>& cells, const std::vector<Output>& outputs) {
  Markup body;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const Cell& cell = cells[i];
    if (!cell.hidden) {
      body += cell.markdown
                  ? RenderMarkdown(cell.text)
                  : html::Element("pre", html::Element("code", HighlightCpp(cell.text)), "cell");
    }
    const int end = i + 1 < cells.size() ? cells[i + 1].first_line : 1 << 30;
    for (const Output& output : outputs) {
      if (output.line >= cell.first_line && output.line < end) body += RenderOutput(output);
    }
  }
  return body;
}

}  // namespace vmech
