#pragma once

#include <atomic>
#include <cstddef>

// Counts every allocation of a program, Eigen's own included, by standing in for malloc. For one
// source file of a test program, and none of a build with a sanitizer, which brings an allocator of
// its own.

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#error "sanitizers bring an allocator of their own"
#endif

namespace vmech {
inline std::atomic<long> allocations{0};
}  // namespace vmech

extern "C" {
void* __libc_malloc(std::size_t size);  // NOLINT: glibc's name
void* malloc(std::size_t size) {
  ++vmech::allocations;
  return __libc_malloc(size);
}
}
