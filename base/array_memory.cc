#include "vmech/base/array_memory.h"

#include <sys/mman.h>

#include <cstdlib>
#include <new>

namespace vmech {
namespace {

constexpr size_t kPage = size_t{1} << 21;
/// Of fewer bytes it takes longer to clear the large page than to fault in the small ones.
constexpr size_t kWorthAPage = kPage / 4;

size_t InWholePages(size_t bytes) {
  return (bytes + kPage - 1) / kPage * kPage;
}

class LargePages final : public std::pmr::memory_resource {
  void* do_allocate(size_t bytes, size_t alignment) override {
    if (bytes < kWorthAPage) return heap_->allocate(bytes, alignment);
    void* const memory = std::aligned_alloc(kPage, InWholePages(bytes));
    if (memory == nullptr) throw std::bad_alloc();
    madvise(memory, InWholePages(bytes), MADV_HUGEPAGE);  // advice: it may well be refused
    return memory;
  }
  void do_deallocate(void* memory, size_t bytes, size_t alignment) override {
    if (bytes < kWorthAPage) return heap_->deallocate(memory, bytes, alignment);
    std::free(memory);
  }
  bool do_is_equal(const std::pmr::memory_resource& other) const noexcept override {
    return this == &other;
  }

  std::pmr::memory_resource* heap_ = std::pmr::new_delete_resource();
};

LargePages* TheLargePages() {
  static LargePages pages;
  return &pages;
}

}  // namespace

ArrayMemory::ArrayMemory(size_t bytes) {
  if (bytes == 0) return;
  piece_ = std::make_unique<std::pmr::monotonic_buffer_resource>(bytes, TheLargePages());
}

}  // namespace vmech
