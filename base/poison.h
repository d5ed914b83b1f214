#pragma once

#include <cstdlib>

namespace vmech {

/// Shall what a call makes stale in a workspace be filled with NaN, so that an algorithm that reads
/// it all the same cannot pass for right? In builds with VMECH_POISON (the presets for
/// development), where the environment has VMECH_POISON too, as tests have and measurements have
/// not.
#ifdef VMECH_POISON
inline bool PoisonsStale() {
  static const bool poisons = std::getenv("VMECH_POISON") != nullptr;
  return poisons;
}
#else
constexpr bool PoisonsStale() {
  return false;
}
#endif

}  // namespace vmech
