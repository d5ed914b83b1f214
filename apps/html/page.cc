#include "vmech/apps/html/page.h"

#include <fmt/format.h>

#include <stdexcept>

#include "page_style.h"

namespace vmech::html {
namespace {

std::string_view ClassOf(Tone tone) {
  switch (tone) {
    case Tone::kGood:
      return "good";
    case Tone::kWarning:
      return "warning";
    case Tone::kBad:
      return "bad";
    case Tone::kNeutral:
      break;
  }
  return "neutral";
}

void AppendRow(std::string_view tag, const Table& table, const std::vector<Markup>& cells,
               std::string* html) {
  *html += "<tr>";
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::string_view css = table.columns[i].numeric ? "number" : "";
    *html += Element(tag, cells[i], css).html();
  }
  *html += "</tr>\n";
}

}  // namespace

Markup Heading(int level, const Markup& text) {
  return Element(fmt::format("h{}", level), text) + Markup::Raw("\n");
}

Markup Paragraph(const Markup& text) {
  return Element("p", text) + Markup::Raw("\n");
}

Markup BulletList(const std::vector<Markup>& items) {
  Markup list;
  for (const Markup& item : items) list += Element("li", item);
  return Element("ul", list) + Markup::Raw("\n");
}

Markup ListOrParagraph(const std::vector<Markup>& items) {
  return items.size() == 1 ? Paragraph(items.front()) : BulletList(items);
}

Markup Badge(const Markup& word, Tone tone) {
  return Element("span", word, fmt::format("badge {}", ClassOf(tone)));
}

Markup Notice(const Markup& content, Tone tone) {
  return Element("div", content, fmt::format("notice {}", ClassOf(tone))) + Markup::Raw("\n");
}

Markup Details(const Markup& summary, const Markup& content) {
  return Element("details", Element("summary", summary) + content) + Markup::Raw("\n");
}

Markup ScreenDetails(const Markup& summary, const Markup& content) {
  return Element("details", Element("summary", summary) + content, "screen") + Markup::Raw("\n");
}

Markup Figure(const Markup& drawing, const Markup& caption) {
  return Element("figure", caption.empty() ? drawing : drawing + Element("figcaption", caption)) +
         Markup::Raw("\n");
}

Markup FigureRow(const std::vector<Markup>& figures) {
  Markup row;
  for (const Markup& figure : figures) row += figure;
  return Element("div", row, "figures") + Markup::Raw("\n");
}

Markup Tiles(const std::vector<Tile>& tiles) {
  Markup all;
  for (const Tile& tile : tiles) {
    Markup value = tile.value;
    if (!tile.unit.empty()) value += Markup::Raw("&#160;") + Element("small", tile.unit);
    all += Element("div",
                   Element("div", tile.label, "label") + Element("div", value, "value") +
                       Element("div", tile.remark, "remark"),
                   "tile");
  }
  return Element("div", all, "tiles") + Markup::Raw("\n");
}

Markup RenderTable(const Table& table) {
  std::string html = "<div class=\"scroll\"><table>";
  if (!table.caption.empty()) html += Element("caption", table.caption).html();
  std::vector<Markup> headers;
  for (const Column& column : table.columns) headers.push_back(column.header);
  html += "<thead>";
  AppendRow("th", table, headers, &html);
  html += "</thead>\n<tbody>";
  for (const std::vector<Markup>& row : table.rows) {
    if (row.size() != table.columns.size()) {
      throw std::invalid_argument(fmt::format("table row has {} cells, the table {} columns",
                                              row.size(), table.columns.size()));
    }
    AppendRow("td", table, row, &html);
  }
  return Markup::Raw(html + "</tbody></table></div>\n");
}

std::string RenderPage(std::string_view title, const Markup& body, std::string_view style) {
  std::string page = "<!DOCTYPE html>\n<html lang=\"en\" xmlns=\"http://www.w3.org/1999/xhtml\">\n";
  page.reserve(page.size() + body.html().size() + kPageStyle.size() + style.size() + 512);
  page += "<head><meta charset=\"utf-8\"/>";
  page += "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>";
  page.append("<title>").append(EscapeText(title)).append("</title>\n");
  page.append("<style>").append(kPageStyle).append(style).append("</style></head>\n");
  page.append("<body><main>\n").append(body.html()).append("</main></body></html>\n");
  return page;
}

}  // namespace vmech::html
