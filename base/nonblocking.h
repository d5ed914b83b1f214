#pragma once

/// Marks a function that must not allocate, lock or call the system: clang's RealtimeSanitizer
/// (preset `rtsan`) stops where one does. Nothing to other compilers.
#if defined(__clang__) && __clang_major__ >= 20
#define VMECH_NONBLOCKING [[clang::nonblocking]]
#else
#define VMECH_NONBLOCKING
#endif
