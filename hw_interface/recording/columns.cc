#include "vmech/hw_interface/recording/columns.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <type_traits>

namespace vmech {
namespace {

template <typename T>
constexpr bool kIsFlag = std::is_same_v<std::remove_const_t<T>, bool>;

/// Collects the columns.
struct Collector {
  template <typename Name, typename T>
  void operator()(const Name& name, const T&) {
    constexpr CellKind kind = std::is_floating_point_v<T> ? CellKind::kNumber
                              : kIsFlag<T>                ? CellKind::kFlag
                                                          : CellKind::kInteger;
    columns.push_back({name(), kind, nullptr});
  }
  template <typename Name, typename T>
  void Named(const Name& name, const ValueNames& names, const T&) {
    columns.push_back({name(), CellKind::kName, &names});
  }
  std::vector<Column> columns;
};

template <typename T>
void AppendNumber(const T& value, std::string* text) {
  std::array<char, 32> digits;
  const auto end = [&] {
    if constexpr (kIsFlag<T>) {
      return std::to_chars(digits.begin(), digits.end(), static_cast<int>(value)).ptr;
    } else {
      return std::to_chars(digits.begin(), digits.end(), value).ptr;
    }
  }();
  text->append(digits.begin(), end);
}

/// JSON knows no numbers beyond all: null is none at all, and 1e999 is read as infinite.
void AppendJsonNumber(double value, std::string* text) {
  if (std::isnan(value)) {
    *text += "null";
  } else if (std::isinf(value)) {
    *text += value > 0 ? "1e999" : "-1e999";
  } else {
    AppendNumber(value, text);
  }
}

template <typename T>
const std::string* NameIn(const ValueNames& names, const T& value) {
  const auto index = static_cast<std::uint64_t>(value);
  return index < names.size() ? &names[index] : nullptr;
}

class RowWriter {
 public:
  explicit RowWriter(std::string* text) : text_(text) {}

  template <typename Name, typename T>
  void operator()(const Name&, const T& value) {
    Separate();
    AppendNumber(value, text_);
  }
  template <typename Name, typename T>
  void Named(const Name& name, const ValueNames& names, const T& value) {
    if (const std::string* word = NameIn(names, value)) {
      Separate();
      *text_ += *word;
    } else {
      (*this)(name, static_cast<std::uint64_t>(value));
    }
  }

 private:
  void Separate() {
    if (!first_) *text_ += ',';
    first_ = false;
  }
  std::string* text_;
  bool first_ = true;
};

class MemberWriter {
 public:
  MemberWriter(const std::vector<Column>& columns, std::string* text)
      : columns_(columns), text_(text) {}

  template <typename Name, typename T>
  void operator()(const Name&, const T& value) {
    Key();
    if constexpr (std::is_floating_point_v<T>) {
      AppendJsonNumber(value, text_);
    } else if constexpr (kIsFlag<T>) {
      *text_ += value ? "true" : "false";
    } else {
      AppendNumber(value, text_);
    }
  }
  template <typename Name, typename T>
  void Named(const Name&, const ValueNames& names, const T& value) {
    Key();
    if (const std::string* word = NameIn(names, value)) {
      *text_ += '"' + *word + '"';
    } else {
      AppendNumber(static_cast<std::uint64_t>(value), text_);
    }
  }

 private:
  void Key() {
    if (next_ > 0) *text_ += ',';
    *text_ += '"';
    *text_ += columns_[next_++].name;
    *text_ += "\":";
  }
  const std::vector<Column>& columns_;
  std::string* text_;
  size_t next_ = 0;
};

/// Reads one value after the other. `Cell` takes the next from the text, with the column's name.
class CellReader {
 public:
  CellReader(const std::vector<Column>& columns, std::string_view text, bool members)
      : columns_(columns), rest_(text), members_(members) {}

  template <typename Name, typename T>
  void operator()(const Name&, T& value) {
    Read(Next(), &value);
  }
  template <typename Name, typename T>
  void Named(const Name&, const ValueNames& names, T& value) {
    std::string_view cell = Next();
    if (members_ && cell.size() >= 2 && cell.front() == '"') {
      cell = cell.substr(1, cell.size() - 2);
    }
    const auto found = std::find(names.begin(), names.end(), cell);
    std::uint64_t number = static_cast<std::uint64_t>(found - names.begin());
    if (found == names.end()) Read(cell, &number);
    value = static_cast<T>(number);
  }
  void ExpectEnd() const {
    if (!rest_.empty()) throw std::runtime_error("more values than columns");
  }

