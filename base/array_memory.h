#pragma once

#include <cstddef>
#include <memory>
#include <memory_resource>

namespace vmech {

/// Memory in one piece for arrays that are written once and go together.
///
/// The system hands memory out page by page, when each is first written, and that can take longer
/// than what is computed to fill it. From half a megabyte on, pages of 2 MB are asked for in place
/// of the usual 4 kB; where the system has none the memory is as any other.
///
/// It can be moved into a new object together with its arrays, but not be assigned: the arrays that
/// an object has already would lose theirs.
class ArrayMemory {
 public:
  ArrayMemory() = default;
  /// Room for so many bytes; what is asked for beyond them comes in further pieces.
  explicit ArrayMemory(size_t bytes);
  /// Takes the piece over; it stays where it is.
  ArrayMemory(ArrayMemory&&) = default;
  ArrayMemory& operator=(ArrayMemory&&) = delete;
  ArrayMemory(const ArrayMemory&) = delete;
  ArrayMemory& operator=(const ArrayMemory&) = delete;
  ~ArrayMemory() = default;

  /// For the allocators of the arrays; it is the heap if no room was asked for.
  std::pmr::memory_resource* resource() const {
    return piece_ != nullptr ? piece_.get() : std::pmr::get_default_resource();
  }

 private:
  std::unique_ptr<std::pmr::memory_resource> piece_;
};

}  // namespace vmech
