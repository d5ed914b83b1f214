#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "vmech/apps/html/markup.h"

namespace vmech::html {

/// Building blocks of a self-contained HTML page: no scripts, no fonts or images from elsewhere,
/// light and dark, and a print style. The page is well-formed XML as well, so that any tool can
/// read it, and the same input gives the same bytes.

enum class Tone { kNeutral, kGood, kWarning, kBad };

Markup Heading(int level, const Markup& text);
Markup Paragraph(const Markup& text);
Markup BulletList(const std::vector<Markup>& items);
/// A bullet list, or a paragraph if there is one item only.
Markup ListOrParagraph(const std::vector<Markup>& items);
/// A short word in a coloured pill. The word carries the meaning, the colour repeats it.
Markup Badge(const Markup& word, Tone tone);
/// A paragraph set apart, for a warning or a result.
Markup Notice(const Markup& content, Tone tone);
/// Content that is folded away under its summary; printed open.
Markup Details(const Markup& summary, const Markup& content);
/// The same, not printed: long lists to look things up in.
Markup ScreenDetails(const Markup& summary, const Markup& content);
Markup Figure(const Markup& drawing, const Markup& caption = {});
/// Figures side by side where the page is wide enough (it is 1008 CSS pixels), with gaps of 24.
Markup FigureRow(const std::vector<Markup>& figures);

/// A headline number: what it is, its value with unit, and a remark below.
struct Tile {
  Markup label;
  Markup value;
  Markup unit;
  Markup remark;
};
Markup Tiles(const std::vector<Tile>& tiles);

struct Column {
  Markup header;
  bool numeric = false;  ///< right-aligned, figures of equal width
};
struct Table {
  Markup caption;
  std::vector<Column> columns;
  std::vector<std::vector<Markup>> rows;  ///< each of columns.size() cells
};
/// @throws std::invalid_argument if a row has another number of cells than there are columns.
Markup RenderTable(const Table& table);

/// The whole page: `title` for the browser's tab, `body` as made by the functions above. `style` is
/// appended to the page's own style sheet (PlotStyleSheet() of vmech/apps/plot/style.h for plots).
std::string RenderPage(std::string_view title, const Markup& body, std::string_view style = "");

}  // namespace vmech::html
