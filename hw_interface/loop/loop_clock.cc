#include "vmech/hw_interface/loop/loop_clock.h"

#include <time.h>

namespace vmech {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

}  // namespace

std::int64_t WallClock::Now() noexcept {
  timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return t.tv_sec * kSecond + t.tv_nsec;
}

void WallClock::SleepUntil(std::int64_t time_ns) noexcept {
  const std::int64_t wake = time_ns - spin_ns_;
  timespec t;
  t.tv_sec = wake / kSecond;
  t.tv_nsec = wake % kSecond;
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr) != 0) {
  }
  while (Now() < time_ns) {
  }
}

}  // namespace vmech
