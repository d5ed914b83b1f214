#pragma once

#include <mutex>

namespace vmech {

/// Held while Ipopt solves. Two solves at a time abort or hang: Ipopt 3.11 with MUMPS keeps global
/// state.
inline std::mutex& IpoptMutex() {
  static std::mutex mutex;
  return mutex;
}

}  // namespace vmech
