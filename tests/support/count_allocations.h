#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <cstddef>
#include <cstdlib>

// Counts every allocation of a program, Eigen's own included, by standing in for malloc. For one
// source file of a test program, and none of a build with a sanitizer, which brings an allocator of
// its own.

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#error "sanitizers bring an allocator of their own"
#endif

namespace vmech {
inline std::atomic<long> allocations{0};
}  // namespace vmech

// RealtimeSanitizer watches malloc itself, where it may not be called: there nothing is counted.
#if defined(__has_feature)
#define VMECH_MALLOC_IS_WATCHED __has_feature(realtime_sanitizer)
#else
#define VMECH_MALLOC_IS_WATCHED 0
#endif

#if !VMECH_MALLOC_IS_WATCHED
extern "C" {
void* __libc_malloc(std::size_t size);  // NOLINT: glibc's name
void* malloc(std::size_t size) {
  ++vmech::allocations;
  return __libc_malloc(size);
}
}

// Without this a program whose allocations are not counted would pass for one without any.
TEST(Allocations, AreCounted) {
  const long before = vmech::allocations;
  void* volatile block = malloc(100);
  EXPECT_EQ(vmech::allocations - before, 1);
  free(block);
}
#endif
