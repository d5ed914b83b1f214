#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace vmech {

/// Makes an interruption from outside (SIGINT, SIGTERM, SIGHUP) remove what is unfinished before
/// it ends the process. One at a time.
class InterruptCleanup {
 public:
  /// Files that are removed, if they are there, and then folders, if they are empty.
  InterruptCleanup(const std::vector<std::filesystem::path>& files,
                   const std::vector<std::filesystem::path>& folders);
  ~InterruptCleanup();
  InterruptCleanup(const InterruptCleanup&) = delete;
  InterruptCleanup& operator=(const InterruptCleanup&) = delete;

  void Run() const noexcept;  ///< safe in a signal handler

 private:
  std::vector<std::string> files_, folders_;
  pid_t owner_;
};

/// Lets interruptions wait while it lives, for work that is to be done whole.
class InterruptsWait {
 public:
  InterruptsWait();
  ~InterruptsWait();
  InterruptsWait(const InterruptsWait&) = delete;
  InterruptsWait& operator=(const InterruptsWait&) = delete;
};

}  // namespace vmech