 private:
  std::string_view Next() {
    const std::string& name = columns_[next_++].name;
    if (members_) {
      const size_t behind = name.size() + 3;
      const bool is_there = rest_.size() >= behind && rest_[0] == '"' &&
                            rest_.substr(1, name.size()) == name &&
                            rest_.substr(name.size() + 1, 2) == "\":";
      if (!is_there) throw std::runtime_error(fmt::format("'{}' expected", name));
      rest_.remove_prefix(behind);
    }
    const std::string_view cell = rest_.substr(0, rest_.find(','));
    rest_.remove_prefix(std::min(rest_.size(), cell.size() + 1));
    return cell;
  }

  template <typename T>
  void Read(std::string_view cell, T* value) const {
    const auto [end, error] = [&] {
      if constexpr (kIsFlag<T>) {
        *value = cell == "1" || cell == "true";
        const bool sound = *value || cell == "0" || cell == "false";
        return std::from_chars_result{cell.data() + cell.size(),
                                      sound ? std::errc{} : std::errc::invalid_argument};
      } else {
        return std::from_chars(cell.data(), cell.data() + cell.size(), *value);
      }
    }();
    if (error == std::errc{} && end == cell.data() + cell.size()) return;
    if constexpr (std::is_floating_point_v<T>) {
      if (ReadBeyond(cell, value)) return;
    }
    throw std::runtime_error(
        fmt::format("column '{}': '{}' is not a number", columns_[next_ - 1].name, cell));
  }
  bool ReadBeyond(std::string_view cell, double* value) const {
    constexpr double kInfinite = std::numeric_limits<double>::infinity();
    if (cell == "null")
      *value = std::numeric_limits<double>::quiet_NaN();
    else if (cell == "1e999")
      *value = kInfinite;
    else if (cell == "-1e999")
      *value = -kInfinite;
    else
      return false;
    return members_;
  }

  const std::vector<Column>& columns_;
  std::string_view rest_;
  bool members_;
  size_t next_ = 0;
};

void ReadCells(const RecordingHeader& header, CellReader* reader, TickRecord* tick) {
  VisitColumns(header, reader, tick);
  reader->ExpectEnd();
}

}  // namespace

const ValueNames& IoNames() {
  static const ValueNames names = [] {
    ValueNames all;
    for (int i = 0; i <= static_cast<int>(IoStatus::kRefused); ++i) {
      all.emplace_back(NameOf(static_cast<IoStatus>(i)));
    }
    return all;
  }();
  return names;
}

const ValueNames& ForceOffNames() {
  static const ValueNames names = [] {
    ValueNames all;
    for (int i = 0; i <= static_cast<int>(ForceOff::kEnergy); ++i) {
      all.emplace_back(NameOf(static_cast<ForceOff>(i)));
    }
    return all;
  }();
  return names;
}

const ValueNames& StageNames() {
  static const ValueNames names = [] {
    constexpr std::array<const char*, kSafetyStages> kWords{"ramped", "damped", "clamped", "slewed",
                                                            "braked"};
    ValueNames all;
    for (unsigned bits = 0; bits < 1u << kSafetyStages; ++bits) {
      std::string words;
      for (int i = 0; i < kSafetyStages; ++i) {
        if (bits >> i & 1) words += (words.empty() ? "" : "+") + std::string(kWords[i]);
      }
      all.push_back(words.empty() ? "none" : words);
    }
    return all;
  }();
  return names;
}

std::vector<Column> ColumnsOf(const RecordingHeader& header) {
  Collector collector;
  const TickRecord tick = header.EmptyTick();
  VisitColumns(header, &collector, &tick);
  return std::move(collector.columns);
}

void AppendRow(const RecordingHeader& header, const TickRecord& tick, std::string* text) {
  RowWriter writer(text);
  VisitColumns(header, &writer, &tick);
}

void AppendMembers(const RecordingHeader& header, const std::vector<Column>& columns,
                   const TickRecord& tick, std::string* text) {
  MemberWriter writer(columns, text);
  VisitColumns(header, &writer, &tick);
}

void ReadRow(const RecordingHeader& header, const std::vector<Column>& columns,
             std::string_view row, TickRecord* tick) {
  CellReader reader(columns, row, false);
  ReadCells(header, &reader, tick);
}

void ReadMembers(const RecordingHeader& header, const std::vector<Column>& columns,
                 std::string_view members, TickRecord* tick) {
  CellReader reader(columns, members, true);
  ReadCells(header, &reader, tick);
}

}  // namespace vmech
