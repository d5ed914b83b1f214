#pragma once

#include <atomic>

#include "vmech/hw_interface/loop/runner.h"

namespace vmech {

/// While it lives, Ctrl-C and SIGTERM end a run, with the motors off and the report printed.
class InterruptScope {
 public:
  /// Stops the runner.
  explicit InterruptScope(Runner* runner);
  /// Sets the flag.
  explicit InterruptScope(std::atomic<bool>* flag);
  ~InterruptScope();
  InterruptScope(const InterruptScope&) = delete;
  InterruptScope& operator=(const InterruptScope&) = delete;
};

}  // namespace vmech
