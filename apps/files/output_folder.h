#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "vmech/apps/files/path_lock.h"

namespace vmech {

/// What stands beside a file or folder while it is written, under its name and this. What a killed
/// run leaves behind under it goes with the next run that writes the same.
inline constexpr const char* kUnfinished = ".vmech-unfinished";

/// Files put into a folder of the user's: all of them are first written beside their places and
/// then renamed, so that a full disk or an interruption leaves no half-written file. A result that
/// has a folder of its own is a ResultFolder.
class OutputFolder {
 public:
  /// Makes the folder and those above it. @throws FileErrors if that cannot be done.
  explicit OutputFolder(std::filesystem::path folder);
  ~OutputFolder();  ///< removes what was written and not committed, and a folder made for it
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /// @throws FileErrors if it cannot be written, or another process is writing it.
  void Write(const std::string& name, const std::string& text);
  /// Puts all files in their places.
  /// @throws FileErrors if that cannot be done.
  void Commit();

  const std::filesystem::path& path() const { return folder_; }

 private:
  struct Pending {
    std::string name;
    PathLock lock;
  };
  std::filesystem::path Temporary(const std::string& name) const;

  std::filesystem::path folder_;
  bool made_ = false;  ///< the folder did not exist before
  std::vector<Pending> pending_;
};

}  // namespace vmech
