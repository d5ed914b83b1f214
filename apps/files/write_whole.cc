#include "vmech/apps/files/write_whole.h"

#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace vmech {

void WriteWhole(int file, std::string_view text) {
  while (!text.empty()) {
    const ssize_t count = write(file, text.data(), text.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw std::system_error(errno, std::generic_category());
    text.remove_prefix(static_cast<size_t>(count));
  }
  const bool can_sync = fsync(file) == 0 || errno == EINVAL || errno == EROFS;  // not of a device
  if (!can_sync) throw std::system_error(errno, std::generic_category());
}

}  // namespace vmech
