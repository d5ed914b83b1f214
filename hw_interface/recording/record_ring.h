#pragma once

#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <vector>

#include "vmech/hw_interface/recording/recording.h"

namespace vmech {

/// Ticks on their way from a loop to another thread: one puts, one takes, without locks. Sized
/// once.
class RecordRing {
 public:
  /// Room for at least `size` records of the size of `empty`.
  RecordRing(std::size_t size, const TickRecord& empty) : records_(std::bit_ceil(size), empty) {}

  /// Copies a record in; false if there is no room.
  bool Put(const TickRecord& record) noexcept {
    const std::size_t put = put_.load(std::memory_order_relaxed);
    if (put - taken_.load(std::memory_order_acquire) == records_.size()) return false;
    records_[put & (records_.size() - 1)] = record;
    put_.store(put + 1, std::memory_order_release);
    return true;
  }

  /// The oldest record; null if there is none. It is there until Drop.
  const TickRecord* Oldest() const noexcept {
    const std::size_t taken = taken_.load(std::memory_order_relaxed);
    if (taken == put_.load(std::memory_order_acquire)) return nullptr;
    return &records_[taken & (records_.size() - 1)];
  }
  /// Gives the record of Oldest back. Of the thread that takes.
  void Drop() noexcept {
    taken_.store(taken_.load(std::memory_order_relaxed) + 1, std::memory_order_release);
  }

 private:
  std::vector<TickRecord> records_;
  // Each thread's counter in a cache line of its own, without asking for the line's alignment.
  std::atomic<std::size_t> put_ = 0;
  [[maybe_unused]] std::array<char, 64> apart_{};
  std::atomic<std::size_t> taken_ = 0;
};

}  // namespace vmech
