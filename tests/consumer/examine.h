#pragma once

#include <cstddef>
#include <cstdio>
#include <memory>
#include <type_traits>
#include <vector>

/// Makes objects of a class in the ways that programs do, and prints its layout.
template <typename T>
void Examine(const char* name) {
  static_assert(alignof(T) <= __STDCPP_DEFAULT_NEW_ALIGNMENT__,
                "a class of vmech asks for more than plain `new` gives");
  std::printf("%s %zu %zu\n", name, sizeof(T), alignof(T));
  if constexpr (std::is_default_constructible_v<T> && !std::is_abstract_v<T>) {
    T on_stack{};
    const auto on_heap = std::make_unique<T>();
    if constexpr (std::is_copy_constructible_v<T>) {
      std::vector<T> growing;
      for (int i = 0; i < 5; ++i) growing.push_back(i == 0 ? on_stack : *on_heap);
      const std::vector<T> copies = growing;
    }
  }
}
