#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace vmech {

/// Files of one result, written together: all of them are first written beside their places and
/// then renamed, so that a full disk or an interruption leaves no half-written file.
class OutputFolder {
 public:
  /// Makes the folder and those above it. @throws FileErrors if that cannot be done.
  explicit OutputFolder(std::filesystem::path folder);
  ~OutputFolder();  ///< removes what was written and not committed, and a folder made for it
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /// @throws FileErrors if it cannot be written.
  void Write(const std::string& name, const std::string& text);
  /// Puts all files in their places.
  /// @throws FileErrors if that cannot be done.
  void Commit();

  const std::filesystem::path& path() const { return folder_; }

 private:
  std::filesystem::path Temporary(const std::string& name) const;

  [[noreturn]] void ThrowUnwritable(const std::string& name) const;

  std::filesystem::path folder_;
  bool made_ = false;  ///< the folder did not exist before
  std::vector<std::string> pending_;
};

}  // namespace vmech
