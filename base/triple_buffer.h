#pragma once

#include <array>
#include <atomic>

namespace vmech {

/// The newest value from one thread to another, neither of which ever waits: the writer fills
/// `back` and publishes it, the reader takes what was published last. Values are made before and
/// never move.
template <typename T>
class TripleBuffer {
 public:
  /// All three, so that they have its size.
  explicit TripleBuffer(const T& value) : values_{value, value, value} {}

  // The writer:
  T& back() noexcept { return values_[back_]; }  ///< to be filled by the writer
  /// What is in back() is the newest.
  void Publish() noexcept { back_ = middle_.exchange(back_ | kFresh) & kIndex; }
  /// Has the reader taken what was published last?
  bool wanted() const noexcept { return (middle_.load(std::memory_order_relaxed) & kFresh) == 0; }

  // The reader:
  /// The reader's, until the next Take.
  const T& front() const noexcept { return values_[front_]; }
  /// False if nothing has been published since the last call.
  bool Take() noexcept {
    if ((middle_.load(std::memory_order_relaxed) & kFresh) == 0) return false;
    front_ = middle_.exchange(front_) & kIndex;
    return true;
  }

 private:
  static constexpr unsigned kFresh = 4, kIndex = 3;

  std::array<T, 3> values_;
  unsigned back_ = 0, front_ = 1;
  std::atomic<unsigned> middle_ = 2;
};

}  // namespace vmech
