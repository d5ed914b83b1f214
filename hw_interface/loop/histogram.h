#pragma once

#include <array>
#include <cstdint>

namespace vmech {

/// Counts of durations in buckets that grow with them: eight to each power of two, so that a
/// percentile is right within an eighth. Fixed size, adding costs a few instructions.
class Histogram {
 public:
  void Add(std::int64_t ns) noexcept;  ///< a duration [ns], >= 0

  std::uint64_t count() const noexcept { return count_; }  ///< durations so far
  std::int64_t max() const noexcept { return max_; }       ///< exact [ns]
  double mean() const noexcept;                            ///< exact [ns]
  /// The smallest bucket's upper end [ns] below which a share of all durations lies; 0 if empty.
  std::int64_t Percentile(double share) const noexcept;

 private:
  static constexpr int kPerOctave = 8;
  static constexpr int kBuckets = 60 * kPerOctave;
  static int BucketOf(std::int64_t ns) noexcept;
  static std::int64_t UpperEnd(int bucket) noexcept;

  std::array<std::uint32_t, kBuckets> buckets_{};
  std::uint64_t count_ = 0;
  double sum_ = 0;
  std::int64_t max_ = 0;
};

}  // namespace vmech
