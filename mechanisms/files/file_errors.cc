#include "vmech/mechanisms/files/file_errors.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <numeric>

#include "vmech/base/text/printable_text.h"

namespace vmech {
namespace {

std::string Join(const std::vector<FileError>& errors) {
  std::string text;
  for (const FileError& error : errors) {
    if (!text.empty()) text += '\n';
    text += ToString(error);
  }
  return text;
}

/// Edits that turn a into b: insert, delete or change a character, or swap two neighbours
/// (optimal string alignment). Three rows of the table are enough.
size_t EditDistance(std::string_view a, std::string_view b) {
  std::vector<size_t> before(b.size() + 1), previous(b.size() + 1), row(b.size() + 1);
  std::iota(row.begin(), row.end(), size_t{0});
  for (size_t i = 1; i <= a.size(); ++i) {
    before.swap(previous);
    previous.swap(row);
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      row[j] =
          std::min({previous[j] + 1, row[j - 1] + 1, previous[j - 1] + (a[i - 1] != b[j - 1])});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
    }
  }
  return row[b.size()];
}

}  // namespace

std::string ToString(const FileError& error) {
  std::string text = error.file;
  if (error.line > 0) text += fmt::format(":{}:{}", error.line, error.column);
  if (!error.path.empty()) text += ": " + error.path;
  return text + ": " + error.message;
}

FileErrors::FileErrors(std::vector<FileError> errors)
    : std::runtime_error(Join(errors)), errors_(std::move(errors)) {}

FileErrors::FileErrors(std::string file, std::string message)
    : FileErrors(std::vector<FileError>{{std::move(file), 0, 0, "", std::move(message)}}) {}

std::string ReadTextFile(const std::filesystem::path& path, size_t max_bytes) {
  std::ifstream stream(path, std::ios::binary);
  std::error_code ignored;
  if (!stream || std::filesystem::is_directory(path, ignored)) {
    throw FileErrors(path.string(), "cannot be opened as a file");
  }
  std::string text;
  std::array<char, 1 << 16> chunk;
  do {
    stream.read(chunk.data(), chunk.size());
    text.append(chunk.data(), static_cast<size_t>(stream.gcount()));
  } while (stream && text.size() <= max_bytes);
  if (stream.bad()) throw FileErrors(path.string(), "cannot be read");
  if (text.size() > max_bytes) {
    throw FileErrors(path.string(), fmt::format("larger than {} MB", max_bytes >> 20));
  }
  return text;
}

std::string DidYouMean(std::string_view word, std::span<const std::string> candidates) {
  const std::string* best = nullptr;
  size_t best_distance = std::max<size_t>(1, word.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    const size_t difference =
        std::max(word.size(), candidate.size()) - std::min(word.size(), candidate.size());
    if (difference >= best_distance) continue;
    const size_t distance = EditDistance(word, candidate);
    if (distance < best_distance) best_distance = distance, best = &candidate;
  }
  return best ? "; did you mean " + Quoted(*best) + "?" : "";
}

std::string Quoted(std::string_view text) {
  constexpr size_t kLongest = 60;
  size_t length = std::min(text.size(), kLongest);
  while (length < text.size() && (text[length] & 0xC0) == 0x80) --length;  // whole characters
  std::string shown = PrintableText(text.substr(0, length));
  for (char& c : shown) {
    if (c == '\n' || c == '\t') c = ' ';
  }
  return "'" + shown + (length < text.size() ? "...'" : "'");
}

}  // namespace vmech
