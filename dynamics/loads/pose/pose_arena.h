#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <mutex>
#include <new>
#include <type_traits>
#include <vector>

namespace vmech {

/// One block from which the arrays of all poses of a study are cut: a hundred thousand small
/// allocations would cost more than the mechanics in them. Several threads may take from it.
class PoseArena {
 public:
  /// @throws std::bad_alloc
  explicit PoseArena(size_t bytes);
  ~PoseArena();
  PoseArena(const PoseArena&) = delete;
  PoseArena& operator=(const PoseArena&) = delete;

  /// Memory that lives as long as this object, aligned to kAlignment.
  void* Take(size_t bytes);
  /// What Take uses of the block for that many bytes.
  static constexpr size_t Rounded(size_t bytes) {
    return (bytes + kAlignment - 1) / kAlignment * kAlignment;
  }

 private:
  static constexpr size_t kAlignment = 16;

  size_t size_;
  std::byte* block_;
  std::atomic<size_t> used_{0};
  std::mutex mutex_;
  std::vector<std::unique_ptr<std::byte[]>> extra_;  ///< once the block is used up
};

/// Takes from a PoseArena, or without one from the heap. Copies of a container are on the heap, so
/// that a pose copied out of a result outlives it.
template <typename T>
class PoseAllocator {
 public:
  using value_type = T;
  using propagate_on_container_move_assignment = std::true_type;
  using propagate_on_container_swap = std::true_type;

  PoseAllocator() = default;
  explicit PoseAllocator(PoseArena* memory) : memory_(memory) {}
  template <typename U>
  explicit PoseAllocator(const PoseAllocator<U>& other) : memory_(other.memory()) {}

  T* allocate(size_t count) {
    const size_t bytes = count * sizeof(T);
    return static_cast<T*>(memory_ != nullptr ? memory_->Take(bytes) : ::operator new(bytes));
  }
  /// Does not look at the memory, which may be gone already.
  void deallocate(T* array, size_t /*count*/) noexcept {
    if (memory_ == nullptr) ::operator delete(array);
  }
  PoseAllocator select_on_container_copy_construction() const { return {}; }

  PoseArena* memory() const { return memory_; }
  bool operator==(const PoseAllocator&) const = default;

 private:
  PoseArena* memory_ = nullptr;
};

template <typename T>
using PoseArray = std::vector<T, PoseAllocator<T>>;

}  // namespace vmech
