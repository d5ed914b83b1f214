#include "vmech/hw_interface/loop/histogram.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace vmech {

/// Below 8 ns each has its own bucket; above, the three bits after the leading one choose it.
int Histogram::BucketOf(std::int64_t ns) noexcept {
  const auto value = static_cast<std::uint64_t>(std::max<std::int64_t>(ns, 0));
  if (value < kPerOctave) return static_cast<int>(value);
  const int octave = std::bit_width(value) - 4;  // value in [8, 16) 2^octave
  return kPerOctave * (octave + 1) + static_cast<int>((value >> octave) & (kPerOctave - 1));
}

std::int64_t Histogram::UpperEnd(int bucket) noexcept {
  if (bucket < kPerOctave) return bucket;
  const int octave = bucket / kPerOctave - 1;
  return ((std::int64_t{kPerOctave} + bucket % kPerOctave + 1) << octave) - 1;
}

void Histogram::Add(std::int64_t ns) noexcept {
  ++buckets_[std::min(BucketOf(ns), kBuckets - 1)];
  ++count_;
  sum_ += static_cast<double>(ns);
  max_ = std::max(max_, ns);
}

double Histogram::mean() const noexcept {
  return count_ > 0 ? sum_ / static_cast<double>(count_) : 0;
}

std::int64_t Histogram::Percentile(double share) const noexcept {
  const auto wanted = static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(count_)));
  std::uint64_t seen = 0;
  for (int bucket = 0; bucket < kBuckets; ++bucket) {
    seen += buckets_[bucket];
    if (seen >= wanted && seen > 0) return std::min(UpperEnd(bucket), max_);
  }
  return 0;
}

}  // namespace vmech
