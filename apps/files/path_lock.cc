#include "vmech/apps/files/path_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <fstream>
#include <string>
#include <system_error>

#include "vmech/mechanisms/files/document.h"

namespace vmech {
namespace {

/// The process that holds a lock on an open file, by the kernel's table of locks, as " (process
/// 123)"; empty if it does not tell.
std::string HolderOf(int file) {
  struct stat status;
  if (fstat(file, &status) != 0) return "";
  std::ifstream locks("/proc/locks");
  for (std::string line; std::getline(locks, line);) {
    int process = 0;
    unsigned major = 0, minor = 0;
    unsigned long long inode = 0;
    const bool lock = std::sscanf(line.c_str(), "%*d: FLOCK %*s %*s %d %x:%x:%llu", &process,
                                  &major, &minor, &inode) == 4;
    if (!lock || inode != status.st_ino || process <= 0) continue;
    if (makedev(major, minor) == status.st_dev) return fmt::format(" (process {})", process);
  }
  return "";
}

/// False if the path leads elsewhere by now: the one who had the lock has put another in its place.
bool IsAt(const std::filesystem::path& path, int file) {
  struct stat opened, there;
  return fstat(file, &opened) == 0 && stat(path.c_str(), &there) == 0 &&
         opened.st_dev == there.st_dev && opened.st_ino == there.st_ino;
}

}  // namespace

PathLock::PathLock(const std::filesystem::path& path, int flags,
                   const std::filesystem::path& shown) {
  do {
    if (file_ >= 0) close(file_);
    file_ = open(path.c_str(), flags | O_CLOEXEC, 0666);
    if (file_ < 0) throw std::system_error(errno, std::generic_category());
    if (flock(file_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      const std::string holder = HolderOf(file_);
      close(file_);
      throw FileErrors(shown.string(),
                       fmt::format("another vmech{} is writing here; wait for it or end it, or "
                                   "give another place with --out",
                                   holder));
    }
  } while (!IsAt(path, file_));
}

PathLock::~PathLock() {
  if (file_ >= 0) close(file_);
}

}  // namespace vmech
