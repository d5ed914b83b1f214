#pragma once

#include <sched.h>

#include <string>
#include <vector>

namespace vmech {

/// What a real-time loop asks of the operating system.
struct RealtimeOptions {
  bool lock_memory = true;  ///< no page of the process is swapped out
  /// SCHED_FIFO priority, 1..99; 0 leaves the scheduler alone. Not 99: the kernel's own threads
  /// are.
  int priority = 80;

  /// @throws std::invalid_argument naming field, value and range.
  void Validate() const;
};

/// What the machine granted. A timing figure means nothing without it.
struct RealtimeReport {
  bool memory_locked = false;        ///< no page of it is swapped out
  bool fifo = false;                 ///< SCHED_FIFO
  bool preempt_rt = false;           ///< the kernel is a real-time one
  bool flush_to_zero = false;        ///< numbers below 2.2e-308 count as zero, and cost nothing
  std::vector<std::string> refused;  ///< what was asked for and not granted, why, and the remedy

  /// "SCHED_FIFO, memory locked, no real-time kernel; refused: ...".
  std::string BriefReport() const;
};

/// Makes the calling thread a real-time one as far as the machine allows, until it is destroyed:
/// memory locked, stack touched, SCHED_FIFO, flush-to-zero.
class RealtimeScope {
 public:
  /// @throws std::invalid_argument as Validate.
  explicit RealtimeScope(const RealtimeOptions& options);
  ~RealtimeScope();
  RealtimeScope(const RealtimeScope&) = delete;
  RealtimeScope& operator=(const RealtimeScope&) = delete;

  const RealtimeReport& report() const noexcept { return report_; }  ///< of the constructor

 private:
  void LockMemory();
  void Schedule(int priority);

  RealtimeReport report_;
  int old_policy_ = 0;
  sched_param old_parameter_{};
  unsigned old_mode_;  // of floating-point arithmetic
};

/// Flush-to-zero and denormals-are-zero for the calling thread; returns the mode before.
unsigned SetFlushToZero() noexcept;
/// Back to a mode that SetFlushToZero returned.
void RestoreFloatingPoint(unsigned mode) noexcept;

}  // namespace vmech
