#pragma once

#include <cstdint>

namespace vmech {

/// The clock of a loop. Monotonic, in nanoseconds from any origin.
class LoopClock {
 public:
  virtual ~LoopClock() = default;
  virtual std::int64_t Now() noexcept = 0;  ///< [ns], never less than before
  /// Returns at or after the given time.
  virtual void SleepUntil(std::int64_t time_ns) noexcept = 0;
};

/// CLOCK_MONOTONIC. It sleeps until shortly before the time and spins the rest.
class WallClock : public LoopClock {
 public:
  /// `spin_ns` of spinning, in [0, 1e6]: hides the latency of waking up, costs processor time.
  explicit WallClock(std::int64_t spin_ns = 0) : spin_ns_(spin_ns) {}
  std::int64_t Now() noexcept override;  ///< CLOCK_MONOTONIC [ns]
  void SleepUntil(std::int64_t time_ns) noexcept override;

 private:
  std::int64_t spin_ns_;
};

/// Time passes only while the loop sleeps, and then at once: a session as fast as it computes, the
/// same bits on every machine.
class FreeRunningClock : public LoopClock {
 public:
  std::int64_t Now() noexcept override { return now_ns_; }  ///< simulated [ns]
  void SleepUntil(std::int64_t time_ns) noexcept override {
    if (time_ns > now_ns_) now_ns_ = time_ns;
  }

 private:
  std::int64_t now_ns_ = 0;
};

}  // namespace vmech
