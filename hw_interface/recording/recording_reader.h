#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "vmech/hw_interface/recording/columns.h"

namespace vmech {

/// Reads a recording tick by tick, in memory that does not grow with it: CSV of format 1 and 2, or
/// MCAP, by what the file begins with. Of a file that was cut short, by a kill or a full disk, all
/// whole ticks are read.
class RecordingReader {
 public:
  /// @throws std::runtime_error with file:line (of MCAP: file, byte), what is wrong there and what
  /// was expected; so does Next.
  explicit RecordingReader(const std::filesystem::path& file);
  ~RecordingReader();

  const RecordingHeader& header() const { return header_; }  ///< valid from the constructor on
  /// The next tick into one that is an EmptyTick of the header. False: there are no more.
  bool Next(TickRecord* tick);

  // After the last.
  bool complete() const;       ///< the session ended in order, and so does the file
  std::uint64_t lost() const;  ///< ticks that are not in it, since the disk was too slow

  /// Where and how rows come from.
  class Source;

 private:
  RecordingHeader header_;
  std::unique_ptr<Source> source_;
  std::vector<Column> columns_;
};

}  // namespace vmech
