#pragma once

#include <filesystem>
#include <utility>

namespace vmech {

/// A file or folder that one process at a time works on: flock(2), which ends with the process
/// however that ends. File systems without such locks (some network shares) are not locked.
class PathLock {
 public:
  PathLock() = default;
  /// Opens what is at a path, with `flags` of open(2), and locks it. `shown` is its name in
  /// messages.
  /// @throws FileErrors if another process has it locked, with that process's number;
  ///         std::system_error if it cannot be opened.
  PathLock(const std::filesystem::path& path, int flags, const std::filesystem::path& shown);
  ~PathLock();
  PathLock(PathLock&& other) noexcept : file_(std::exchange(other.file_, -1)) {}
  PathLock& operator=(PathLock&& other) noexcept {
    std::swap(file_, other.file_);
    return *this;
  }

  bool held() const { return file_ >= 0; }
  int file() const { return file_; }  ///< the open file

 private:
  int file_ = -1;
};

}  // namespace vmech
