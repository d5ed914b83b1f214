#include "vmech/dynamics/loads/pose/pose_arena.h"

#include <sys/mman.h>

#include <algorithm>
#include <cstdlib>

namespace vmech {

// Comes from malloc, which keeps it at hand for the next study. Pages that are new come from the
// kernel one by one, and a small one takes longer to come than to fill: large ones are asked for.
PoseArena::PoseArena(size_t bytes)
    : size_(bytes), block_(static_cast<std::byte*>(std::malloc(std::max<size_t>(bytes, 1)))) {
  if (block_ == nullptr) throw std::bad_alloc();
  constexpr size_t kPage = 4096;
  void* page = block_;
  size_t rest = size_;
  if (std::align(kPage, kPage, page, rest) != nullptr) {
    madvise(page, rest / kPage * kPage, MADV_HUGEPAGE);  // a wish; it may be refused
  }
}

PoseArena::~PoseArena() {
  std::free(block_);
}

void* PoseArena::Take(size_t bytes) {
  const size_t begin = used_.fetch_add(Rounded(bytes), std::memory_order_relaxed);
  if (begin + Rounded(bytes) <= size_) return block_ + begin;
  const std::lock_guard lock(mutex_);
  extra_.push_back(std::make_unique<std::byte[]>(bytes));
  return extra_.back().get();
}

}  // namespace vmech
