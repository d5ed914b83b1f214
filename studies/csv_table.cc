#include "vmech/studies/csv_table.h"

#include <fmt/format.h>

#include <algorithm>

#include "vmech/base/text/printable_text.h"

namespace vmech {
namespace {

constexpr std::string_view kBlank = " \t\r";
constexpr size_t kMaxErrors = 20;

std::string_view Trimmed(std::string_view text) {
  const size_t begin = std::min(text.find_first_not_of(kBlank), text.size());
  text.remove_prefix(begin);
  return text.substr(0, text.find_last_not_of(kBlank) + 1);
}

/// Reads line by line; collects what is wrong.
class TableParser {
 public:
  explicit TableParser(const std::string& name) { table_.file = name; }

  CsvTable Parse(std::string_view text) {
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    while (!text.empty() && errors_.size() < kMaxErrors) {
      const size_t length = std::min(text.find('\n'), text.size());
      ++line_;
      ParseLine(text.substr(0, length));
      text.remove_prefix(std::min(length + 1, text.size()));
    }
    if (errors_.empty() && table_.rows() == 0) {
      errors_.push_back({table_.file, 0, 0, "", "the table has no rows"});
    }
    if (!errors_.empty()) throw FileErrors(std::move(errors_));
    return std::move(table_);
  }

 private:
  void Error(std::string_view line, std::string_view field, std::string message) {
    const int column = static_cast<int>(field.data() - line.data()) + 1;
    errors_.push_back({table_.file, line_, column, "", std::move(message)});
  }

  void ParseLine(std::string_view line) {
    const std::string_view content = Trimmed(line);
    if (content.empty() || content.front() == '#') return;
    std::vector<std::string_view> fields;
    for (std::string_view rest = line;;) {
      const size_t length = std::min(rest.find(','), rest.size());
      fields.push_back(Trimmed(rest.substr(0, length)));
      if (length == rest.size()) break;
      rest.remove_prefix(length + 1);
    }
    table_.names.empty() ? ParseNames(line, fields) : ParseRow(line, fields);
  }

  void ParseNames(std::string_view line, const std::vector<std::string_view>& fields) {
    table_.names_line = line_;
    for (const std::string_view field : fields) {
      if (field.empty() || field.find_first_of(";\t") != field.npos) {
        Error(line, field, "expected names of columns, kept apart by commas");
      } else if (ParseNumber(field)) {
        Error(line, field, "the first line must name the columns, not give numbers");
      } else if (table_.Find(field)) {
        Error(line, field, "the column " + Quoted(field) + " is given twice");
      }
      table_.names.emplace_back(field);
      table_.columns.emplace_back();
    }
  }

  void ParseRow(std::string_view line, const std::vector<std::string_view>& fields) {
    if (fields.size() != table_.names.size()) {
      Error(line, line,
            fmt::format("expected {} values, as in line {}, not {}", table_.names.size(),
                        table_.names_line, fields.size()));
      return;
    }
    for (size_t i = 0; i < fields.size(); ++i) {
      const std::optional<double> value = ParseNumber(fields[i]);
      if (!value) {
        Error(line, fields[i],
              fmt::format("{}: expected a finite number, not {}", table_.names[i],
                          Quoted(fields[i])));
      }
      table_.columns[i].push_back(value.value_or(0));
    }
    table_.lines.push_back(line_);
    const std::vector<double>& first = table_.columns[0];
    if (errors_.empty() && first.size() > 1 && first[first.size() - 2] >= first.back()) {
      Error(line, fields[0],
            fmt::format("{} must increase from row to row, but {} follows {}", table_.names[0],
                        first.back(), first[first.size() - 2]));
    }
  }

  CsvTable table_;
  int line_ = 0;
  std::vector<FileError> errors_;
};

}  // namespace

const std::vector<double>* CsvTable::Find(std::string_view name) const {
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? nullptr : &columns[found - names.begin()];
}

std::string CsvCell(std::string_view text) {
  const bool formula = !text.empty() &&
                       std::string_view("=+-@\t\r\n").find(text.front()) != text.npos &&
                       !ParseNumber(text);
  std::string cell = (formula ? "'" : "") + PrintableText(text);
  std::replace_if(
      cell.begin(), cell.end(), [](char c) { return c == '\n' || c == '\t'; }, ' ');
  if (cell.find_first_of(",\"") == cell.npos) return cell;
  std::string quoted = "\"";
  for (const char c : cell) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

CsvTable ParseCsvTable(std::string_view text, const std::string& name) {
  return TableParser(name).Parse(text);
}

}  // namespace vmech
