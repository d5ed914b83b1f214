#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "vmech/comparison/result.h"

namespace vmech {

/// The results of a comparison as they come in, one line each in DIR/rows.jsonl. A line is written
/// whole or, if the program is killed meanwhile, cut off and passed over: nothing but the row in
/// flight is ever lost. The first line says which suite and which build of vmech the rows are of.
class Journal {
 public:
  /// What rows must have in common to stand beside each other.
  struct Origin {
    uint64_t suite = 0;    ///< Suite::digest
    uint64_t program = 0;  ///< DigestOfThisProgram
    std::string version;
  };

  /// Opens the journal of a folder, or begins one, and reads what is there.
  /// @throws FileErrors if its rows are of another suite or build, if it is damaged, cannot be
  ///         written, or if another process is writing it.
  Journal(const std::filesystem::path& folder, const Origin& origin, const Suite& suite);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  const std::vector<Result>& found() const { return found_; }
  /// @throws FileErrors if it cannot be written.
  void Append(const Result& result);

  static constexpr const char* kFileName = "rows.jsonl";

 private:
  [[noreturn]] void Refuse(const std::string& message) const;
  void Open();
  void Read(const Origin& origin, const Suite& suite);
  void CheckOrigin(std::string_view line, const Origin& origin) const;
  void Write(const std::string& line);

  std::filesystem::path path_;
  int file_ = -1;
  std::vector<Result> found_;
};

}  // namespace vmech
