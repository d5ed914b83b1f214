#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "vmech/apps/html/markup.h"

namespace vmech {

/// A cell of a chapter in the percent format: it begins with a line `//%%`, or `//%% [markdown]`
/// whose text stands in line comments. Tag `remove-cell` keeps a cell out of the page.
struct Cell {
  bool markdown = false;
  bool hidden = false;
  int first_line = 0;  ///< of the marker, counted from 1
  std::string text;    ///< without marker, common indentation and comment slashes
};

/// What is in front of the first marker is not part of any cell.
std::vector<Cell> SplitIntoCells(std::string_view source);

/// A result that a running chapter wrote through Notebook.
struct Output {
  int line = 0;      ///< of the source, from which it was written
  std::string kind;  ///< text, html, holds, fails
  std::string content;
};

/// @throws std::runtime_error if the records are damaged.
std::vector<Output> ParseOutputs(std::string_view records);

/// The title of the page: the first heading of the first text cell.
std::string TitleOf(const std::vector<Cell>& cells);

/// The body of the page: each cell followed by its results, in order.
html::Markup RenderChapter(const std::vector<Cell>& cells, const std::vector<Output>& outputs);

}  // namespace vmech
