#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "vmech/mechanisms/files/document.h"

namespace vmech {

/// A table of numbers in a text file: names of columns in the first line, values kept apart by
/// commas below; blank lines and those that begin with # are passed over. Not accepted: rows of
/// another length, values that are not finite numbers, a first column that does not increase.
struct CsvTable {
  std::string file;                          ///< for messages
  std::vector<std::string> names;            ///< of columns, unique
  int names_line = 0;                        ///< in the file, counted from 1
  std::vector<std::vector<double>> columns;  ///< [names, rows] the values
  std::vector<int> lines;                    ///< [rows] line of each in the file, from 1

  size_t rows() const { return lines.size(); }  ///< rows of values
  /// A column by its name; null if there is none.
  const std::vector<double>* Find(std::string_view name) const;
};

/// The largest table that is read [bytes].
constexpr size_t kMaxTableBytes = size_t{256} << 20;

/// A text as a cell of a CSV file, on one line and quoted where it must be. One that a spreadsheet
/// would run as a formula - it begins with = + - @, a tab or a line break, and is no number - gets
/// an apostrophe before it, by which spreadsheets know a text.
std::string CsvCell(std::string_view text);

/// Reads a table from the text of a file; `name` stands for the file in messages.
/// @throws FileErrors with everything that is wrong.
CsvTable ParseCsvTable(std::string_view text, const std::string& name);

}  // namespace vmech
