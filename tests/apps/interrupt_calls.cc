// Loaded before a program (LD_PRELOAD): ends it, or lets the disk be full, at a call that changes
// files. The calls are counted in the first process only, not in its children.
//   VMECH_KILL_AT=N   ends the process by SIGKILL in place of its N-th such call
//   VMECH_FULL_AT=N   the N-th write to a regular file and all after it fail for want of room

#include <dlfcn.h>
#include <fcntl.h>
#include <stdio.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>

namespace {

long NumberFrom(const char* variable) {
  const char* text = getenv(variable);
  return text == nullptr ? 0 : atol(text);
}

const long kill_at = NumberFrom("VMECH_KILL_AT");
const long full_at = NumberFrom("VMECH_FULL_AT");
const pid_t counted = getpid();
std::atomic<long> calls{0}, writes{0};

void Count() {
  if (kill_at == 0 || getpid() != counted || ++calls != kill_at) return;
  kill(counted, SIGKILL);
  for (;;) pause();
}

template <typename Function>
Function* Next(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

bool IsRegular(int file) {
  struct stat status;
  return fstat(file, &status) == 0 && S_ISREG(status.st_mode);
}

}  // namespace

// As the library declares them, without their attributes.
#define VMECH_COUNTED(Result, name, parameters, arguments) \
  extern "C" Result name parameters noexcept {             \
    Count();                                               \
    return Next<Result parameters>(#name) arguments;       \
  }
VMECH_COUNTED(int, rename, (const char* a, const char* b), (a, b))
VMECH_COUNTED(int, renameat2, (int a, const char* b, int c, const char* d, unsigned e),
              (a, b, c, d, e))
VMECH_COUNTED(int, link, (const char* a, const char* b), (a, b))
VMECH_COUNTED(int, unlink, (const char* a), (a))
VMECH_COUNTED(int, remove, (const char* a), (a))
VMECH_COUNTED(int, rmdir, (const char* a), (a))
VMECH_COUNTED(int, mkdir, (const char* a, mode_t b), (a, b))
VMECH_COUNTED(int, fchmod, (int a, mode_t b), (a, b))

extern "C" ssize_t write(int file, const void* data, size_t size) {
  if (IsRegular(file) && getpid() == counted) {
    Count();
    if (full_at > 0 && ++writes >= full_at) {
      errno = ENOSPC;
      return -1;
    }
  }
  return Next<ssize_t(int, const void*, size_t)>("write")(file, data, size);
}
